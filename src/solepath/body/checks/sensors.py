"""Checks of what each foot's sensors send, at any mounting: units, gravity, axes, ranges, rates and repeats."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from ...events import Defect, DefectFound, HeelStrike, SampleRejected, StrideTaken
from ...foot.view import FootView
from ...types import OTHER, Foot, PerFoot, Site, Vec3, per_foot
from ...types.attrs import ROW_SIZE, define, field, state, stateful
from ...types.doubles import Doubles, doubles
from ..part import Inputs, Outputs, Part, PartOutput
from .axes import LARGEST_FACTOR, AxesCheck, BandwidthCheck
from .readings import (
    ACCELEROMETER,
    GYROSCOPE,
    LEAST_RATE,
    MOVING_GYRO,
    GravityCheck,
    LoadCheck,
    RangeCheck,
    RateCheck,
    find_extremes,
)
from .stances import Axes, Finding, StanceFinder

OF_FORCE: Final = frozenset((Defect.ACC_UNIT, Defect.NO_GRAVITY, Defect.WRONG_SCALE))
"""Defects of the size of the specific force; one sensor has one of them, and its axes are not judged with it."""
BLINDING: Final = frozenset((Defect.TIME_UNIT, Defect.BURSTS, Defect.GYRO_UNIT))
"""Defects with which no stance can be found, so that gravity and axes cannot be judged."""
LONGEST_INTERVAL = 1.0 / 40.0
"""Longest mean interval between samples with which the velocity of a stride certainly closes, s."""
BLOCK = 32
"""Number of samples that are examined together, because this costs less than one by one."""
SAMPLE_SIZE = 7
"""Count of the numbers of a sample: its time, specific force and angular rate."""
EXAMINED_AGAIN = 300.0
"""Time after which axes and gravity are examined once more, s."""
UNUSABLE_TIME = 0.5
"""Time without a usable sample after which a rejected one shows the unit of all of them, s."""
STUCK_STRIDES = 3
"""Number of strides of the other foot during which a sensor that does not change is stuck; a foot may stand for one."""


@define
class SensorCheck:
    """The checks of the sensors of one foot."""

    rows: Doubles = field(factory=doubles, metadata={ROW_SIZE: SAMPLE_SIZE})
    """Numbers of the samples since the last block: of each the time, the specific force and the angular rate."""
    rates: RateCheck = field(factory=RateCheck)
    acc_range: RangeCheck = field(factory=RangeCheck)
    gyro_range: RangeCheck = field(factory=RangeCheck)
    gravity: GravityCheck = field(factory=GravityCheck)
    stances: StanceFinder = field(factory=StanceFinder)
    axes: AxesCheck = field(factory=AxesCheck)
    bandwidth: BandwidthCheck = field(factory=BandwidthCheck)
    loads: LoadCheck = field(factory=LoadCheck)
    unusable_since: float | None = None
    """Time of the first rejected sample of a foot that has no usable one yet, s; None before any."""
    same_since: float | None = None
    """Time since which every sample is the same, s; None while they change."""
    same_strides: int = 0
    """Number of strides of the other foot that began after `same_since`."""
    in_newtons: bool = False
    """Flag: the cells of the insole are in N."""
    settled_at: float | None = None
    """Time at which strides had shown all that they show, s; None while they are examined."""
    reported: list[Defect] = field(factory=list)
    """Defects that were reported."""
    mild: list[Defect] = field(factory=list)
    """Those of them that did not spoil strides; each is reported again when it does."""
    corrected: Axes | None = None
    """Correction of the axes that was reported."""


@stateful
class SensorChecks(Part):
    """Reports what cannot be right in the samples of a foot, as DefectFound; a defect is reported once for a device.

    Wrong axes are reported again when the correction is known, and a mild defect when it has become one that spoils.

    It looks for another unit of time, specific force, angular rate or pressure; for gravity that is missing or has a
    wrong size; for peaks cut off at the end of a range; for samples that are too rare, filtered, repeated or in bursts;
    and for a gyroscope whose axes do not fit those of the accelerometer. Nothing depends on the mounting, because
    stances are found by the sizes of the two vectors. Latency: times in another unit after 64 samples; units, gravity
    and ranges after some stances or some seconds of rest; axes after 6 strides, or after 3 when 8 s have passed since
    the first one. An accelerometer with all its axes reversed cannot be seen.

    Cost: sums over blocks of 32 samples. Strides are examined until some of them have shown that the axes, gravity and
    bandwidth are right, and again after 300 s."""

    needs_samples = True

    feet: PerFoot[SensorCheck] = state(factory=lambda: per_foot(SensorCheck))

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add a sample and events; return the defects that they show."""
        outputs: list[PartOutput] = []
        if view is not None and (acc := view.sample.acc) is not None and (gyro := view.sample.gyro) is not None:
            check = self.feet[view.foot]
            check.rows.extend((view.t, *acc, *gyro))
            if len(check.rows) >= BLOCK * SAMPLE_SIZE:
                pressed = view.pressed
                check.in_newtons = pressed is not None and pressed.in_newtons
                outputs += self._report(view.foot, view.t, view.known_at, _examine(check, view.gyro_bias))
                check.rows = doubles()
        for event in events:
            if isinstance(event, HeelStrike):
                self.feet[event.foot].loads.new_contacts += 1
            elif isinstance(event, StrideTaken):
                foot, other = event.foot, OTHER[event.foot]
                finding = self.feet[foot].loads.add_stride(event, self.feet[foot].in_newtons)
                if finding is not None:
                    outputs += self._report(foot, event.t, event.known_at, [finding])
                if (stuck := _stuck(self.feet[other], event)) is not None:
                    outputs += self._report(other, event.t, event.known_at, [stuck])
            elif isinstance(event, SampleRejected) and event.site.foot is not None:
                finding = _wrong_unit(self.feet[event.site.foot], event)
                outputs += self._report(event.site.foot, event.t, event.known_at, [finding])
            elif isinstance(event, DefectFound) and event.site.foot is not None:
                self.feet[event.site.foot].reported.append(event.defect)
        return outputs

    def reset(self, site: Site) -> None:
        """Forget what was found at a site, where another device is worn or the clock has restarted."""
        if site.foot is not None:
            self.feet[site.foot] = SensorCheck()

    def finish(self, now: float) -> Outputs:
        """Return wrong axes that too few strides have shown for them to be reported before."""
        return [
            event
            for foot, check in self.feet.items()
            if check.axes.wrong
            for event in self._report(foot, now, now, [check.axes.finding])
        ]

    def _report(self, foot: Foot, t: float, known_at: float, findings: Iterable[Finding | None]) -> list[DefectFound]:
        """Return the events for the findings that were not reported before."""
        check = self.feet[foot]
        return [found.event(foot, t, known_at) for found in findings if found is not None and _is_new(check, found)]


