"""Track of both feet by touchdowns: each is measured from the other, and compensated by walking mode (walking-modes).

After Gong et al. 2023 (Sensors 23, 5417). One foot is the reference (touchdown.py); the other foot is V_change away
from it, (1)-(3). When the other foot comes down, it becomes the reference at P_s = P_t + V_change + epsilon_P (8), with
epsilon_P the compensation. Methods I, II and III are this part with `Height`, `NetAcceleration` and `PressureTouchdown`
without a compensation. Method IV is III with it.

places.py has P_L, P_R and V_change, compensation.py epsilon_P, recognition.py the walking mode. P_L and P_R come from
the chain of seven attitudes (limbs.py). Without sensors above the ankles they come from the feet's own inertial tracks;
a Limitation reports that once. Numbers without a source were chosen by hand.

The paper leaves these points open:

- Direction of walking, in which table 1 is given. With the chain it is the mean direction of both feet at a touchdown;
  in a bend this is the tangent half a step before. With the feet's own tracks it is the direction from the foot's
  previous touchdown to this one.
- The first heading is final when the wearer is 1.5 m from the start; earlier touchdowns are not final.
- Height. The method is planar, so heights of touchdowns are those of the feet's own tracks. These drift apart, so
  without the chain method I compares heights above each foot's last foot-flat.
- Undetected touchdowns. One is also reported if a foot becomes the reference after it has moved, or if the reference
  foot comes down elsewhere. If a foot's sign fails (signs.py), its own strides replace it. If one foot is absent,
  the other is the only reference and follows its own track."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from math import fsum, hypot
from typing import ClassVar

from ...body.part import Inputs, LimbSampled, Outputs, Position, TrackPart
from ...calibration import Calibration
from ...events import Event, Limitation, TouchedDown, WalkingModeChanged
from ...foot.rejection import rejected
from ...foot.view import FootPose, FootView, PressedCells
from ...foot.world import Covariance3
from ...types import OTHER, SITE_OF_FOOT, Foot, Sample, Site, Vec3
from ...types.attrs import evolve, field, state, stateful
from ...types.vector import TIME_EPSILON, ZERO, sub
from .compensation import epsilon_p, merge_own
from .limbs.limbs import LIMB_SITES, Legs
from .mode import LEAST_STEP_LENGTH
from .places import FootPlaces
from .recognition import Recognition
from .settings import ModesSettings
from .signs import MOST_STRIDES_WITHOUT_SIGN, Signs
from .touchdown import AnyTouchdown, Height, ReferenceFoot, displace

LEAST_MOVED_DISTANCE = 0.03
"""Least distance between two touchdowns of a foot, m. The flags of standing feet flicker, which is no touchdown."""
LEAST_OWN_STEP_LENGTH = 0.3
"""Least distance that the reference foot has moved when it takes a step, m: more than a heel that rolls over toes."""
LONGEST_WAIT = 0.06
"""Longest wait at a touchdown for the attitudes of that instant, s: three samples at the paper's 50 Hz."""
STEP_SIGMA = 0.02
"""Error of one touchdown on each axis, m."""
SCALE_SIGMA, HEADING_SIGMA = 0.02, 0.03
"""Scale error of all touchdowns, as a share of the distance from the start, and error of the first heading, rad."""


