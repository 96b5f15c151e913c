"""Running means of gait parameters over steady gait cycles, which are called strides in this file.

Up to `MEMORY_STRIDES` strides of a foot (two minutes of walking), the means are arithmetic means. From then on each new
stride has the weight 1 / `MEMORY_STRIDES`, and old strides fade. Walking and running have separate means.

The mean of both feet is the mean of the feet's means. The standard deviation of both feet is the root of the mean of
their variances, so that a difference between the feet does not count as variability (Galna et al. 2013, Gait & Posture
37; Lord et al. 2013, J. Gerontol. A 68). Variability is this standard deviation; relative to the mean it is the
coefficient of variation (Hausdorff 2005, J. NeuroEng. Rehabil. 2). It needs at least 30 steps to be meaningful (Galna
et al.)."""

from __future__ import annotations

from math import fsum, sqrt
from operator import attrgetter
from typing import Any

from ...events import DefectFound, GaitCycleMeasured
from ...types import Foot, PerFoot, ValueEnum, per_foot
from ...types.attrs import define, evolve, field, frozen, state, stateful

MEMORY_STRIDES = 120
"""Number of strides of a foot after which older strides fade."""


@define
class RunningMean:
    """The running mean and variance of one gait parameter; time and memory are O(1)."""

    count: int = 0
    """Number of values, at most the number after which older values fade."""
    mean: float = 0.0
    variance: float = 0.0
    """Weighted variance about the mean."""

    @property
    def figure(self) -> Figure:
        """Mean and standard deviation now."""
        # the unbiased variance of n values is n / (n - 1) times their variance about their mean
        sd = sqrt(self.variance * self.count / (self.count - 1)) if self.count > 1 else None
        return Figure(self.mean, sd, self.count)


@frozen
class Figure:
    """The mean and standard deviation of one gait parameter over steady strides, in the parameter's unit."""

    mean: float
    sd: float | None
    """Standard deviation; None for a single stride."""
    strides: int
    """Number of strides; in a session at most 120 for each foot."""

    @property
    def cv(self) -> float | None:
        """Coefficient of variation, as a share (0.02 is 2 %); None for a single stride and for a mean of zero."""
        return None if self.sd is None or self.mean == 0.0 else self.sd / abs(self.mean)


@frozen
class StrideFigures:
    """The parameters of GaitCycleMeasured over steady strides of one foot or of both feet; None: not measured."""

    stride_time: Figure | None = None
    stance_time: Figure | None = None
    swing_time: Figure | None = None
    step_time: Figure | None = None
    initial_double_support: Figure | None = None
    terminal_double_support: Figure | None = None
    single_support: Figure | None = None
    phase: Figure | None = None
    stride_length: Figure | None = None
    speed: Figure | None = None
    clearance: Figure | None = None
    toe_off_angle: Figure | None = None
    heel_strike_angle: Figure | None = None

    def share(self, name: str) -> float | None:
        """Return the mean of the time `name` as a share of the mean stride time; None when it is not known."""
        time: Figure | None = getattr(self, name)
        if time is None or self.stride_time is None:
            return None
        return time.mean / self.stride_time.mean

    @property
    def double_support(self) -> float | None:
        """Sum of the means of initial and terminal double support, s.

        For a runner it is minus the time of a stride in which no foot is on the ground."""
        if self.initial_double_support is None or self.terminal_double_support is None:
            return None
        return self.initial_double_support.mean + self.terminal_double_support.mean


class Parameter(ValueEnum):
    """The parameters that have running means: the fields of StrideFigures and OFF_PHASE, which is |phase - 0.5|."""

    STRIDE_TIME = "stride_time"
    STANCE_TIME = "stance_time"
    SWING_TIME = "swing_time"
    STEP_TIME = "step_time"
    INITIAL_DOUBLE_SUPPORT = "initial_double_support"
    TERMINAL_DOUBLE_SUPPORT = "terminal_double_support"
    SINGLE_SUPPORT = "single_support"
    PHASE = "phase"
    STRIDE_LENGTH = "stride_length"
    SPEED = "speed"
    CLEARANCE = "clearance"
    TOE_OFF_ANGLE = "toe_off_angle"
    HEEL_STRIKE_ANGLE = "heel_strike_angle"
    OFF_PHASE = "off_phase"


