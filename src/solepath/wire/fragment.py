"""Fragments of frames that do not fit a small MTU, and their reassembly (protocol/insole.md, "Fragments")."""

from __future__ import annotations

from ..events import Rejection
from ..types.attrs import define, frozen
from .error import WireError
from .fields import LONGEST_VALUE, check_length, malformed

FRAME_ID_COUNT = 7
"""Number of frame ids, which are 0 to 6: with id 7, a fragment could start with 0xF5 as a whole frame does."""
MAX_FRAGMENTS = 16
"""Largest number of fragments of a frame."""


@frozen
class Fragment:
    """A part of a frame: `frame_id` 0 to 6, `index` 0 to 15, `last` True for the last fragment of the frame.

    The first byte has the frame id in bits 5 to 7, `last` in bit 4, and the index in bits 0 to 3."""

    frame_id: int
    last: bool
    index: int
    body: bytes


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
    check_length(data)
    return Fragment(data[0] >> 5, data[0] & 16 != 0, data[0] & 15, data[1:])


def build_fragment(fragment: Fragment) -> bytes:
    """Return the bytes of `fragment`; ValueError when it does not fit the format."""
    frame_id, index, body = fragment.frame_id, fragment.index, fragment.body
    if not (0 <= frame_id < FRAME_ID_COUNT and 0 <= index < MAX_FRAGMENTS and 0 < len(body) < LONGEST_VALUE):
        raise ValueError(f"no fragment has the frame id {frame_id}, the index {index} and {len(body)} bytes")
    return bytes([frame_id << 5 | fragment.last << 4 | index]) + body


def split(frame: bytes, payload: int, frame_id: int) -> list[bytes]:
    """Return `frame` as notifications of at most `payload` bytes (ATT MTU - 3): whole if it fits, else as fragments.

    `frame_id` is 0 to 6, and differs from that of the previous frame. ValueError when 16 fragments do not suffice."""
    if len(frame) <= payload:
        return [frame]
    if payload < 2:
        raise ValueError(f"a payload of {payload} bytes leaves no room for a fragment")
    bodies = [frame[i : i + payload - 1] for i in range(0, len(frame), payload - 1)]
    return [build_fragment(Fragment(frame_id, i == len(bodies) - 1, i, body)) for i, body in enumerate(bodies)]


@define
class Reassembly:
    """Joins the fragments of one frame of at most 512 bytes; a fragment out of order drops the frame."""

    frame_id: int = 0
    """Id of the newest frame."""
    next_index: int = 0
    """Index of the next fragment; 0 when no frame is incomplete."""
    skipping: bool = False
    """True if the frame `frame_id` was dropped; its further fragments are then skipped without an event."""
    body: bytes = b""
    """Bytes of the incomplete frame."""
    newest_fragment: Fragment | None = None
    """Fragment that was joined last; None after a packet of another kind."""

    def drop(self) -> str | None:
        """Drop the incomplete frame, and return a description of the loss; None when there is no incomplete frame."""
        expected, self.next_index, self.body, self.newest_fragment = self.next_index, 0, b"", None
        return f"frame dropped: its fragment {expected} never came" if expected else None

    def feed(self, fragment: Fragment) -> tuple[bytes | None, str | None]:
        """Return the frame that this fragment completes, or None, and a description of a dropped frame, or None.

        The newest fragment again, with the same body, raises WireError and changes nothing."""
        index, drop_reason = fragment.index, None
        if fragment == self.newest_fragment:
            raise WireError(Rejection.DUPLICATE, f"fragment {index} again")
        same_frame = fragment.frame_id == self.frame_id
        if same_frame and self.skipping and index > 0:
            return None, None
        behind = self.next_index - index if same_frame and self.next_index else None
        if behind != 0:
            drop_reason = self.drop()
            if behind == 1:
                drop_reason = f"frame dropped: its fragment {index} came twice, not the same"
            self.frame_id, self.skipping = fragment.frame_id, index > 0
            if self.skipping:
                return None, drop_reason or f"frame dropped: its fragment 0 never came, {index} did"
        if len(self.body) + len(fragment.body) > LONGEST_VALUE:
            self.drop()
            self.skipping = True
            return None, f"frame dropped: longer than {LONGEST_VALUE} bytes"
        self.body, self.newest_fragment, self.next_index = self.body + fragment.body, fragment, index + 1
        if not fragment.last:
            return None, drop_reason
        frame_data, self.body, self.next_index = self.body, b"", 0
        return frame_data, drop_reason