@stateful
class Modes(TrackPart):
    """Tracks the wearer by touchdowns."""

    needs_samples: ClassVar[bool] = True
    sites: ClassVar[tuple[Site, ...]] = LIMB_SITES

    touchdown: AnyTouchdown = field()
    """Method that detects touchdowns."""
    settings: ModesSettings = field(default=ModesSettings())
    places: FootPlaces = field(init=False)
    signs: Signs = field(init=False)
    recognition: Recognition = field(init=False)
    reference: ReferenceFoot = state(factory=ReferenceFoot)
    pending: tuple[Foot, float] | None = None
    """Foot and time, s, of a touchdown at which the chain is not known yet; None without one."""
    heights_t: float | None = None
    """Instant of the heights from the chain, s."""
    newest_t: dict[Foot, float] = state(factory=dict)
    """Time of the newest touchdown of each foot, s; one that an older sample of the other foot shows is not earlier."""
    touchdowns: int = 0
    """Number of touchdowns so far."""
    limitations: list[str] = state(factory=list)
    """What was reported as a limitation: each kind once for a site."""

    def __attrs_post_init__(self) -> None:
        self.signs = Signs(deepcopy(self.touchdown))
        self.recognition = Recognition(self.settings)
        self.places = FootPlaces(self.settings)

    def calibrated(self, calibration: Calibration) -> Modes:
        """Return the part with the wearer's limbs, weight and compensation; methods I to III take no compensation."""
        settings = self.settings
        compensation = settings.compensation
        if compensation is not None and calibration.modes and not settings.as_printed:
            compensation = merge_own(compensation, calibration.modes)
        limbs, weight = calibration.limbs or settings.limbs, calibration.weight or settings.weight
        return evolve(self, settings=evolve(settings, limbs=limbs, weight=weight, compensation=compensation))

    def with_heading(self, heading: float) -> Modes:
        return evolve(self, settings=evolve(self.settings, heading=heading))

    def reset(self, site: Site) -> None:
        self.places.chain.reset(site)
        self.places.mean.reset(site)
        if site.foot is not None:
            self.recognition.reset(site.foot)
            self.newest_t.clear()

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add a sample of a foot or a limb; update the reference foot, touchdowns and walking mode."""
        if view is None:
            return [
                output for event in events if isinstance(event, LimbSampled) for output in self._add_limb(event.sample)
            ]
        foot, t = view.foot, view.t
        self.places.add_view(view)
        self.places.chain.add_attitude(SITE_OF_FOOT[foot], t, view.sample.quat if view.levelled else None)
        self.signs.add_view(view, events, self.places.sides[foot].track[2])
        self.recognition.add_view(view, events)
        outputs = [] if view.pressed is None else self._add_pressure(view, view.pressed)
        return outputs + self._update_reference(foot, t, view.known_at)

    def _add_limb(self, sample: Sample) -> Outputs:
        """Add a sample of pelvis, thigh or shank."""
        chain = self.places.chain
        wrong = chain.add_limb(sample)
        if wrong is not None:
            return [rejected(sample, wrong, chain.times.get(sample.site))]
        return self._resolve_pending(sample.t, max(sample.t, sample.known_at))

    def _add_pressure(self, view: FootView, cells: PressedCells) -> list[Event]:
        """Add the cells of a foot, and report the walking mode if it has changed."""
        foot, t, known_at, state = view.foot, view.t, view.known_at, self.signs.add_pressure(view.foot, cells)
        both_feet = self.signs.feet[OTHER[foot]].has_samples
        mode = self.recognition.add_pressure(foot, state, cells.values, cells.layout, t, both_feet)
        events: list[Event] = []
        if mode is not None:
            events.append(WalkingModeChanged(t=t, known_at=known_at, mode=mode, foot=foot))
        if self.recognition.is_blind(foot):
            what = f"the cells of the {foot.value} insole do not tell left from right: no walking modes"
            events += self._limit("blind", what, SITE_OF_FOOT[foot], t, known_at)
        return events

    def _limit(self, kind: str, what: str, site: Site | None, t: float, known_at: float) -> list[Event]:
        """Return a limitation, unless one of this kind was reported for this site."""
        name = f"{kind} {site}"
        if name in self.limitations:
            return []
        self.limitations.append(name)
        return [Limitation(t=t, known_at=known_at, site=site, what=what)]

    def _is_alone(self, foot: Foot, t: float) -> bool:
        """Return whether the other foot is lost, or has sent no samples while this one took strides."""
        if not self.signs.feet[OTHER[foot]].has_samples:
            return self.signs.feet[foot].stride_count >= MOST_STRIDES_WITHOUT_SIGN
        return self.places.is_lost(OTHER[foot], t)

    def _update_reference(self, foot: Foot, t: float, known_at: float) -> list[Event]:
        """Update the reference foot, and return the events of a touchdown."""
        events = self._resolve_pending(t, known_at)
        sign_t = self._measure_heights(t) if isinstance(self.touchdown, Height) else t
        other = OTHER[foot]
        alone = foot if self._is_alone(foot, t) else other if self._is_alone(other, t) else None
        if alone is None and not all([sign.has_samples for sign in self.signs.feet.values()]):
            return events
        if alone is foot:
            what = f"the {other.value} foot is not heard: the wearer goes by the {foot.value} foot's own track"
            events += self._limit("alone", what, SITE_OF_FOOT[other], t, known_at)
        down_before, reference = self.reference.down, self.reference.foot
        flags = self.signs.down_flags(t, alone, known_at, events)
        change = self.reference.update(flags)
        if change is not None:
            new_reference, comes_down = change
            # a foot that was down all the time makes no touchdown
            if comes_down or self.places.sides[new_reference].moved_distance >= LEAST_STEP_LENGTH:
                events += self._flush_pending(known_at)
                self.pending = (new_reference, sign_t)
                events += self._resolve_pending(t, known_at)
        elif reference is not None:
            k = 0 if reference is Foot.LEFT else 1
            came_down = flags[k] and not down_before[k]
            if came_down and self.places.sides[reference].moved_distance > LEAST_OWN_STEP_LENGTH:
                events += self._flush_pending(known_at)
                events += self._add_touchdown(reference, t, known_at, by_own_track=True)
        return events

    def _measure_heights(self, t: float) -> float:
        """Set the heights of both feet at the latest instant at which the chain is known; return that instant, s."""
        chain = self.places.chain
        complete = chain.complete() if chain.is_current(t) else None
        if complete is None or complete != self.heights_t:
            self.heights_t = complete
            for foot, sign in self.signs.feet.items():
                own = self.places.sides[foot].track[2] - sign.flat_height
                sign.state.height = own if complete is None else chain.height(foot, complete)
        return t if complete is None else min(t, complete)

    def _flush_pending(self, known_at: float) -> list[Event]:
        """Compute the pending touchdown with the newest attitudes."""
        if self.pending is None:
            return []
        (foot, touchdown_t), self.pending = self.pending, None
        return self._add_touchdown(foot, touchdown_t, known_at)

    def _resolve_pending(self, t: float, known_at: float) -> list[Event]:
        """Compute the pending touchdown once all attitudes of its instant are known, or after `LONGEST_WAIT`."""
        if self.pending is None:
            return []
        (_, touchdown_t), chain = self.pending, self.places.chain
        if t - touchdown_t < LONGEST_WAIT and chain.is_current(touchdown_t):
            complete = chain.complete()
            if complete is not None and complete < touchdown_t - TIME_EPSILON:
                return []
        return self._flush_pending(known_at)

    def _add_touchdown(self, foot: Foot, t: float, known_at: float, by_own_track: bool = False) -> list[Event]:
        """Add a touchdown, as in the flow of fig. 12.

        `by_own_track` is True if the foot itself is the reference, so that only its own track has its place."""
        places, side, chain = self.places, self.places.sides[foot], self.places.chain
        if chain.is_current(t):
            chain.add_first_step(places.first_step_foot(foot), t)
        if by_own_track or self._is_alone(foot, t):
            (x, y, _), chained = side.own_position, False
            place = (x, y, side.track[2])
        else:
            place, chained = places.locate(foot, t)
        dx, dy, _ = sub(place, side.place)
        step = hypot(dx, dy)
        self.recognition.add_touchdown(foot, step)
        if step < LEAST_MOVED_DISTANCE:
            return []
        compensation, mode = ZERO, self.recognition.mode_at_touchdown(foot)
        if step > LEAST_STEP_LENGTH:
            side.direction = places.walking_direction(t) if chained else (dx / step, dy / step)
            chain.given_up = chain.given_up or not chain.aligned
            if self.settings.compensation is not None:
                compensation = epsilon_p(self.settings.compensation, foot, mode, side.direction)
        places.set_down(foot, displace(place, compensation), chained, t)
        t = self.newest_t[foot] = max(t, self.newest_t.get(foot, t))
        self.touchdowns += 1
        legs = chain.legs(t)
        events: list[Event] = []
        if not chained and legs is None:
            what = f"{chain.why_unusable(t)}: the feet are where their own inertial tracks have them"
            events = self._limit("chain", what, None, t, known_at)
        touchdown = TouchedDown(
            t=t, known_at=max(t, known_at), final=places.heading_settled or not chained, foot=foot,
            position=side.place, mode=mode, compensation=compensation, legs=legs,
        )  # fmt: skip
        return [*events, touchdown]

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Return the mean of the reference foot's touchdown and the other foot's present place."""
        poses = list(feet.values())
        if not poses:
            return None
        t = max([pose.t for pose in poses])
        for pose in poses:
            if OTHER[pose.foot] not in feet or self.places.is_lost(OTHER[pose.foot], t):
                place = self.places.middle(pose.foot)
                return Position(t, place, self._covariance(place, [pose]))
        moving = None if self.reference.foot is None else OTHER[self.reference.foot]
        both = [self.places.locate(foot, t)[0] if foot is moving else side.place
                for foot, side in self.places.sides.items()]  # fmt: skip
        x, y, z = (0.5 * (one + other) for one, other in zip(*both, strict=True))
        return Position(t, (x, y, z), self._covariance((x, y, z), poses))

    @property
    def legs(self) -> tuple[float, Legs] | None:
        """Time, s, and rods of both legs then, as they are known now; None while an attitude is not known."""
        t = self.places.chain.complete()
        rods = None if t is None else self.places.chain.legs(t)
        return None if t is None or rods is None else (t, rods)

    def _covariance(self, place: Vec3, poses: list[FootPose]) -> Covariance3:
        """Return the covariance by errors of touchdowns, scale and first heading, m^2; for z, that of the tracks."""
        x, y, _ = place
        variance = STEP_SIGMA**2 * (1 + self.touchdowns)
        scale, turn = SCALE_SIGMA**2, HEADING_SIGMA**2
        of_tracks = [fsum(c) / len(poses) ** 2 for c in zip(*[foot.covariance for foot in poses], strict=True)]
        k = 0.0 if self.places.chain.aligned else 1.0
        return (
            variance + scale * x * x + turn * y * y + k * of_tracks[0],
            (scale - turn) * x * y + k * of_tracks[1],
            0.0,
            variance + scale * y * y + turn * x * x + k * of_tracks[3],
            0.0,
            of_tracks[5],
        )
