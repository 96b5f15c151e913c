"""From cues to phases and from phases to steps: what one foot is doing, and where it came down."""

from __future__ import annotations

from ..events import Event
from ..types import Foot, Phase, Vec3
from ..types.attrs import define, field
from ..types.vector import ZERO, from_yaw, heading_turned, multiply, sub
from .cues.cues import Cues, SeenCue
from .gaps.gap import Infill
from .gaps.template import StrideTemplate
from .navigate.corrector import Corrector
from .phase import BEGINS, PHASES, Cue
from .stride import SHORTEST_STRIDE, StepBuilder, StretchChain
from .world import Covariance3, World


@define
class Gait:
    """The phases of one foot and the steps that they make, each an event as soon as its cue is seen."""

    foot: Foot
    phase: Phase = field(default=Phase.STATIONARY, init=False)
    began: float | None = field(default=None, init=False)
    """When the phase did, s."""
    template: StrideTemplate = field(factory=StrideTemplate, init=False)
    step: StepBuilder = field(init=False)
    way: StretchChain = field(factory=StretchChain, init=False)
    """In the navigation frame, up to `anchored`."""
    anchored: Vec3 = field(default=ZERO, init=False)
    """Position of the last anchor, navigation frame, m."""
    world: World = field(factory=World, init=False)
    headed: bool = field(default=False, init=False)
    """The world's heading is settled."""

    def __attrs_post_init__(self) -> None:
        self.step = StepBuilder(self.foot)

    def covariance(self, corrector: Corrector) -> Covariance3:
        """Of the live position, world frame, m^2."""
        way = self.way.extended(sub(corrector.position, self.anchored), corrector.covariance())
        return self.world.covariance(way.position)

    def reset(self) -> None:
        """Times begin anew; what the foot did between is unknown."""
        self.began = None
        self.step.spoil(None)
        self.template.reset()

    def shift(self, yaw: float, by: Vec3) -> Vec3:
        """The foot, which is flat, is turned by `yaw` rad and moved `by` m, world frame; the same move in the
        navigation frame is returned, for the corrector."""
        x, y, z = by
        if self.world.north is not None:
            c, s = self.world.north  # the turn from the navigation frame to the world frame, undone
            x, y = c * x + s * y, c * y - s * x
        step = self.step
        px, py, pz = step.start
        step.start = (px + x, py + y, pz + z)
        step.attitude = multiply(from_yaw(yaw), step.attitude)
        px, py, pz = self.anchored
        self.anchored = (px + x, py + y, pz + z)
        return (x, y, z)

    def see(
        self, seen: SeenCue, known_at: float, corrector: Corrector | None, interval: float, inferred: bool = False
    ) -> list[Event]:
        """What follows from a cue. `corrector`: None as long as nobody knows which way is up; `interval`: the usual
        one between samples, s; `inferred`: nobody saw it."""
        phase = PHASES[self.phase][seen.cue]
        if phase is self.phase:
            return []
        self.phase = phase
        # cues look back by different spans; phases follow each other all the same
        t = seen.t if self.began is None else max(seen.t, self.began)
        self.began = t
        known_at = max(known_at, t)
        events: list[Event] = [BEGINS[phase](t=t, known_at=known_at, foot=self.foot, inferred=inferred)]
        if phase is Phase.SWING:
            self.step.left(t, interval)
        elif phase is Phase.LOADING:
            self.step.struck(t, interval)
        elif phase is Phase.PUSH_OFF and corrector is not None:
            self.template.lift(t)
            self._anchor(corrector)
        elif phase is Phase.STATIONARY and corrector is not None:
            events += self._flat(t, known_at, corrector, interval)
        return events

    def apply_infill(
        self, infill: Infill, cues: Cues, known_at: float, corrector: Corrector, interval: float
    ) -> list[Event]:
        """The phases that a gap has hidden."""
        self.template.guess(infill.lifted, infill.lasted)
        hidden: list[SeenCue] = []
        phase = self.phase
        if phase is Phase.STATIONARY:
            hidden.append(SeenCue(Cue.LIFT, infill.lifted))
            phase = Phase.PUSH_OFF
        if infill.cleared is not None and phase is not Phase.SWING and self.step.t_toe_off is None:
            hidden.append(cues.cleared(infill.cleared))
            phase = Phase.SWING
        if infill.struck is not None and phase is Phase.SWING:
            hidden.append(SeenCue(Cue.CONTACT, infill.struck))
        if infill.landed is not None:
            hidden.append(SeenCue(Cue.FLAT, infill.landed))
        return [event for seen in hidden for event in self.see(seen, known_at, corrector, interval, inferred=True)]

    def _flat(self, t: float, known_at: float, corrector: Corrector, interval: float) -> list[Event]:
        step, world = self.step, self.world
        turn = heading_turned(step.attitude, corrector.attitude)
        way = sub(corrector.position, step.start)
        repair = self.template.flat(t, step.t_toe_off, step.t_heel_strike, turn, way, interval)
        if repair is not None:
            (x, y, z), (dx, dy, dz) = step.start, repair.way
            corrector.repair(repair.turn, (x + dx, y + dy, z + dz))
        rise = corrector.position[2] - step.start[2]
        corrector.flat(step.start, turn)
        position, attitude = corrector.position, corrector.attitude
        if not self.headed and step.t_toe_off is not None:
            # the first step fixes the heading; until then it was the direction in which the foot set out
            self.headed = world.find(position, SHORTEST_STRIDE)
        taken = step.finish(
            t, known_at, position, attitude, corrector.covariance(), world, error_index=corrector.error_index, rise=rise
        )
        if taken is not None:
            # a final step is never seen from another frame again, even when it was too short to give a direction
            self.headed = True
            world.settle()
        step.begin(t, position, attitude)
        return [] if taken is None else [taken]

    def _anchor(self, corrector: Corrector) -> None:
        position = corrector.position
        stretch = corrector.anchor()
        self.way = self.way.extended(sub(position, self.anchored), stretch)
        self.anchored = position
