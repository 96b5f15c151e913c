"""Both feet by touchdowns: each is measured from the other, and compensated by walking mode (walking-modes).

After Gong et al. 2023 (Sensors 23, 5417): one foot carries (touchdown.py), the other is V_change away from it, (1)-(3);
when it comes down it carries on from there, with a compensation, P_s = P_t + V_change + epsilon_P (8). Methods I, II
and III are this part with `Height`, `NetAcceleration`, `PressureTouchdown` and no compensation; IV is III with it.

P_L, P_R and V_change are a matter of places.py, epsilon_P of compensation.py, and the mode that it is for is told by
recognition.py. P_L and P_R come from the chain of seven attitudes (limbs.py). Without sensors above the ankles they are
the feet's own inertial tracks, set apart by the width of the hips at the start: said once, in a Limitation.

What the paper leaves open, and what is taken here:

- Direction of walking, which table 1 is along. It is where both feet point together when one has come down, which in
  a bend is the tangent half a step back; with the feet's own tracks it is that of the foot's stride, from its last
  touchdown to this one.
- The first heading is settled when the wearer has gone 1.5 m; touchdowns before that are not final.
- Height. The method is planar; heights of touchdowns are those of the feet's own tracks. Those drift apart, so without
  the chain method I compares how far each foot is above its own last foot-flat.
- Feet of which a touchdown was not seen. One that takes over although it has gone on since its last touchdown came down
  meanwhile: it is one. So is one that carries and comes down elsewhere. A foot whose sign fails (evidence.py) comes
  down as its own steps do; without the other foot it carries alone, along its own track.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from math import atan2, hypot
from typing import ClassVar

from ...body.part import PartOutput, Position, TrackPart
from ...calibration import Calibration
from ...events import Event, Limitation, TouchedDown, WalkingModeChanged
from ...foot.rejection import rejected
from ...foot.view import FootPose, FootView, PressedCells
from ...foot.world import Covariance3
from ...types import OTHER, SITE_OF_FOOT, Foot, Sample, Site
from ...types.attrs import define, evolve, field
from ...types.vector import TIE, ZERO, sub
from .compensation import epsilon_p, with_own
from .evidence import UNSEEN
from .limbs.above import Above
from .limbs.limbs import ABOVE
from .mode import LEAST_STEP
from .places import FootPlaces
from .recognition import Recognition
from .settings import ModesSettings
from .signs import Signs
from .touchdown import AnyTouchdown, Carrier, Height, PressureTouchdown, suspended

AWAY = 0.03
"""A foot that comes down nearer to where it stood was not away, m: the flags of standing feet flicker."""
HOP = 0.3
"""A foot that carries and comes down so far from where it was has gone there itself, m: the heel of one that rolls over
its toes does not come so far."""
PATIENCE = 0.06
"""How long a touchdown waits for attitudes of its instant, s: three samples of the paper's 50 Hz."""
STEP_SIGMA = 0.02
"""What one touchdown errs by, m an axis."""
SCALE_SIGMA, HEADING_SIGMA = 0.02, 0.03
"""Share of the way by which all of them err alike; of the first heading, rad."""