MEAN_PARAMETERS: tuple[Parameter, ...] = tuple([one for one in Parameter if one is not Parameter.OFF_PHASE])
"""The fields of StrideFigures."""
_get_parameters = attrgetter(*[one.value for one in MEAN_PARAMETERS])
"""Function that returns their values of a GaitCycleMeasured."""
BETWEEN_FEET = (
    Parameter.STEP_TIME,
    Parameter.INITIAL_DOUBLE_SUPPORT,
    Parameter.TERMINAL_DOUBLE_SUPPORT,
    Parameter.SINGLE_SUPPORT,
    Parameter.PHASE,
)
"""Parameters that compare the times of both feet."""


def as_found(stride: GaitCycleMeasured, found: DefectFound) -> GaitCycleMeasured:
    """Return what is left of a stride after a defect was found: nothing that a wrong foot or clock would have part in.

    A foot whose data cannot be right has no steady strides, also not before that was found."""
    if stride.foot is found.spoilt_foot:
        stride = evolve(stride, steady=False)
    if not found.separates_feet:
        return stride
    unknown: dict[str, Any] = dict.fromkeys([parameter.value for parameter in BETWEEN_FEET])
    return evolve(stride, **unknown)


@frozen
class GaitParameters:
    """The running means over steady strides (body/gait/cycles.py has the rule for steady strides)."""

    running: bool
    """Flag: the means are of running, not of walking."""
    feet: dict[Foot, StrideFigures]
    """Figures of each foot that has steady strides."""
    both: StrideFigures
    """Figures of both feet together."""
    coordination: float | None
    """Phase coordination index, as a share (0.03 is 3 %); None without both feet.

    It is the coefficient of variation of `phase` of the foot with the longer swing, plus twice the mean of
    |phase - 0.5| (Plotnik et al. 2007, Exp. Brain Res. 181). Healthy walkers have 0.02 to 0.04."""

    @property
    def cadence(self) -> float | None:
        """Cadence, steps per minute: 120 / mean stride time."""
        time = self.both.stride_time
        return None if time is None else 120.0 / time.mean

    def asymmetry(self, name: str) -> float | None:
        """Return the symmetry index of a parameter, 2 (right - left) / (right + left), as a share (0.05 is 5 %).

        `right` and `left` are the feet's means (Robinson et al. 1987, J. Manip. Physiol. Ther. 10). For swing times,
        |ln(right / left)| of Plotnik et al. 2005 (Ann. Neurol. 57) has nearly the same size. The index is None when a
        foot's mean is not known or the sum of the means is zero."""
        left, right = (getattr(self.feet.get(foot), name, None) for foot in Foot)
        if left is None or right is None or left.mean + right.mean == 0.0:
            return None
        index: float = 2.0 * (right.mean - left.mean) / (right.mean + left.mean)
        return index


@define
class ParameterMeans:
    """Running means of walking or of running, by foot and parameter."""

    feet: PerFoot[dict[Parameter, RunningMean]] = field(factory=lambda: per_foot(dict))

    def add(self, stride: GaitCycleMeasured, memory: int) -> None:
        """Add a stride; older strides fade after `memory` strides."""
        means = self.feet[stride.foot]
        values = [*zip(MEAN_PARAMETERS, _get_parameters(stride), strict=True)]
        if stride.phase is not None:
            values.append((Parameter.OFF_PHASE, abs(stride.phase - 0.5)))
        for parameter, value in values:
            if value is not None:
                one = means.get(parameter)
                if one is None:
                    one = means[parameter] = RunningMean()
                one.count = min(one.count + 1, memory)
                weight = 1.0 / one.count
                deviation = value - one.mean
                one.mean += weight * deviation
                one.variance = (1.0 - weight) * (one.variance + weight * deviation * deviation)

    @property
    def coordination(self) -> float | None:
        """Phase coordination index, as defined in GaitParameters."""
        known = [means for means in self.feet.values() if Parameter.PHASE in means]
        if len(known) < 2:
            return None
        reference = max(known, key=lambda means: means[Parameter.SWING_TIME].mean)
        variation = reference[Parameter.PHASE].figure.cv
        return None if variation is None else variation + 2.0 * reference[Parameter.OFF_PHASE].mean


