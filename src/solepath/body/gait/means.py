"""Running means of steady strides.

Up to `MEMORY` strides of a foot (two minutes of walking) the means are plain ones; from then on each new stride has the
weight of one in `MEMORY`, and old strides fade. Walking and running have separate means.

Means and standard deviations of both feet together: the mean of the feet's means, and the root of the mean of their
variances, so that a difference between the feet does not count as variability (Galna et al. 2013, Gait & Posture 37;
Lord et al. 2013, J. Gerontol. A 68). Variability is that standard deviation, or relative to the mean the coefficient of
variation (Hausdorff 2005, J. NeuroEng. Rehabil. 2). It needs at least 30 steps to be meaningful (Galna et al.)."""

from __future__ import annotations

from collections.abc import Iterable
from math import sqrt

from ...events import GaitCycleMeasured
from ...types import Foot, Word
from ...types.attrs import define, field, fields, frozen

MEMORY = 120
"""Number of strides of a foot that a running mean covers."""


@define
class RunningMean:
    """The running mean and variance of one gait parameter; O(1)."""

    count: int = 0
    """Number of values, up to the number remembered."""
    mean: float = 0.0
    variance: float = 0.0
    """Variance about the mean, by the weights of the values."""

    @property
    def figure(self) -> Figure:
        """Mean and standard deviation as they are now."""
        # the variance of a sample of n is n / (n - 1) times that about its own mean
        sd = sqrt(self.variance * self.count / (self.count - 1)) if self.count > 1 else None
        return Figure(self.mean, sd, self.count)


def add(figures: Iterable[tuple[RunningMean, float]], memory: int) -> None:
    """Add one value to each running mean; older values fade once there are `memory`."""
    for figure, value in figures:
        figure.count = min(figure.count + 1, memory)
        weight = 1.0 / figure.count
        off = value - figure.mean
        figure.mean += weight * off
        figure.variance = (1.0 - weight) * (figure.variance + weight * off * off)


@frozen
class Figure:
    """Mean and standard deviation (None of a single stride) of one gait parameter, in the parameter's unit."""

    mean: float
    sd: float | None
    strides: int
    """Number of strides of this figure; of a session at most 120 of a foot."""

    @property
    def cv(self) -> float | None:
        """Coefficient of variation, as a share (0.02 is 2 %); None of a single stride and of a mean of zero."""
        return None if self.sd is None or self.mean == 0.0 else self.sd / abs(self.mean)


@frozen
class StrideFigures:
    """The parameters of GaitCycleMeasured over steady strides, of one foot or of both; None: not measured."""

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
    step_length: Figure | None = None
    step_width: Figure | None = None
    clearance: Figure | None = None
    toe_off_angle: Figure | None = None
    heel_strike_angle: Figure | None = None

    def share(self, name: str) -> float | None:
        """Return the mean of a time as a share of the mean stride time; None where it is not known."""
        time: Figure | None = getattr(self, name)
        if time is None or self.stride_time is None:
            return None
        return time.mean / self.stride_time.mean

    @property
    def double_support(self) -> float | None:
        """Mean of initial and terminal double support together, s.

        It is below zero for a runner, whose flight lasts as long."""
        if self.initial_double_support is None or self.terminal_double_support is None:
            return None
        return self.initial_double_support.mean + self.terminal_double_support.mean


PARAMETER_NAMES = tuple(one.name for one in fields(StrideFigures))


class Parameter(Word):
    """The parameters that have running means: the fields of StrideFigures, and |phase - 0.5|."""

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
    STEP_LENGTH = "step_length"
    STEP_WIDTH = "step_width"
    CLEARANCE = "clearance"
    TOE_OFF_ANGLE = "toe_off_angle"
    HEEL_STRIKE_ANGLE = "heel_strike_angle"
    OFF_PHASE = "off_phase"


MEASURED = tuple([Parameter(name) for name in PARAMETER_NAMES])


@frozen
class GaitParameters:
    """Running means over steady strides (body/gait/measuring.py defines them).

    `running`: of strides that were run. `feet`: figures of each foot that has steady strides; `both`: of both together.
    """

    running: bool
    feet: dict[Foot, StrideFigures]
    both: StrideFigures
    coordination: float | None
    """Phase coordination index, as a share (0.03 is 3 %); None without both feet. It is the coefficient of variation of
    the phase of the foot that swings longer, plus the mean distance of that phase from a half, relative to a half
    (Plotnik et al. 2007, Exp. Brain Res. 181). Healthy walkers have 0.02 to 0.04."""

    @property
    def cadence(self) -> float | None:
        """Cadence, steps a minute: 120 / mean stride time."""
        time = self.both.stride_time
        return None if time is None else 120.0 / time.mean

    def asymmetry(self, name: str) -> float | None:
        """Return the symmetry index of a parameter, (right - left) / (half of right + left), as a share (0.05 is 5 %).

        It is 0 for equal feet and positive where the right one's is larger (Robinson et al. 1987, J. Manip. Physiol.
        Ther. 10). For swing times |ln(right / left)| of Plotnik et al. 2005 (Ann. Neurol. 57) has nearly the same size.
        It is None where one foot's figure is not known, or both are zero."""
        left, right = (getattr(self.feet.get(foot), name, None) for foot in Foot)
        if left is None or right is None or left.mean + right.mean == 0.0:
            return None
        index: float = 2.0 * (right.mean - left.mean) / (right.mean + left.mean)
        return index


