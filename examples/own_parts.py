"""For the author of a method: a corrector and cues of your own, and recipes that differ in one part.

    python examples/own_parts.py

You see that both keep the contract of a part (docs/architecture.md), and which strides of the same emulated walk each
recipe finds. Only recordings with a reference show how good a recipe is.
"""

from attrs import define, evolve, field

from solepath import Foot, Phase, Session, StrideTaken, recipes
from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import TrackPart
from solepath.emulate import Route, Walker, emulate
from solepath.foot.cues.cues import Cues, TimedCue
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.phase import Cue
from solepath.foot.settings import CycleSettings
from solepath.foot.stance.cycle import Cycle
from solepath.foot.stance.stance import Stance
from solepath.testing.promises import violations


@define
class Resets(LinearDedrift):
    """A corrector: resets the velocity in stance and leaves the drift of the position."""

    resets: int = field(default=0, init=False)  # state: 0 again when the clock restarts

    def correct(self, t: float, stance: Stance) -> bool:
        position = self.position
        is_used = LinearDedrift.correct(self, t, stance)
        if is_used:
            self.position = position
            self.resets += 1
        return is_used


@define
class ByMotion(Cues):
    """Cues: a still foot is flat, a moving foot is lifted, and a fast foot is in the air."""

    fast: float = 1.0
    """Speed above which the foot is in the air, m/s."""

    def update(self, t, dt, acc, gyro, still, speed, phase, load, stance):
        if still:
            return () if phase is Phase.STATIONARY else (TimedCue(Cue.CONTACT, t), TimedCue(Cue.FLAT, t))
        if phase is Phase.STATIONARY:
            return (TimedCue(Cue.LIFT, t),)
        return (TimedCue(Cue.CLEAR, t),) if speed > self.fast else ()

    def alone(self, t, dt, load, phase):  # an insole without an inertial sensor
        return (TimedCue(Cue.CLEAR if load.airborne else Cue.CONTACT, t),)


DEFAULT = recipes.DEFAULT
MINE = [
    DEFAULT,
    evolve(DEFAULT, name="resets", corrector=Resets()),
    evolve(DEFAULT, name="by motion", cues=ByMotion()),
    evolve(DEFAULT, name="no rolling foot", detector=Cycle(CycleSettings(rolls=False))),
    DEFAULT.replace_part(TrackPart, MeanOfFeet(), name="mean of both feet"),
]
route = Route().stand(2).walk(6).stop(2)
samples = list(Walker(route).samples(Foot.LEFT, 100.0))
walk = emulate(route, seed=1)
print("broken promises:", violations(Resets(), samples) + violations(ByMotion(), samples))
for recipe in MINE:
    session = Session(recipe)
    strides = [one for one in session.feed(walk.packets) + session.finish() if isinstance(one, StrideTaken)]
    print(f"{recipe.name:17}  {len(strides)} strides, {max(stride.position[0] for stride in strides):.2f} m")