def _figures(means: dict[Parameter, RunningMean]) -> StrideFigures:
    return StrideFigures(**{one.value: mean.figure for one, mean in means.items() if one is not Parameter.OFF_PHASE})


@stateful
class GaitMeans:
    """The running means of the steady strides of both feet.

    A stride is added when the next stride of its foot follows, so that the last stride before a stop is left out."""

    newest: PerFoot[GaitCycleMeasured | None] = state(factory=lambda: dict.fromkeys(Foot))
    """Newest stride of each foot."""
    walking_means: ParameterMeans = state(factory=ParameterMeans)
    running_means: ParameterMeans = state(factory=ParameterMeans)
    """Running means of the strides of a runner."""
    running: bool | None = None
    """Flag: the newest stride in the means was a running stride; None before any."""

    def add(self, stride: GaitCycleMeasured, memory: int = MEMORY_STRIDES) -> None:
        """Add a stride of either foot, in order of time; older strides of the foot fade after `memory` strides."""
        previous, self.newest[stride.foot] = self.newest[stride.foot], stride
        if previous is not None and previous.steady and previous.t == stride.t_start:
            self.running = running = previous.running
            (self.running_means if running else self.walking_means).add(previous, memory)

    def withhold(self, found: DefectFound) -> None:
        """Discard the means that a defect makes wrong: those of its foot, and those that compare the feet."""
        if not found.separates_feet:
            return
        for kind in (self.walking_means, self.running_means):
            for foot, means in kind.feet.items():
                for parameter in [*means] if foot is found.spoilt_foot else (*BETWEEN_FEET, Parameter.OFF_PHASE):
                    means.pop(parameter, None)
        self.newest = {foot: stride and as_found(stride, found) for foot, stride in self.newest.items()}
        if self.running is not None and self.of(self.running) is None:
            self.running = None

    def reset(self, foot: Foot) -> None:
        """Reset a foot, so that its next stride does not count as following the newest one."""
        self.newest[foot] = None

    @property
    def parameters(self) -> GaitParameters | None:
        """Running means of walking or running, by the newest stride in the means; None before any."""
        return None if self.running is None else self.of(self.running)

    def of(self, running: bool) -> GaitParameters | None:
        """Return the running means of running or of walking; None when there were no such strides."""
        means = self.running_means if running else self.walking_means
        feet = {foot: _figures(means.feet[foot]) for foot in Foot if means.feet[foot]}
        if not feet:
            return None
        both = {
            one.value: combine_feet([getattr(figures, one.value) for figures in feet.values()])
            for one in MEAN_PARAMETERS
        }
        return GaitParameters(running, feet, StrideFigures(**both), means.coordination)


def combine_feet(figures: list[Figure | None]) -> Figure | None:
    """Return the figure of both feet: the mean of the means, and the root of the mean variance."""
    known = [figure for figure in figures if figure is not None]
    if not known:
        return None
    deviations = [figure.sd for figure in known if figure.sd is not None]
    sd = sqrt(fsum([deviation * deviation for deviation in deviations]) / len(deviations)) if deviations else None
    strides = sum([figure.strides for figure in known])  # whole numbers
    return Figure(fsum([figure.mean for figure in known]) / len(known), sd, strides)