def _is_new(check: SensorCheck, finding: Finding) -> bool:
    """Return whether a finding of a foot is to be reported, and keep that it was."""
    defect, axes = finding.defect, finding.axes
    if defect in OF_FORCE and not OF_FORCE.isdisjoint(check.reported):
        return False
    is_worse = finding.spoils and defect in check.mild
    if defect in check.reported and not is_worse and (axes is None or check.corrected is not None):
        return False
    if is_worse:
        check.mild.remove(defect)
    else:
        check.reported.append(defect)
    if not finding.spoils:
        check.mild.append(defect)
    check.corrected = axes or check.corrected
    return True


def _examine(check: SensorCheck, gyro_bias: Vec3) -> list[Finding | None]:
    """Examine the block of samples and return what it shows; the gyroscope has the bias `gyro_bias`, rad/s."""
    times, *axes_of_all = [check.rows[k::SAMPLE_SIZE] for k in range(SAMPLE_SIZE)]
    accs, gyros = [*zip(*axes_of_all[:3], strict=True)], [*zip(*axes_of_all[3:], strict=True)]
    acc_ends, gyro_ends = find_extremes(accs), find_extremes(gyros)
    acc_range = max(acc_ends[0] + acc_ends[1], acc_ends[2] + acc_ends[3], acc_ends[4] + acc_ends[5])
    gyro_peak = max(gyro_ends)
    moves = gyro_peak > MOVING_GYRO
    findings = [
        check.rates.add_times(times, moves),
        check.rates.add_values(accs, gyros) if moves else None,
        check.acc_range.add(ACCELEROMETER, accs, acc_ends),
        check.gyro_range.add(GYROSCOPE, gyros, gyro_ends),
        check.gravity.add_block(times[0], times[-1], accs, acc_range, gyro_peak),
    ]
    if acc_range > 0.0 or gyros.count(gyros[0]) < len(gyros):
        check.same_since, check.same_strides = None, 0
    elif check.same_since is None:
        check.same_since = times[0]
    interval = (times[-1] - times[0]) / (len(times) - 1)
    if interval * LEAST_RATE > 1.0 or not BLINDING.isdisjoint(check.reported):
        return findings
    if check.settled_at is not None:
        if not check.settled_at <= times[-1] < check.settled_at + EXAMINED_AGAIN:
            check.settled_at, check.gravity.rested = None, False
        return findings
    axes, is_slow = check.axes, interval > LONGEST_INTERVAL
    cuts_off = check.gyro_range.cuts_off or not OF_FORCE.isdisjoint(check.reported)
    # the error of an integral grows with the square of the interval
    factor = LARGEST_FACTOR if Defect.REPEATED in check.reported else (interval / LONGEST_INTERVAL) ** 2
    axes.factor = max(1.0, min(LARGEST_FACTOR, factor))
    for t, stride in check.stances.add(zip(times, accs, gyros, strict=True), gyro_bias):
        if stride.in_a_row:
            findings.append(check.gravity.add_stance(stride.last, stride.motion))
        if stride.walked:  # what names a repair needs somebody who walks
            findings += [
                None if is_slow else check.bandwidth.add(stride),
                None if axes.settled or cuts_off else axes.add(t, stride, check.acc_range.cut_at),
            ]
    if (axes.settled or cuts_off) and check.gravity.knows_stances and (is_slow or check.bandwidth.judged):
        # what was learnt is reported, and the state of a session stays small
        check.axes, check.stances, check.settled_at = AxesCheck(), StanceFinder(), times[-1]
    return findings


def _stuck(check: SensorCheck, stride: StrideTaken) -> Finding | None:
    """Return that a sensor is stuck, if its values have not changed for some strides of the other foot."""
    if check.same_since is None or stride.t_start < check.same_since:
        return None
    check.same_strides += 1
    if check.same_strides < STUCK_STRIDES:
        return None
    text = f"every sample has been the same for {stride.t - check.same_since:.0f} s, while the other foot walks"
    return Finding(Defect.REPEATED, f"{text}: the sensor is stuck; restart it")


def _wrong_unit(check: SensorCheck, event: SampleRejected) -> Finding | None:
    """Return the wrong unit of a rejected sample, if it is that of all samples and not one disturbed value.

    A foot that has usable samples keeps no count, because a rejected sample changes no state of it."""
    if event.defect is None:
        return None
    used_at = check.rows[-SAMPLE_SIZE] if check.rows else check.rates.t
    since = check.unusable_since if used_at is None else used_at
    if since is None:
        check.unusable_since = event.t
        return None
    has_no_time = event.defect is Defect.TIME_UNIT and used_at is None
    return Finding(event.defect, event.detail) if has_no_time or event.t - since > UNUSABLE_TIME else None
