"""Check of an insole's values against the strides of its foot, which shows another unit or too coarse values."""

from __future__ import annotations

from ...events import Defect, StrideTaken
from ...types.attrs import define
from .finding import Finding

STRIDES = 6
"""Number of strides after which the contacts of a foot are judged."""
LONGEST_STANCE = 0.6
"""Longest time between two strides that follow each other, s."""
MOST_CONTACTS = 1.75
"""Number of heel-strikes a stride above which the load contradicts the motion."""
LEAST_LOAD, LARGEST_LOAD = 40.0, 4000.0
"""Mean load of a foot on the ground, N, of an insole that covers part of the sole of a child, and of a heavy runner."""


@define
class LoadCheck:
    """Counts the heel-strikes of a foot in its strides, and adds up its load on the ground."""

    strides: int = 0
    """Number of strides since they were judged last."""
    contacts: int = 0
    """Number of heel-strikes in these strides."""
    new_contacts: int = 0
    """Number of heel-strikes since the last stride."""
    t_end: float | None = None
    """End of the last stride, s; None before any."""
    loaded: int = 0
    """Number of strides with a load."""
    load_sum: float = 0.0
    """Sum of their mean loads on the ground, N or in the unit of the samples."""

    def add_stride(self, stride: StrideTaken, in_newtons: bool) -> Finding | None:
        """Add a stride; return wrong values of the insole, if these strides show them."""
        follows = self.t_end is not None and 0.0 <= stride.t_start - self.t_end < LONGEST_STANCE
        new_contacts, self.new_contacts, self.t_end = self.new_contacts, 0, stride.t_end
        if not follows:  # the wearer stood or stepped in place, which is no stride
            return None
        self.strides += 1
        self.contacts += new_contacts
        if stride.features.contact_load is not None:
            self.loaded += 1
            self.load_sum += stride.features.contact_load
        if self.strides < STRIDES:
            return None
        strides, contacts, loaded, load_sum = self.strides, self.contacts, self.loaded, self.load_sum
        self.strides = self.contacts = self.loaded = 0
        self.load_sum = 0.0
        if 2 * loaded < strides:
            return None
        if contacts > MOST_CONTACTS * strides:
            text = f"the insole shows {contacts} contacts in {strides} strides: its values are noise, or too coarse for"
            return Finding(Defect.PRESSURE_UNIT, f"{text} the load of a foot; check their unit and range")
        load = load_sum / loaded
        if in_newtons and not LEAST_LOAD <= load <= LARGEST_LOAD:
            text = f"the insole shows {load:.3g} N on the foot that carries the wearer: check the unit of its values"
            return Finding(Defect.PRESSURE_UNIT, f"{text} and its calibration")
        return None
