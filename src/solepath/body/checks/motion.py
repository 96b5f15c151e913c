"""Strides that no person can take: too fast, too high, or with a foot at an angle that no ankle allows.

It is the last line of defence: the parts and links before it find faults by their causes, and this part finds what
follows from any other. The limits are those of people, not of what recordings show, and each has a source."""

from __future__ import annotations

from math import degrees, radians, sqrt

from ...events import Defect, DefectFound, Flaw, SampleGap, StrideTaken
from ...foot.view import FASTEST_RUN, LONGEST_STRIDE, FootView
from ...types import PerFoot, Site, per_foot
from ...types.attrs import define, evolve, state, stateful
from ...types.vector import GRAVITY
from ..activity.flights import HIGHEST_RISE, integrated_rise
from ..part import Inputs, Outputs, Part, PartOutput, Replacement
from .stances import Finding

LONGEST_LEG = 1.15
"""Length of the longest legs, from hip to ground, m: 0.53 of a height of 2.1 m."""
FASTEST_WALK = sqrt(GRAVITY * LONGEST_LEG)
"""Largest speed with a foot on the ground all the time, m/s: that of the Froude number 1.

The body moves over the foot in an arc of the leg's length; at a higher speed gravity cannot keep it on that arc
(Alexander, "The gait of bipedal and quadrupedal animals", Int. J. Robotics Research 3, 1984)."""
LEAST_WALKING_STANCE = 0.55
"""Share of a stride with the foot on the ground from which on one foot always is, however even the feet are.

It is one half; the rest is the error of heel-strike and toe-off, 50 ms of a stride of one second."""
LARGEST_TOE_OFF_ANGLE, LEAST_TOE_OFF_ANGLE = radians(120.0), radians(-45.0)
"""Limits of the angle of the foot at toe-off, heel up positive, rad.

The shank leans forward by less than 70 degrees, and the ankle extends by 50 (American Academy of Orthopaedic Surgeons,
"Joint motion", 1965). A foot that is lifted flat may have its toes up by the 20 degrees to which the ankle bends."""
LARGEST_HEEL_STRIKE_ANGLE = radians(75.0)
"""Limit of the size of the angle of the foot at heel-strike, rad.

The shank leans by less than 50 degrees; the ankle bends by 20 and extends by 50, but extends only on steep ground."""
MOST_RECENT = 8
"""Number of recent strides of a foot that are counted."""
LEAST_RECENT = 4
"""Number of recent strides from which on their majority counts."""
LONG_STRIDES = 2
"""Number of strides of an impossible length that show that more than one stance is at fault."""

ADVICE = (
    "Check the units (m/s^2 with gravity, rad/s, s), that both sensors of the device use the same axes, and that it is"
    " fixed to the shoe"
)
"""Advice for a person whose strides cannot be right."""


@define
class FootRecord:
    """The recent strides of one foot."""

    recent: tuple[bool, ...] = ()
    """Flag of each of the recent strides, the oldest first: the stride was impossible."""
    gap_at: float | None = None
    """Time of the last gap between samples, s: what a stride does in a gap is not known. None before any."""
    too_long: int = 0
    """Number of strides of an impossible length, without those in gaps."""
    one_reported: bool = False
    """Flag: a single impossible stride was reported."""
    all_reported: bool = False
    """Flag: it was reported that most strides are impossible."""


@stateful
class PossibleMotion(Part):
    """Marks impossible strides as degraded, and reports them once, and once more when most strides are impossible.

    Latency: none; a stride is replaced before the parts after this one receive it."""

    feet: PerFoot[FootRecord] = state(factory=lambda: per_foot(FootRecord))

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        outputs: list[PartOutput] = []
        for event in events:
            if isinstance(event, StrideTaken):
                outputs += self._add_stride(event, self.feet[event.foot])
            elif isinstance(event, DefectFound | SampleGap) and event.site.foot is not None:
                record = self.feet[event.site.foot]
                if isinstance(event, SampleGap):
                    record.gap_at = event.t
                elif event.spoils:
                    record.one_reported = record.all_reported = True  # the cause is known
        return outputs

    def _add_stride(self, event: StrideTaken, record: FootRecord) -> Outputs:
        motion = impossible_motion(event)
        reason = motion or impossible_angle(event)
        record.recent = (*record.recent[1 - MOST_RECENT :], reason is not None)
        if reason is None:
            return ()
        has_gap = record.gap_at is not None and event.t_start <= record.gap_at <= event.t_end
        is_too_long = event.length > LONGEST_STRIDE and not has_gap
        record.too_long += is_too_long
        most = len(record.recent) >= LEAST_RECENT and 2 * record.recent.count(True) > len(record.recent)
        several = most or record.too_long >= LONG_STRIDES
        if several:
            is_new, record.all_reported = not record.all_reported, True
            text = f"{'most' if most else 'several'} strides cannot be right: the last one has {reason}. {ADVICE}"
        else:
            is_new = motion is not None and not record.one_reported and (is_too_long or not event.flaws)
            text = f"a stride cannot be right, because it has {reason}; it is marked as degraded. If it happens again: "
            text += ADVICE
        output: list[PartOutput] = []
        if motion is not None and not event.flaws:
            output.append(Replacement(event, evolve(event, flaws=(*event.flaws, Flaw.IMPOSSIBLE))))
        if is_new:
            record.one_reported = True
            finding = Finding(Defect.IMPOSSIBLE_MOTION, text, spoils=several)
            output.append(finding.event(event.foot, event.t, event.known_at))
        return output

    def reset(self, site: Site) -> None:
        if site.foot is not None:
            self.feet[site.foot] = FootRecord()


def impossible_motion(stride: StrideTaken) -> str | None:
    """Return a phrase with a speed or height of this stride that no person has; None without one."""
    duration = stride.t_end - stride.t_start
    speed = stride.length / duration if duration > 0.0 else 0.0
    if speed > FASTEST_RUN:
        return f"a speed of {speed:.0f} m/s"
    if stride.length > LONGEST_STRIDE:
        return f"a length of {stride.length:.0f} m"
    t_toe_off, t_heel_strike = stride.t_toe_off, stride.t_heel_strike
    if speed > FASTEST_WALK and t_toe_off is not None and t_heel_strike is not None:
        stance = 1.0 - (t_heel_strike - t_toe_off) / duration
        if stance > LEAST_WALKING_STANCE:
            return f"a speed of {speed:.1f} m/s at a walk"
    rise = integrated_rise(stride)
    if abs(rise) > HIGHEST_RISE:
        return f"a height of {rise:.1f} m"
    return None


def impossible_angle(stride: StrideTaken) -> str | None:
    """Return a phrase with an angle of the foot that no person has; None without one.

    Alone it leaves the path of the stride as it is: after a gap, the axis of the angles may be wrong for a stride."""
    features = stride.features
    toe_off, heel_strike = features.toe_off_angle, features.heel_strike_angle
    if toe_off is not None and not LEAST_TOE_OFF_ANGLE < toe_off < LARGEST_TOE_OFF_ANGLE:
        return f"an angle of {degrees(toe_off):.0f} degrees at toe-off"
    if heel_strike is not None and abs(heel_strike) > LARGEST_HEEL_STRIKE_ANGLE:
        return f"an angle of {degrees(heel_strike):.0f} degrees at heel-strike"
    return None
