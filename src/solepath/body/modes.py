"""Both feet by touchdowns: each is measured from the other, and compensated by walking mode (walking-modes).

After Gong et al. 2023 (Sensors 23, 5417): one foot carries (touchdown.py), the other is V_change away from it, (1)-(3);
when it comes down it carries on from there, with a compensation, P_s = P_t + V_change + epsilon_P (8). Methods I, II
and III are this part with `Height`, `NetAcceleration`, `MaximumPressure` and no compensation; IV is III with it.

P_L and P_R come from the chain of seven attitudes (limbs.py). Without sensors above the ankles they are the feet's own
inertial tracks, set apart by the width of the hips at the start: said once, in a Limitation.

What the paper leaves open, and what is taken here:

- Unit of table 1. Its header says mm, but values of 0.34 to 1.8 mm would move the end of a side of 4 m, some six or
  seven steps, by less than 5 mm, while table 4 has IV better than III by up to 15 cm there. Centimetres fit that in
  kind. Table 4 is headed mm as well, and its values (0.17 at the corner C of 4.0 m) are metres.
- Axes of table 1. x goes across and y along the direction of walking; x to the right, so that x, y and up are right
  handed. The direction is where both feet point together when one has come down, which in a bend is the tangent half a
  step back; with the feet's own tracks it is that of the foot's stride, from its last touchdown to this one.
- When the mode is known. A contact tells its mode when it ends, long after the touchdown that it began with. But when
  a foot comes down the other has borne the whole weight, and what that contact has shown up to then is the mode of the
  step that ends; where it shows none, the latest that it told. Standing is no mode to walk in: the first step after
  it is taken for a straight one.
- The first heading is settled when the wearer has gone 1.5 m; touchdowns before that are not final.
- Height. The method is planar; heights of touchdowns are those of the feet's own tracks.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, cos, hypot, pi, sin

from attrs import define, evolve, field

from ..calibration import Calibration, Limbs
from ..events import Event, Limitation, TouchedDown, WalkingModeChanged
from ..foot.refusal import refusal, rejected
from ..foot.tracker import FootTracker
from ..foot.world import Covariance3
from ..types import SITE_OF_FOOT, Foot, Sample, Site, Vec3, WalkingMode
from ..vector import GRAVITY, TIE, ZERO, rotate, sub
from .inclination import Inclination
from .limbs import ABOVE, LowerLimbs
from .mode import LEAST_STEP, LINGERS, STANDING_WEIGHT, TH, Contact, at_pace, decide
from .position import Position
from .touchdown import OTHER, AnyTouchdown, Carrier, FootState, Height, MaximumPressure, suspended, v_change

Compensation = dict[Foot, dict[WalkingMode, tuple[float, float]]]
"""(forward, left), m, by the foot that comes down and the mode."""

_CM = 0.01
TABLE_1: Compensation = {
    foot: {mode: (y * _CM, -x * _CM) for mode, (x, y) in row.items()}
    for foot, row in {
        Foot.LEFT: {
            WalkingMode.STRAIGHT: (0.34, 0.55),
            WalkingMode.LEFT_WIDE: (0.19, 0.27),
            WalkingMode.LEFT_TIGHT: (0.35, 0.97),
            WalkingMode.RIGHT_WIDE: (-0.94, -0.52),
            WalkingMode.RIGHT_TIGHT: (-1.28, -1.73),
        },
        Foot.RIGHT: {
            WalkingMode.STRAIGHT: (-0.23, 0.62),
            WalkingMode.LEFT_WIDE: (0.97, -0.48),
            WalkingMode.LEFT_TIGHT: (1.25, -1.8),
            WalkingMode.RIGHT_WIDE: (-0.16, 0.24),
            WalkingMode.RIGHT_TIGHT: (-0.34, 1.02),
        },
    }.items()
}
"""Table 1, (x, y) in cm, as it is used here. It holds for the paper's wearers, limbs and sensors; `solepath calibrate
modes` finds a wearer's own."""

AWAY = 0.03
"""A foot that comes down nearer to where it stood was not away, m: the flags of standing feet flicker."""
FIRST_WAY = 1.5
"""So far the middle between the feet must go to tell the first heading for good, m."""
PATIENCE = 0.06
"""How long a touchdown waits for attitudes of its instant, s: three samples of the paper's 50 Hz."""


@define
class Side:
    """What is held of one foot."""

    place: Vec3 = ZERO
    """Where it last came down: the ground below its ankle (by the chain) or its sensor (by its track), world, m."""
    offset: Vec3 = ZERO
    """From its track to its place, m."""
    reach: tuple[float, float] = (0.0, 0.0)
    """From below its ankle to its end when it came down, world, m."""
    # state
    t: float | None = field(default=None, init=False)
    """Of its newest sample, s."""
    state: FootState = field(factory=FootState, init=False)
    track: Vec3 = field(default=ZERO, init=False)
    """Its own inertial track, m."""
    direction: tuple[float, float] = field(default=(1.0, 0.0), init=False)
    """Of walking when it last came down, of length 1."""
    step: float = field(default=0.0, init=False)
    """Length of the stride that ended with its last touchdown, m."""
    contact: Contact = field(factory=Contact, init=False)
    pressed: bool = field(default=False, init=False)
    """Its contact lasts."""
    mode: WalkingMode | None = field(default=None, init=False)
    """The latest that its contacts told."""


@define
class Modes:
    """See above. `compensation`: epsilon_P, None for methods I to III. `weight`: of the wearer, N; None: it is learnt
    as the mean of what both feet bear. `heading`: where the wearer looks at the start, in the world that the devices
    share, rad, where it is known (`LowerLimbs.facing`). `th`: see mode.py."""

    touchdown: AnyTouchdown = field(factory=MaximumPressure)
    compensation: Compensation | None = None
    limbs: Limbs = field(factory=Limbs)
    weight: float | None = None
    heading: float | None = None
    th: float = TH
    step_sigma: float = 0.02
    """What one touchdown errs by, m an axis."""
    scale_sigma: float = 0.02
    """Share of the way by which all of them err alike."""
    heading_sigma: float = 0.03
    """Of the first heading, rad."""
    # state
    chain: LowerLimbs = field(init=False)
    leaning: dict[Site, Inclination] = field(factory=dict, init=False)
    limb_times: dict[Site, float] = field(factory=dict, init=False)
    sides: dict[Foot, Side] = field(init=False)
    carrier: Carrier = field(factory=Carrier, init=False)
    pressing: MaximumPressure = field(factory=MaximumPressure, init=False)
    """Begins and ends the contacts that tell a mode."""
    coming: tuple[Foot, float] | None = field(default=None, init=False)
    """The foot that came down, and when, s, while the chain does not know that instant yet."""
    measured: float | None = field(default=None, init=False)
    """The instant that the chain's heights are of, s."""
    touchdowns: int = field(default=0, init=False)
    borne: float = field(default=0.0, init=False)
    """Mean of what both feet bear, unit of the samples."""
    borne_count: int = field(default=0, init=False)
    limited: bool = field(default=False, init=False)
    headed: bool = field(init=False)
    """The first heading is settled."""

    def __attrs_post_init__(self) -> None:
        self.chain = LowerLimbs(self.limbs, self.heading)
        self.headed = self.heading is not None
        self.sides = {}
        for foot, sign in ((Foot.LEFT, 0.5), (Foot.RIGHT, -0.5)):
            place = (0.0, sign * self._apart(), 0.0)
            self.sides[foot] = Side(place, place, (self.limbs.foot, 0.0))

    def _apart(self) -> float:
        """Between the feet at the start, m: the hips' width, as the chain has it in the N-pose. If feet that walk on
        are known to come down nearer to each other than the chain has them, they stood so as well."""
        apart = self.limbs.hip_width
        if self.compensation is None:
            return apart
        left, right = (self.compensation.get(foot, {}).get(WalkingMode.STRAIGHT, (0.0, 0.0))[1] for foot in Foot)
        return apart + 0.5 * (left - right)

    def calibrated(self, calibration: Calibration) -> Modes:
        """The same with the wearer's limbs, weight and compensation; what methods I to III do without stays out."""
        compensation = self.compensation
        if compensation is not None and calibration.modes:
            compensation = {foot: {**compensation.get(foot, {}), **calibration.modes.get(foot, {})} for foot in Foot}
        return evolve(
            self,
            limbs=calibration.limbs or self.limbs,
            weight=calibration.weight or self.weight,
            compensation=compensation,
        )

    @property
    def sites(self) -> tuple[Site, ...]:
        """Pelvis, thighs and shanks."""
        return ABOVE

    # --- samples ---

    def limb_moved(self, sample: Sample) -> list[Event]:
        """A sample of pelvis, thigh or shank: its attitude, or acceleration and angular velocity."""
        site, t = sample.site, sample.t
        newest = self.limb_times.get(site)
        wrong = refusal(sample, newest)
        if wrong is not None:
            return [rejected(sample, wrong, newest)]
        self.limb_times[site] = t
        if sample.quat is not None:
            self.chain.told(site, t, sample.quat)
        elif sample.acc is not None and sample.gyro is not None:
            leaning = self.leaning.get(site)
            if leaning is None:
                leaning = self.leaning[site] = Inclination()
            attitude = leaning.update(t, sample.acc, sample.gyro)
            if attitude is not None:
                self.chain.told_own(site, t, attitude, leaning.heading)
        return self._awaited(t, t if sample.known_at is None else max(t, sample.known_at))

    def interrupt(self, site: Site) -> None:
        """The clock of a site above the ankle begins anew."""
        self.limb_times.pop(site, None)

    def foot_moved(self, foot: FootTracker, sample: Sample, events: list[Event]) -> list[Event]:
        """A sample of a foot: who carries, what has come down, and what the contact that ended tells."""
        side, t = self.sides[foot.foot], sample.t
        known_at = t if sample.known_at is None else max(t, sample.known_at)
        side.t = t
        state, site = side.state, SITE_OF_FOOT[foot.foot]
        if foot.levelled:
            side.track = foot.position
            if sample.quat is not None:
                self.chain.told(site, t, sample.quat)
            elif sample.acc is not None:
                north = foot.gait.world.north
                heading = None if north is None else atan2(-north[1], north[0])
                self.chain.told_own(site, t, foot.corrector.attitude, heading)
            if sample.acc is not None:
                x, y, z = rotate(foot.corrector.attitude, sample.acc)
                state.acceleration = hypot(x, y, z - GRAVITY)
        told = self._pressed(foot, side, t, known_at) if sample.pressure else []
        return told + self._carry(t, known_at)

    def _carry(self, t: float, known_at: float) -> list[Event]:
        left, right = self.sides[Foot.LEFT], self.sides[Foot.RIGHT]
        if left.t is None or right.t is None:
            return []
        events = self._awaited(t, known_at)
        seen = t
        if isinstance(self.touchdown, Height):
            seen = self._heights(t)
        taken = self.carrier.update(self.touchdown.update(t, left.state, right.state))
        if taken is None or not taken[1]:
            return events  # a foot that has been down all the time carries from where it is
        if self.coming is not None:
            events += self._came_down(*self.coming, known_at)
        self.coming = (taken[0], seen)
        return events + self._awaited(t, known_at)

    def _heights(self, t: float) -> float:
        """Take the heights of both feet, by the chain at the latest instant that it knows. Returns that instant, s."""
        complete = self.chain.complete() if self.chain.current(t) else None
        if complete is not None and complete == self.measured:
            return min(t, complete)
        self.measured = complete
        for foot, side in self.sides.items():
            side.state.height = side.track[2] if complete is None else self.chain.height(foot, complete)
        return t if complete is None else min(t, complete)

    def _awaited(self, t: float, known_at: float) -> list[Event]:
        """A touchdown is worked out once every attitude of that instant is there, or has not come for `PATIENCE`."""
        if self.coming is None:
            return []
        foot, came = self.coming
        if self.chain.current(came) and t - came < PATIENCE:
            complete = self.chain.complete()
            if complete is not None and complete < came - TIE:
                return []
        self.coming = None
        return self._came_down(foot, came, known_at)

    # --- modes ---

    def _pressed(self, foot: FootTracker, side: Side, t: float, known_at: float) -> list[Event]:
        insole = foot.insole
        cells = insole.cells
        if not cells:
            return []
        state, contact = side.state, side.contact
        state.pressure = max(cells)
        newtons = insole.newtons is not None or (insole.layout is not None and insole.layout.scale is not None)
        state.full = None if newtons else insole.highest
        contact.wear(insole.layout)
        total = sum(cells)
        pressed = self.pressing.one(state, side.pressed)
        other = self.sides[OTHER[foot.foot]]
        both = total + other.contact.newest
        contact.newest = total
        if other.t is not None:
            self.borne_count = min(self.borne_count + 1, 2000)
            self.borne += (both - self.borne) / self.borne_count
        mode: WalkingMode | None = None
        if pressed:
            if not side.pressed:
                contact.begin(t)
            contact.add(cells, total)
            if contact.lasted(t) > LINGERS and not contact.lingers:
                contact.lingers = True
                mode = self._standing(both)
        elif side.pressed:
            contact.ended = t
            mode = self._told(foot.foot, side, both)
        side.pressed = pressed
        if mode is None or mode is side.mode:
            return []
        side.mode = mode
        return [WalkingModeChanged(t=t, known_at=known_at, mode=mode, foot=foot.foot)]

    def _standing(self, both: float) -> WalkingMode | None:
        """Standing still by table 2: no step, and the weight is on the feet."""
        weight = self.borne if self.weight is None or self.sides[Foot.LEFT].state.full is not None else self.weight
        return WalkingMode.STANDING if both > STANDING_WEIGHT * weight else None

    def _told(self, foot: Foot, side: Side, both: float) -> WalkingMode | None:
        """What a contact tells that has ended."""
        contact = side.contact
        shares = contact.shares()
        if shares is None or contact.lingers:
            return None
        contact.forward = shares["F1"] - shares["F2"]
        return self._standing(both) if side.step < LEAST_STEP else self._shown(foot, side)

    def _shown(self, foot: Foot, side: Side) -> WalkingMode | None:
        """What the contact of a foot has shown so far, by table 2."""
        contact = side.contact
        shares = contact.shares()
        if shares is None:
            return None
        forward = shares["F1"] - shares["F2"] + self.sides[OTHER[foot]].contact.forward
        return decide(foot, side.step, at_pace(shares, contact.speed(side.step)), forward, self.th)

    # --- places ---

    def _ends(self, t: float) -> tuple[Vec3, Vec3, bool]:
        """P_L and P_R in one frame, m, and whether they are the chain's."""
        if self.chain.current(t):
            return self.chain.end(Foot.LEFT, t), self.chain.end(Foot.RIGHT, t), True
        left, right = self.sides[Foot.LEFT], self.sides[Foot.RIGHT]
        return suspended(left.track, left.offset), suspended(right.track, right.offset), False

    def _place(self, foot: Foot, t: float) -> tuple[Vec3, bool]:
        """Where `foot` is, seen from the other, by (1) to (3): the ground below it; and whether the chain tells it."""
        left, right, chained = self._ends(t)
        carrying = self.sides[OTHER[foot]]
        x, y, _ = suspended(carrying.place, v_change(left, right, OTHER[foot]))
        if chained:
            reach = self._reach(foot, t)
            x += carrying.reach[0] - reach[0]
            y += carrying.reach[1] - reach[1]
        return (x, y, self.sides[foot].track[2]), chained

    def _reach(self, foot: Foot, t: float) -> tuple[float, float]:
        x, y = self.chain.forward(foot, t)
        return self.limbs.foot * x, self.limbs.foot * y

    def _came_down(self, foot: Foot, t: float, known_at: float) -> list[Event]:
        side = self.sides[foot]
        if self.chain.current(t):
            self.chain.stepped(self._swung(foot), t)
        place, chained = self._place(foot, t)
        dx, dy = place[0] - side.place[0], place[1] - side.place[1]
        side.step = step = hypot(dx, dy)
        if step < AWAY:
            return []
        compensation, mode = ZERO, self._walks(foot)
        if step > LEAST_STEP:
            side.direction = self._facing(t) if chained else (dx / step, dy / step)
            if not self.chain.aligned:
                self.chain.given_up = True
            if self.compensation is not None:
                compensation = self._turned(side.direction, self.compensation.get(foot, {}).get(mode, (0.0, 0.0)))
        side.place = suspended(place, compensation)
        if chained:
            side.reach = self._reach(foot, t)
            self._head()
        side.offset = sub(side.place, side.track)
        self.touchdowns += 1
        came = TouchedDown(
            t=t,
            known_at=known_at,
            final=self.headed or not chained,
            foot=foot,
            position=side.place,
            mode=mode,
            compensation=compensation,
        )
        return [*self._limited(chained, t, known_at), came]

    def _swung(self, foot: Foot) -> Foot:
        """The foot whose own track has gone further: a method may take the wrong one for the one that came down."""
        other = OTHER[foot]
        (x, y, _), (u, v, _) = self.sides[foot].track, self.sides[other].track
        return other if hypot(u, v) > hypot(x, y) + LEAST_STEP else foot

    def _head(self) -> None:
        """x along the first heading: until the wearer has gone `FIRST_WAY`, the world is turned so that the way so far
        lies along it. One footfall is half a foot's width to the left or right of where it might have been."""
        if self.headed or self.chain.facing is None:
            return
        left, right = self.sides.values()
        x, y = left.place[0] + right.place[0], left.place[1] + right.place[1]
        if hypot(x, y) < LEAST_STEP:
            return
        turn = atan2(y, x)
        self.chain.turn = (self.chain.turn + turn + pi) % (2.0 * pi) - pi
        c, s = cos(turn), -sin(turn)
        for side in self.sides.values():
            (px, py, pz), (rx, ry), (dx, dy) = side.place, side.reach, side.direction
            side.place = (c * px - s * py, s * px + c * py, pz)
            side.reach = (c * rx - s * ry, s * rx + c * ry)
            side.direction = (c * dx - s * dy, s * dx + c * dy)
        self.headed = hypot(x, y) > 2.0 * FIRST_WAY

    def _facing(self, t: float) -> tuple[float, float]:
        """Where both feet point together, world, of length 1."""
        (lx, ly), (rx, ry) = self.chain.forward(Foot.LEFT, t), self.chain.forward(Foot.RIGHT, t)
        x, y = lx + rx, ly + ry
        length = hypot(x, y)
        return (x / length, y / length) if length > LEAST_STEP else (lx, ly)

    def _walks(self, foot: Foot) -> WalkingMode:
        """The mode of the step that ends as `foot` comes down."""
        other = OTHER[foot]
        carrying = self.sides[other]
        mode = self._shown(other, carrying) if carrying.pressed and not carrying.contact.lingers else None
        if mode is None:
            mode = carrying.mode
        return WalkingMode.STRAIGHT if mode is None or mode is WalkingMode.STANDING else mode

    @staticmethod
    def _turned(direction: tuple[float, float], along: tuple[float, float]) -> Vec3:
        """(forward, left) of a direction, as a vector of the world."""
        (c, s), (forward, left) = direction, along
        return (forward * c - left * s, forward * s + left * c, 0.0)

    def _limited(self, chained: bool, t: float, known_at: float) -> list[Event]:
        if chained or self.limited:
            return []
        self.limited = True
        missing = self.chain.missing()
        if missing:
            why = f"no sensor heard at the {', '.join([site.words for site in missing])}"
        elif not self.chain.aligned:
            why = "the wearer did not stand still before the first step"
        else:
            why = "the sensors above the ankles do not know yet which way the wearer goes"
        what = f"{why}: the feet are where their own inertial tracks have them"
        return [Limitation(t=t, known_at=known_at, site=None, what=what)]

    def position(self, feet: Mapping[Foot, FootTracker]) -> Position | None:
        """The mean of both feet: where the carrying one came down, and where the other is now."""
        known = [tracker for tracker in feet.values() if tracker.t is not None]
        if not known:
            return None
        t = max([tracker.t for tracker in known if tracker.t is not None])
        carrying = self.carrier.foot
        places = []
        for foot, side in self.sides.items():
            moving = carrying is not None and foot is not carrying
            places.append(self._place(foot, t)[0] if moving else side.place)
        x, y, z = (0.5 * (places[0][axis] + places[1][axis]) for axis in range(3))
        return Position(t, (x, y, z), self._covariance(x, y, known))

    def _covariance(self, x: float, y: float, known: list[FootTracker]) -> Covariance3:
        """Touchdowns that err each for itself and all alike, and a first heading that errs; z is the tracks'."""
        each = self.step_sigma**2 * (1 + self.touchdowns)
        scale, turn = self.scale_sigma**2, self.heading_sigma**2
        xx, yy = each + scale * x * x + turn * y * y, each + scale * y * y + turn * x * x
        xy = (scale - turn) * x * y
        zz = sum([foot.covariance[5] for foot in known]) / len(known) ** 2
        if not self.chain.aligned:
            own = [foot.covariance for foot in known]
            k = 1.0 / len(known) ** 2
            xx, xy, yy = (value + k * sum([c[i] for c in own]) for i, value in ((0, xx), (1, xy), (3, yy)))
        return (xx, xy, 0.0, yy, 0.0, zz)
