"""Contact and flight time, strike angle and vertical oscillation of a runner, from a measured gait cycle or from means.

    from solepath.show.report.running import running_cycle

    for event in session.feed(samples):
        if isinstance(event, GaitCycleMeasured) and (run := running_cycle(event)) is not None:
            print(run.contact_time, run.flight_time, run.strike_angle, run.vertical_oscillation)

Nothing on the live path imports this module."""

from __future__ import annotations

from math import pi

from ...body.gait.means import GaitParameters
from ...events.gait_cycle import GaitCycleMeasured
from ...types.attrs import frozen
from ...types.vector import GRAVITY

MAX_SLOPE = 0.05
"""Largest rise over run with which the spring-mass model is used: contact and flight times do not give the oscillation
on an incline (Meyer et al. 2023, Int. J. Sports Med. 44); the limit is chosen, not measured."""


@frozen
class Running:
    """The measures of one gait cycle of a runner, or their means; a value that is not known is None."""

    contact_time: float
    """Time from initial contact to toe-off of one foot, s (Novacheck 1998, Gait & Posture 7)."""
    flight_time: float | None
    """Time from toe-off of this foot to the other foot's contact, in which no foot is on the ground, s.

    It is None without the other foot, while the clocks of the feet cannot be compared, and if it would be negative."""
    strike_angle: float | None
    """Pitch of the foot at initial contact relative to the flat sole, rad; positive toe up, as of a rearfoot strike,
    negative of a forefoot strike (Altman and Davis 2012, Gait & Posture 35)."""
    vertical_oscillation: float | None
    """Estimate of the rise of the body's centre of mass from its lowest to its highest point in a step, m.

    It is not measured but follows from contact and flight time by a spring-mass model (`vertical_oscillation`). It is
    None without a flight time, and on an incline."""


def running_cycle(cycle: GaitCycleMeasured) -> Running | None:
    """Return the measures of a runner's gait cycle; None for a cycle of walking."""
    if not cycle.running:
        return None
    rise, length = cycle.rise, cycle.stride_length
    level = rise is None or length is None or abs(rise) <= MAX_SLOPE * length
    return _running(cycle.stance_time, cycle.terminal_double_support, cycle.heel_strike_angle, level)


def running_means(parameters: GaitParameters) -> Running | None:
    """Return the measures of both feet by the means of steady strides; None for means of walking.

    Steady strides are level ones (body/gait/cycles.py)."""
    both = parameters.both
    if not parameters.running or both.stance_time is None:
        return None
    others = (both.terminal_double_support, both.heel_strike_angle)
    support, angle = [None if figure is None else figure.mean for figure in others]
    return _running(both.stance_time.mean, support, angle, True)


def vertical_oscillation(contact_time: float, flight_time: float) -> float:
    """Return the vertical oscillation of a runner's centre of mass in a step, m, from two times, s.

    Morin et al. 2005 (J. Appl. Biomech. 21) take the vertical force during contact as half a sine wave, so that its
    maximum is F = m g (pi / 2) (flight / contact + 1), and the centre of mass sinks by F contact^2 / (m pi^2) -
    g contact^2 / 8 in the first half of the contact. In half of the flight it rises by g flight^2 / 8, which is added
    here. Stiffness by this model is 0.7 to 6.9 % lower than from a force plate (the same paper)."""
    sinking = contact_time * (flight_time + contact_time) / (2.0 * pi) - 0.125 * contact_time**2
    return GRAVITY * (sinking + 0.125 * flight_time**2)


def _running(contact_time: float, double_support: float | None, strike_angle: float | None, level: bool) -> Running:
    """Return the measures; a negative terminal double support, s, is a flight."""
    flight = None if double_support is None or double_support > 0.0 else -double_support
    oscillation = None if flight is None or not level else vertical_oscillation(contact_time, flight)
    return Running(contact_time, flight, strike_angle, oscillation)
