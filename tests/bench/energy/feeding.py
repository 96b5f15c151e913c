"""A walk that is fed to new sessions, in any Python (energy.py)."""

from __future__ import annotations

from solepath import Session
from solepath.recording import read_packets


class Walk:
    """The packets of a recording."""

    def __init__(self, recording: str) -> None:
        self.packets = list(read_packets(recording))

    def feed(self) -> int:
        """Feed the packets to a new session, one at a time; return the number of events."""
        session = Session()
        return sum([len(session.feed(packet)) for packet in self.packets])  # whole numbers
