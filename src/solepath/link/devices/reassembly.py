"""Reassembly of an insole frame from its fragments (protocol/insole.md, "Fragments")."""

from __future__ import annotations

from ...events import Rejection
from ...types.attrs import define
from ...wire.error import WireError
from ...wire.fields import LONGEST_VALUE
from ...wire.fragment import Fragment


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
        self.newest_fragment = None
        if self.next_index == 0:
            return None
        detail = f"frame dropped: its fragment {self.next_index} never came"
        self.next_index, self.body = 0, b""
        return detail

    def feed(self, fragment: Fragment) -> tuple[bytes | None, str | None]:
        """Return the frame that this fragment completes, or None, and a description of a dropped frame, or None.

        The newest fragment again, with the same body, raises WireError and changes nothing."""
        if fragment == self.newest_fragment:
            raise WireError(Rejection.DUPLICATE, f"fragment {fragment.index} again")
        same_frame = fragment.frame_id == self.frame_id
        if same_frame and self.skipping and fragment.index > 0:
            return None, None
        follows = same_frame and self.next_index > 0 and fragment.index == self.next_index
        drop_reason = None
        if not follows:
            differs = same_frame and self.next_index > 0 and fragment.index == self.next_index - 1
            drop_reason = self.drop()
            if differs:
                drop_reason = f"frame dropped: its fragment {fragment.index} came twice, not the same"
            self.frame_id = fragment.frame_id
            self.skipping = fragment.index > 0
            if self.skipping:
                return None, drop_reason or f"frame dropped: its fragment 0 never came, {fragment.index} did"
        if len(self.body) + len(fragment.body) > LONGEST_VALUE:
            self.next_index, self.body, self.skipping, self.newest_fragment = 0, b"", True, None
            return None, f"frame dropped: longer than {LONGEST_VALUE} bytes"
        self.body += fragment.body
        self.newest_fragment = fragment
        if fragment.last:
            frame_data, self.body, self.next_index = self.body, b"", 0
            return frame_data, drop_reason
        self.next_index = fragment.index + 1
        return None, drop_reason
