"""Reassembly of an insole frame from its fragments (protocol/insole.md, "Fragments")."""

from __future__ import annotations

from ...events import Rejection
from ...types.attrs import define
from ...wire.error import WireError
from ...wire.fields import LONGEST_VALUE
from ...wire.fragment import Fragment


@define
class Reassembly:
    """Collects the fragments of one frame; a fragment out of order drops the frame. Never more than 512 bytes."""

    frame_id: int = 0
    """Id of the newest frame."""
    expected: int = 0
    """Index of the next fragment; 0 when no frame is under way."""
    skipping: bool = False
    """True if the frame `frame_id` was dropped; the rest of it is then skipped without an event."""
    body: bytes = b""
    """Bytes of the frame so far."""
    newest: Fragment | None = None
    """Fragment joined last, as long as nothing else came."""

    def drop(self) -> str | None:
        """Drop a frame under way, because something else came; return a description of it, or None."""
        self.newest = None
        if self.expected == 0:
            return None
        detail = f"frame dropped: its fragment {self.expected} never came"
        self.expected, self.body = 0, b""
        return detail

    def feed(self, fragment: Fragment) -> tuple[bytes | None, str | None]:
        """Return the whole frame when this was its last fragment, and a description of a dropped frame; or None.

        WireError, and nothing has changed, when the fragment is the newest one again, body and all."""
        if fragment == self.newest:
            raise WireError(Rejection.DUPLICATE, f"fragment {fragment.index} again")
        known = fragment.frame_id == self.frame_id
        if known and self.skipping and fragment.index > 0:
            return None, None
        follows = known and self.expected > 0 and fragment.index == self.expected
        dropped = None
        if not follows:
            differs = known and self.expected > 0 and fragment.index == self.expected - 1
            dropped = self.drop()
            if differs:
                dropped = f"frame dropped: its fragment {fragment.index} came twice, not the same"
            self.frame_id = fragment.frame_id
            self.skipping = fragment.index > 0
            if self.skipping:
                return None, dropped or f"frame dropped: its fragment 0 never came, {fragment.index} did"
        if len(self.body) + len(fragment.body) > LONGEST_VALUE:
            self.expected, self.body, self.skipping, self.newest = 0, b"", True, None
            return None, f"frame dropped: longer than {LONGEST_VALUE} bytes"
        self.body += fragment.body
        self.newest = fragment
        if fragment.last:
            whole, self.body, self.expected = self.body, b"", 0
            return whole, dropped
        self.expected = fragment.index + 1
        return None, dropped