@define
class Modes(TrackPart):
    """The wearer's track by touchdowns."""

    needs_samples: ClassVar[bool] = True
    sites: ClassVar[tuple[Site, ...]] = ABOVE

    touchdown: AnyTouchdown = field(factory=PressureTouchdown)
    settings: ModesSettings = ModesSettings()
    places: FootPlaces = field(init=False)
    above: Above = field(factory=Above, init=False)
    signs: Signs = field(init=False)
    recognition: Recognition = field(init=False)
    carrier: Carrier = field(factory=Carrier, init=False)
    coming: tuple[Foot, float] | None = field(default=None, init=False)
    """The foot that came down, and when, s, while the chain does not know that instant yet."""
    measured: float | None = field(default=None, init=False)
    """The instant that the chain's heights are of, s."""
    touchdowns: int = field(default=0, init=False)
    limited: bool = field(default=False, init=False)
    """Why the chain is not used has been said."""
    unheard: list[Foot] = field(factory=list, init=False)
    """Feet of which it was said that the other goes on without them."""
    blind: list[Foot] = field(factory=list, init=False)
    """Feet of which it was said that their cells tell no mode."""

    def __attrs_post_init__(self) -> None:
        self.signs = Signs(deepcopy(self.touchdown))
        self.recognition = Recognition(self.settings)
        self.places = FootPlaces(self.settings)

    def calibrated(self, calibration: Calibration) -> Modes:
        """The same with the wearer's limbs, weight and compensation; what methods I to III do without stays out."""
        settings = self.settings
        compensation = settings.compensation
        if compensation is not None and calibration.modes:
            compensation = with_own(compensation, calibration.modes)
        limbs, weight = calibration.limbs or settings.limbs, calibration.weight or settings.weight
        return evolve(self, settings=evolve(settings, limbs=limbs, weight=weight, compensation=compensation))

    def feed_limb(self, sample: Sample) -> Sequence[PartOutput]:
        """A sample of pelvis, thigh or shank: its attitude, or acceleration and angular velocity."""
        t = sample.t
        wrong = self.above.take(sample, self.places.chain)
        if wrong is not None:
            return [rejected(sample, wrong, self.above.times.get(sample.site))]
        return self._awaited(t, t if sample.known_at is None else max(t, sample.known_at))

    def reset(self, site: Site) -> None:
        self.places.chain.reset(site)
        self.places.tracks.reset(site)
        self.above.reset(site)

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """A sample of a foot: who carries, what has come down, and what the contact that ended tells."""
        foot, t, known_at, sample = view.foot, view.t, view.known_at, view.sample
        self.above.passed(t)
        self.places.moved(view)
        if view.levelled and self.above.times:  # without sensors above the ankles there is no chain
            if sample.quat is not None:
                self.places.chain.told(SITE_OF_FOOT[foot], t, sample.quat)
            elif sample.acc is not None:
                heading = None if view.north is None else atan2(-view.north[1], view.north[0])
                self.places.chain.told_own(SITE_OF_FOOT[foot], t, view.attitude, heading)
        self.signs.moved(view, self.places.sides[foot].track[2])
        told = [] if view.pressed is None else self._pressed(view, view.pressed)
        return told + self._carry(foot, t, known_at)

    def _carry(self, foot: Foot, t: float, known_at: float) -> list[Event]:
        events = self._awaited(t, known_at)
        seen = self._heights(t) if isinstance(self.touchdown, Height) else t
        other = OTHER[foot]
        alone = foot if self._alone(foot, t) else other if self._alone(other, t) else None
        if alone is None and len(self.signs.shown) < len(Foot):
            return events
        if alone is foot and foot not in self.unheard:
            self.unheard.append(foot)
            what = f"the {other.value} foot is not heard: the wearer goes by the {foot.value} foot's own track"
            events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[other], what=what))
        before = self.carrier.down
        flags = self.signs.down(t, alone, known_at, events)
        taken = self.carrier.update(flags)
        if taken is None:
            here = self.carrier.foot
            k = 0 if here is Foot.LEFT else 1
            if here is not None and flags[k] and not before[k] and self.places.sides[here].gone > HOP:
                events += self._flushed(known_at)
                events += self._came_down(here, t, known_at, by_itself=True)
            return events
        if not taken[1] and self.places.sides[taken[0]].gone < LEAST_STEP:
            return events  # a foot that has been down all the time carries from where it is
        events += self._flushed(known_at)
        self.coming = (taken[0], seen)
        return events + self._awaited(t, known_at)

    def _alone(self, foot: Foot, t: float) -> bool:
        """Nothing is heard of the other foot while this one takes steps, or how it lies to this one is not known."""
        other = OTHER[foot]
        if other not in self.signs.shown:
            return self.signs.evidence[foot].taken >= UNSEEN
        return self.places.unheard(other, t)

    def _heights(self, t: float) -> float:
        """Take the heights of both feet, by the chain at the latest instant that it knows. Returns that instant, s."""
        chain = self.places.chain
        complete = chain.complete() if chain.current(t) else None
        if complete is not None and complete == self.measured:
            return min(t, complete)
        self.measured = complete
        for foot, state in self.signs.shown.items():
            own = self.places.sides[foot].track[2] - state.floor
            state.height = own if complete is None else chain.height(foot, complete)
        return t if complete is None else min(t, complete)

    def _flushed(self, known_at: float) -> list[Event]:
        """What still waits is worked out as it is."""
        if self.coming is None:
            return []
        (foot, came), self.coming = self.coming, None
        return self._came_down(foot, came, known_at)

    def _awaited(self, t: float, known_at: float) -> list[Event]:
        """A touchdown is worked out once every attitude of that instant is there, or has not come for `PATIENCE`."""
        if self.coming is None:
            return []
        _, came = self.coming
        chain = self.places.chain
        if chain.current(came) and t - came < PATIENCE:
            complete = chain.complete()
            if complete is not None and complete < came - TIE:
                return []
        return self._flushed(known_at)

    def _pressed(self, view: FootView, cells: PressedCells) -> list[Event]:
        """The cells of a foot: what they show of it, and whether they tell another mode."""
        foot, t, known_at, state = view.foot, view.t, view.known_at, self.signs.pressed(view.foot, cells)
        both_heard = OTHER[foot] in self.signs.shown
        mode = self.recognition.pressed(foot, state, cells.values, cells.layout, t, both_heard)
        told: list[Event] = []
        if mode is not None:
            told.append(WalkingModeChanged(t=t, known_at=known_at, mode=mode, foot=foot))
        if self.recognition.blind(foot) and foot not in self.blind:
            self.blind.append(foot)
            what = f"the cells of the {foot.value} insole do not tell left from right: no walking modes"
            told.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[foot], what=what))
        return told

    def _came_down(self, foot: Foot, t: float, known_at: float, by_itself: bool = False) -> list[Event]:
        """`by_itself`: it carried already, so that nothing but its own track tells where it is now."""
        places = self.places
        side, chain = places.sides[foot], places.chain
        if chain.current(t):
            swung = places.swung(foot)
            x, y, _ = sub(places.sides[swung].own, places.sides[swung].place)
            chain.stepped(swung, t, atan2(y, x) if places.headed else 0.0)
        if by_itself or self._alone(foot, t):
            (x, y, _), chained = side.own, False
            place = (x, y, side.track[2])
        else:
            place, chained = places.seen(foot, t)
        dx, dy = place[0] - side.place[0], place[1] - side.place[1]
        step = hypot(dx, dy)
        self.recognition.stepped(foot, step)
        if step < AWAY:
            return []
        compensation, mode = ZERO, self.recognition.walks(foot)
        if step > LEAST_STEP:
            side.direction = places.facing(t) if chained else (dx / step, dy / step)
            if not chain.aligned:
                chain.given_up = True
            if self.settings.compensation is not None:
                compensation = epsilon_p(self.settings.compensation, foot, mode, side.direction)
        places.put(foot, suspended(place, compensation), chained, t)
        self.touchdowns += 1
        events: list[Event] = []
        if not (chained or self.limited or chain.current(t)):
            self.limited = True
            what = f"{chain.why_not(t, self.above.times)}: the feet are where their own inertial tracks have them"
            events.append(Limitation(t=t, known_at=known_at, site=None, what=what))
        final = places.headed or not (chained or chain.hopeful())
        came = TouchedDown(
            t=t, known_at=known_at, final=final, foot=foot, position=side.place, mode=mode, compensation=compensation
        )
        return [*events, came]

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """The mean of both feet: where the carrying one came down, and where the other is now."""
        known = list(feet.values())
        if not known:
            return None
        t = max([pose.t for pose in known])
        for pose in known:
            if OTHER[pose.foot] not in feet or self.places.unheard(OTHER[pose.foot], t):
                x, y, z = self.places.middle(pose.foot)
                return Position(t, (x, y, z), self._covariance(x, y, [pose]))
        carrying = self.carrier.foot
        places = []
        for foot, side in self.places.sides.items():
            moving = carrying is not None and foot is not carrying
            places.append(self.places.seen(foot, t)[0] if moving else side.place)
        x, y, z = (0.5 * (one + other) for one, other in zip(*places, strict=True))
        return Position(t, (x, y, z), self._covariance(x, y, known))

    def _covariance(self, x: float, y: float, known: list[FootPose]) -> Covariance3:
        """Touchdowns that err each for itself and all alike, and a first heading that errs; z is the tracks'."""
        each = STEP_SIGMA**2 * (1 + self.touchdowns)
        scale, turn = SCALE_SIGMA**2, HEADING_SIGMA**2
        xx, yy = each + scale * x * x + turn * y * y, each + scale * y * y + turn * x * x
        xy = (scale - turn) * x * y
        own = [sum([foot.covariance[i] for foot in known]) / len(known) ** 2 for i in range(6)]
        if not self.places.chain.aligned:
            xx, xy, yy = xx + own[0], xy + own[1], yy + own[3]
        return (xx, xy, 0.0, yy, 0.0, own[5])
