"""Fragments of frames that do not fit a small MTU (protocol/insole.md, "Fragments")."""

from __future__ import annotations

from construct import BitsInteger, BitStruct, Flag, GreedyBytes, Struct

from ..events import Rejection
from ..types.attrs import frozen
from .error import WireError
from .fields import LONGEST_VALUE, build_whole, malformed, parse_whole

FRAME_ID_COUNT = 7
"""Number of frame ids, which are 0 to 6: with id 7, a fragment could start with 0xF5 as a whole frame does."""
MAX_FRAGMENTS = 16
"""Largest number of fragments of a frame."""


@frozen
class Fragment:
    """A part of a frame: `frame_id` 0 to 6, `index` 0 to 15, `last` True for the last fragment of the frame."""

    frame_id: int
    last: bool
    index: int
    body: bytes


_FRAGMENT = Struct(
    "head" / BitStruct("frame_id" / BitsInteger(3), "last" / Flag, "index" / BitsInteger(4)), "body" / GreedyBytes
)


def is_fragment(data: bytes) -> bool:
    """Return whether the first byte marks a fragment rather than a whole frame."""
    return len(data) > 0 and data[0] >> 5 < FRAME_ID_COUNT


def parse_fragment(data: bytes) -> Fragment:
    """Return the fragment in `data`; WireError for any other bytes."""
    data = bytes(data)
    if data and not is_fragment(data):
        raise malformed(f"frame id {data[0] >> 5}: not a fragment")
    if len(data) < 2:
        raise WireError(Rejection.TRUNCATED, "a fragment without a body")
    if len(data) > LONGEST_VALUE:
        raise WireError(Rejection.OVERSIZED, f"{len(data)} bytes, at most {LONGEST_VALUE}")
    parsed = parse_whole(_FRAGMENT, data)
    return Fragment(parsed.head.frame_id, parsed.head.last, parsed.head.index, parsed.body)


def build_fragment(fragment: Fragment) -> bytes:
    """Return the bytes of `fragment`; ValueError when it does not fit the format."""
    if not 0 <= fragment.frame_id < FRAME_ID_COUNT:
        raise ValueError(f"frame id {fragment.frame_id}, 0 to {FRAME_ID_COUNT - 1} are allowed")
    if not 0 < len(fragment.body) <= LONGEST_VALUE - 1:
        raise ValueError(f"a fragment with a body of {len(fragment.body)} bytes")
    head = {"frame_id": fragment.frame_id, "last": fragment.last, "index": fragment.index}
    return build_whole(_FRAGMENT, {"head": head, "body": fragment.body})


def split(frame: bytes, payload: int, frame_id: int) -> list[bytes]:
    """Return `frame` as notifications of at most `payload` bytes (ATT MTU - 3): whole if it fits, else as fragments.

    `frame_id` is 0 to 6, and differs from that of the previous frame. ValueError when 16 fragments do not suffice."""
    if len(frame) <= payload:
        return [frame]
    if payload < 2:
        raise ValueError(f"a payload of {payload} bytes leaves no room for a fragment")
    bodies = [frame[i : i + payload - 1] for i in range(0, len(frame), payload - 1)]
    if len(bodies) > MAX_FRAGMENTS:
        raise ValueError(f"{len(frame)} bytes do not fit in {MAX_FRAGMENTS} fragments of {payload}")
    return [build_fragment(Fragment(frame_id, i == len(bodies) - 1, i, body)) for i, body in enumerate(bodies)]