@define
class ParameterMeans:
    """Running means of walking or of running, by foot and parameter."""

    left: dict[Parameter, RunningMean] = field(factory=dict)
    right: dict[Parameter, RunningMean] = field(factory=dict)

    def of_foot(self, foot: Foot) -> dict[Parameter, RunningMean]:
        """Return the running means of a foot."""
        return self.left if foot is Foot.LEFT else self.right

    def add(self, stride: GaitCycleMeasured, memory: int) -> None:
        """Add one stride; older ones fade once there are `memory`."""
        sums = self.left if stride.foot is Foot.LEFT else self.right
        figures: list[tuple[RunningMean, float]] = []
        for parameter in MEASURED:
            value = getattr(stride, parameter.value)
            if value is not None:
                figures.append((sums.setdefault(parameter, RunningMean()), value))
        if stride.phase is not None:
            figures.append((sums.setdefault(Parameter.OFF_PHASE, RunningMean()), abs(stride.phase - 0.5)))
        add(figures, memory)

    @property
    def coordination(self) -> float | None:
        """Phase coordination index, as in GaitParameters."""
        known = [sums for sums in (self.left, self.right) if Parameter.PHASE in sums]
        if len(known) < 2:
            return None
        reference = max(known, key=_swing)
        varies = reference[Parameter.PHASE].figure.cv
        return None if varies is None else varies + 2.0 * reference[Parameter.OFF_PHASE].mean


def _figures(sums: dict[Parameter, RunningMean]) -> StrideFigures:
    known = {parameter.value: mean.figure for parameter, mean in sums.items()}
    known.pop(Parameter.OFF_PHASE.value, None)
    return StrideFigures(**known)


def _swing(sums: dict[Parameter, RunningMean]) -> float:
    return sums[Parameter.SWING_TIME].mean


@define
class GaitMeans:
    """The running means of the steady strides of both feet.

    A stride is counted once the next one of its foot follows, so that the last one before a stop is not."""

    left: GaitCycleMeasured | None = field(default=None, init=False)
    """Newest stride of the left foot."""
    right: GaitCycleMeasured | None = field(default=None, init=False)
    """Newest stride of the right foot."""
    walked: ParameterMeans = field(factory=ParameterMeans, init=False)
    run: ParameterMeans = field(factory=ParameterMeans, init=False)
    running: bool | None = field(default=None, init=False)
    """Flag: the newest stride that counts was run; None before any."""

    def add(self, stride: GaitCycleMeasured, memory: int = MEMORY) -> None:
        """Add one stride, of either foot in the order of time; old strides of its foot fade after `memory`."""
        if stride.foot is Foot.LEFT:
            before, self.left = self.left, stride
        else:
            before, self.right = self.right, stride
        if before is not None and before.steady and before.t == stride.t_start:
            self.running = running = before.running
            (self.run if running else self.walked).add(before, memory)

    def reset(self, foot: Foot) -> None:
        """Reset a foot: its next stride does not follow its newest one."""
        if foot is Foot.LEFT:
            self.left = None
        else:
            self.right = None

    @property
    def parameters(self) -> GaitParameters | None:
        """Running means of walking or running, whichever the newest stride that counts was; None before any."""
        return None if self.running is None else self.of(self.running)

    def of(self, running: bool) -> GaitParameters | None:
        """Return the running means of walking or of running; None where there was none."""
        sums = self.run if running else self.walked
        feet = {foot: _figures(sums.of_foot(foot)) for foot in Foot if sums.of_foot(foot)}
        if not feet:
            return None
        both = {name: combined([getattr(one, name) for one in feet.values()]) for name in PARAMETER_NAMES}
        return GaitParameters(running, feet, StrideFigures(**both), sums.coordination)


def combined(figures: list[Figure | None]) -> Figure | None:
    """Return the figure of both feet: mean of the means, root of the mean variance."""
    known = [figure for figure in figures if figure is not None]
    if not known:
        return None
    deviations = [figure.sd for figure in known if figure.sd is not None]
    sd = sqrt(sum([one * one for one in deviations]) / len(deviations)) if deviations else None
    return Figure(sum([one.mean for one in known]) / len(known), sd, sum([one.strides for one in known]))
