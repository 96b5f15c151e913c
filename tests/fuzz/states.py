"""Mutated states with right checksums: each is restored, or rejected by SnapshotError."""

from __future__ import annotations

import json
from binascii import crc32
from functools import cache
from random import Random
from typing import Any

import walks
from changes import changed_bytes, changed_value

from solepath import Session, SnapshotError
from solepath.recipes import DEFAULT
from solepath.saving.codec import checksum
from solepath.session.packed import HEADER, _check_header

STATES = 20
"""Number of states of a round."""


@cache
def snapshots() -> tuple[dict[str, Any], ...]:
    """Return snapshots at several moments of a walk, as JSON gives them back."""
    session, taken = Session(), []
    packets = walks.insoles().packets
    for number, packet in enumerate(packets):
        session.feed(packet)
        if number % (len(packets) // 4) == 7:
            taken.append(json.loads(json.dumps(session.snapshot())))
    return tuple(taken)


@cache
def packed() -> tuple[bytes, ...]:
    """Return the same states as packed bytes."""
    return tuple([Session.restore(snapshot).pack() for snapshot in snapshots()])


def run(seed: int) -> tuple[int, int]:
    """Restore some mutated states; return their number, and how many of them were restored."""
    random, restored = Random(seed), 0
    for _ in range(STATES):
        try:
            if random.randrange(2):
                state = json.loads(json.dumps(random.choice(snapshots())["state"]))
                for _ in range(random.choice((1, 1, 3))):
                    state = changed_value(state, random)
                snapshot = {**snapshots()[0], "state": state, "check": _checksum(state)}
                Session.restore(snapshot)
            else:
                Session.unpack(_changed_packed(random.choice(packed()), random), DEFAULT)
            restored += 1
        except SnapshotError as error:
            if len(str(error).splitlines()) != 1:
                raise AssertionError(f"a reason of more than one line: {error!r}") from None
    return STATES, restored


def _checksum(state: Any) -> int:
    try:
        return checksum(state)
    except (ValueError, TypeError):
        return 0


def _changed_packed(data: bytes, random: Random) -> bytes:
    """Return packed bytes with a change behind the header and a right checksum."""
    magic, form, version, schema, _ = HEADER.unpack_from(data)
    body = changed_bytes(bytes(_check_header(data)), random)
    start = HEADER.pack(magic, form, version, schema, 0)
    return HEADER.pack(magic, form, version, schema, crc32(body, crc32(start))) + body
