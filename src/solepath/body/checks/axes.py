"""Detection of a gyroscope whose axes are mirrored or exchanged against those of the accelerometer."""

from __future__ import annotations

from math import log

from ...events import Defect
from ...types.attrs import define, field
from .closure import AXES, Axes, closure_residuals
from .finding import Finding
from .stances import ClosedStride

SHORTEST_STRIDE, LONGEST_STRIDE = 0.8, 2.5
"""Duration of strides that count, s: those of a walk. A runner's foot is never still, so its strides do not close."""
LEAST_STRIDES, SETTLED_STRIDES, MOST_STRIDES = 3, 6, 40
"""Number of strides before axes can be right or wrong, before a correction is known, and after which none is added."""
LEAST_EVIDENCE, EVIDENCE_PER_STRIDE = 1.5, 0.05
"""Evidence, the sum over strides of the logarithm of a ratio of residuals, that decides between two kinds of axes.

On 378 recordings of a foot, (1.5, 0.05), (1.0, 0.1) and (1.5, 0.1) find the same: docs/checks.md."""
LARGEST_LOG = 1.0
"""Limit of the evidence of one stride, which makes the sum robust."""
LARGEST_RESIDUAL = 2.5
"""Geometric mean of the residuals above which two sensors contradict each other, m/s^2.

Of 253 recordings of a foot, the largest is 2.0; with a gyroscope that reads twice the rate, 5 in 6 are above 2.5."""
CONTRADICTION = (
    "the gyroscope and the accelerometer do not describe the same motion: check the axes, units and ranges of both, the"
    " times, and that both are fixed to the same rigid part of the shoe"
)
"""Sentence on strides that close with no axes."""
DISTINCT_EVIDENCE = 0.5
"""Evidence by which the best axes must lead the second best before they are offered as a correction."""
LATEST_REPORT = 8.0
"""Time after the start of the first stride after which wrong axes are reported, with or without the right ones, s.

On 380 recordings of a foot, 8 and 16 s raise the same alarms; 6 s and 4 s raise one and three more."""
UNCERTAIN_FACTOR = 2.0
"""Factor of the evidence that is needed when strides close badly for another reason, a rate below 40 Hz.

With one sample in four of 191 recordings, which leaves no filter before it, 12 raise alarms with a factor of 1, and 2
with 2; of damaged ones, 96 and 83 in 100 are found, and 96 if the four are averaged."""


@define
class AxesCheck:
    """Evidence of a foot's strides for each of the 48 ways in which the axes may be mounted."""

    residuals: list[float] = field(factory=list)
    """Sum of the logarithms of the residuals, m/s^2, in the order of AXES; empty before the first stride."""
    evidence: list[float] = field(factory=list)
    """Sum of the logarithms of each residual's ratio to that of the axes as they are; negative if it is smaller."""
    strides: int = 0
    """Number of strides in `evidence`."""
    started_at: float = 0.0
    """Time at which the first stride began, s."""
    settled: bool = False
    """Flag: no more strides are needed."""
    uncertain: bool = False
    """Flag: samples are few, so that also right axes close badly."""

    def add(self, t: float, stride: ClosedStride) -> Finding | None:
        """Add a stride that is known at `t`, s; return that the axes are wrong, once it is time to report this.

        It is returned again when a correction is known."""
        if not SHORTEST_STRIDE < stride.duration < LONGEST_STRIDE or (logs := closure_residuals(stride)) is None:
            return None
        if not self.strides:
            self.started_at = t - stride.duration
            self.residuals, self.evidence = [0.0] * len(AXES), [0.0] * len(AXES)
        self.strides += 1
        self.residuals = [a + b for a, b in zip(self.residuals, logs, strict=True)]
        ratios = [max(-LARGEST_LOG, min(LARGEST_LOG, value - logs[0])) for value in logs]
        self.evidence = [a + b for a, b in zip(self.evidence, ratios, strict=True)]
        enough = self.strides >= SETTLED_STRIDES
        if not self.wrong:
            closes = self.uncertain or self.residuals[0] <= self.strides * log(LARGEST_RESIDUAL)
            fits = self.strides >= LEAST_STRIDES and min(self.evidence[1:]) > self.needed
            self.settled = (fits and (closes or enough)) or self.strides >= MOST_STRIDES
            return Finding(Defect.CONTRADICTION, CONTRADICTION) if enough and not closes else None
        self.settled = (enough and self.correction is not None) or self.strides >= MOST_STRIDES
        return self.finding if self.settled or t - self.started_at > LATEST_REPORT else None

    @property
    def wrong(self) -> bool:
        """Return whether other axes fit clearly better than the axes as they are."""
        return self.strides >= LEAST_STRIDES and min(self.evidence) < -self.needed

    @property
    def needed(self) -> float:
        """The evidence that decides between two kinds of axes after this number of strides."""
        evidence = LEAST_EVIDENCE + EVIDENCE_PER_STRIDE * self.strides
        return UNCERTAIN_FACTOR * evidence if self.uncertain else evidence

    @property
    def finding(self) -> Finding:
        """The finding of axes that are `wrong`; other axes explain that only if the strides close with them."""
        best = self.residuals[self.evidence.index(min(self.evidence))]
        if best > self.strides * log(LARGEST_RESIDUAL):
            return Finding(Defect.CONTRADICTION, CONTRADICTION)
        return wrong_axes(self.correction)

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
