"""Detection of a gyroscope whose axes are mirrored or exchanged against those of the accelerometer."""

from __future__ import annotations

from ...events import Defect
from ...types.attrs import define, field
from .closure import AXES, Axes, closure_ratios
from .finding import Finding
from .stances import ClosedStride

SHORTEST_STRIDE, LONGEST_STRIDE = 0.5, 2.5
"""Duration of strides that count, s."""
LEAST_STRIDES, SETTLED_STRIDES, MOST_STRIDES = 4, 8, 40
"""Number of strides before axes can be wrong, before they can be right, and after which they are no longer examined."""
LEAST_EVIDENCE, EVIDENCE_PER_STRIDE = 1.5, 0.05
"""Evidence, the sum over strides of the logarithm of a ratio of residuals, that decides between two kinds of axes.

On 378 recordings of a foot, (1.5, 0.05), (1.0, 0.1) and (1.5, 0.1) find the same: docs/checks.md."""
DISTINCT_EVIDENCE = 0.5
"""Evidence by which the best axes must lead the second best before they are offered as a correction."""
LATEST_REPORT = 16.0
"""Time after the start of the first stride after which wrong axes are reported, with or without the right ones, s."""


@define
class AxesCheck:
    """Evidence of a foot's strides for each of the 48 ways in which the axes may be mounted."""

    evidence: list[float] = field(factory=list)
    """Sum of the logarithms of the ratios, in the order of AXES; empty before the first stride."""
    strides: int = 0
    """Number of strides in `evidence`."""
    started_at: float = 0.0
    """Time at which the first stride began, s."""
    settled: bool = False
    """Flag: no more strides are needed."""

    def add(self, stride: ClosedStride) -> Finding | None:
        """Add a stride; return that the axes are wrong, once it is time to report this."""
        t, start = stride.intervals[-1].t, stride.intervals[0].t
        if not SHORTEST_STRIDE < t - start < LONGEST_STRIDE or (ratios := closure_ratios(stride)) is None:
            return None
        if not self.strides:
            self.started_at = start
            self.evidence = [0.0] * len(AXES)
        self.strides += 1
        self.evidence = [sum_ + ratio for sum_, ratio in zip(self.evidence, ratios, strict=True)]
        needed = LEAST_EVIDENCE + EVIDENCE_PER_STRIDE * self.strides
        if self.wrong:
            late = t - self.started_at > LATEST_REPORT
            self.settled = late or (self.strides >= SETTLED_STRIDES and self.correction is not None)
            return wrong_axes(self.correction) if self.settled else None
        sound = self.strides >= SETTLED_STRIDES and min(self.evidence[1:]) > needed
        self.settled = sound or self.strides >= MOST_STRIDES
        return None

    @property
    def wrong(self) -> bool:
        """Return whether other axes fit clearly better than the axes as they are."""
        needed = LEAST_EVIDENCE + EVIDENCE_PER_STRIDE * self.strides
        return self.strides >= LEAST_STRIDES and min(self.evidence) < -needed

    @property
    def correction(self) -> Axes | None:
        """The axes that fit best; None if others fit about as well."""
        best, second = sorted(self.evidence)[:2]
        return AXES[self.evidence.index(best)] if second - best > DISTINCT_EVIDENCE else None


def wrong_axes(axes: Axes | None) -> Finding:
    """Return the finding of wrong axes, with the axes that fit, if they are known."""
    text = "the axes of the gyroscope do not fit those of the accelerometer: one of them is mirrored or exchanged"
    if axes is None:
        return Finding(Defect.AXES, f"{text}; compare both with the data sheet of the sensor")
    words = " ".join(f"{'-' if axis < 0 else '+'}{'xyz'[abs(axis) - 1]}" for axis in axes)
    return Finding(Defect.AXES, f"{text}; the gyroscope's axes {words} fit the accelerometer's +x +y +z", axes=axes)
