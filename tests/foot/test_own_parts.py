"""A corrector and cues of an app's own: in a recipe, in a snapshot, and held against what a session needs of them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from math import inf, nan
from typing import Any

import pytest
from attrs import define, evolve, field
from walks import of, samples

from solepath import Foot, HeelStrike, Phase, Session, SnapshotError, StrideTaken, recipes
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.insoles import layout
from solepath.foot.cues.cues import Cues, Seen
from solepath.foot.navigate.corrector import Corrector
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.phase import Cue
from solepath.foot.stance.stance import Load, Stance
from solepath.recipes import NAMES, by_name
from solepath.testing.promises import broken
from solepath.types import Layout, Vec3

CELLS = layout(24, Foot.LEFT)
WALKED = tuple(Walker(Route().stand(2).walk(8).stop(2)).samples(Foot.LEFT, 100.0, layout=CELLS))


@define
class Resets(LinearDedrift):
    """The velocity is reset in stance, and the position keeps its drift."""

    resets: int = field(default=0, init=False)

    def correct(self, t: float, stance: Stance) -> bool:
        where = self.position
        if not LinearDedrift.correct(self, t, stance):
            return False
        self.position = where
        self.resets += 1
        return True


@define
class ByMotion(Cues):
    """A foot that is still has landed flat, one that is not is lifted, and one that is fast has left the ground."""

    fast: float = 1.0
    for_foot: str = ""
    cells: int = field(default=0, init=False)
    stood: float | None = field(default=None, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[Seen]:  # fmt: skip
        if still:
            self.stood = t
            return (Seen(Cue.CONTACT, t), Seen(Cue.FLAT, t)) if phase is not Phase.STATIONARY else ()
        if phase is Phase.STATIONARY:
            return (Seen(Cue.LIFT, t),)
        return (Seen(Cue.CLEAR, t),) if speed > self.fast and phase is not Phase.SWING else ()

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[Seen]:
        return (Seen(Cue.CLEAR if load.airborne else Cue.CONTACT, t),)

    def wear(self, layout: Layout) -> None:
        self.cells = len(layout.cells)

    def calibrated(self, foot: Foot, calibration: Calibration) -> ByMotion:
        return evolve(self, for_foot=foot.value)


OWN = evolve(recipes.DEFAULT, name="mine", corrector=Resets(), cues=ByMotion())


def test_a_walk_with_a_corrector_and_cues_of_ones_own_is_saved_and_goes_on_when_their_classes_are_named() -> None:
    walked = samples(cells=0)
    whole, half = Session(OWN), len(walked) // 2
    events = [whole.feed(sample) for sample in walked]
    said = sum(events, [])
    assert len(of(StrideTaken, said)) >= 6 and len(of(HeelStrike, said)) >= 6
    assert all(foot.corrector.resets > 100 for foot in whole.feet.values())
    assert {foot.cues.for_foot for foot in whole.feet.values()} == {"left", "right"}
    first = Session(OWN)
    first.feed(walked[:half])
    saved = json.loads(json.dumps(first.snapshot()))
    for parts, missing in (([Resets], "ByMotion"), ([ByMotion], "Resets")):
        with pytest.raises(SnapshotError, match=f"'{missing}'"):
            Session.restore(saved, parts=parts)
    for second in (Session.restore(saved, parts=[Resets, ByMotion]), Session.unpack(first.pack(), OWN)):
        assert [second.feed(sample) for sample in walked[half:]] == events[half:]
        assert second.recipe == OWN


def test_cues_of_ones_own_are_told_where_the_cells_are_and_speak_for_an_insole_alone() -> None:
    session = Session(OWN, calibration=Calibration(insoles={Foot.LEFT: InsoleCalibration(CELLS)}))
    events = session.feed([evolve(sample, acc=None, gyro=None) for sample in WALKED])
    assert session.feet[Foot.LEFT].cues.cells == 24
    assert len(of(HeelStrike, events)) >= 3


# --- promises ---------------------------------------------------------------------------------------------------------

PARTS: dict[str, Any] = {
    **{type(part).__name__: part for recipe in map(by_name, NAMES) for part in (recipe.corrector, recipe.cues)},
    "Resets": Resets(),
    "ByMotion": ByMotion(),
}


@pytest.mark.parametrize("name", PARTS)
def test_correctors_and_cues_that_recipes_have_keep_their_promises(name: str) -> None:
    assert broken(PARTS[name], WALKED, CELLS) == []


@define
class Drifting(Resets):
    """Its position is no number after a while."""

    def correct(self, t: float, stance: Stance) -> bool:
        if t > 6.0:
            self.position = (nan, 0.0, 0.0)
        return Resets.correct(self, t, stance)


@define
class Flat(Resets):
    def correct(self, t: float, stance: Stance) -> bool:
        believed = Resets.correct(self, t, stance)
        if t > 1e5:
            self.position = (0.0, 0.0, inf)
        return believed


@define
class Growing(Resets):
    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        Resets.predict(self, dt, acc, gyro, saturated)
        w, x, y, z = self.attitude
        self.attitude = (1.001 * w, 1.001 * x, 1.001 * y, 1.001 * z)


@define
class Certain(Resets):
    def covariance(self) -> tuple[float, ...]:
        return (-1.0, *Resets.covariance(self)[1:])


@define
class Hoarding(Resets):
    seen: list[float] = field(factory=list, init=False)

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        self.seen.append(dt)
        Resets.predict(self, dt, acc, gyro, saturated)


@define(slots=False)
class Leaving(Resets):
    """It remembers in no field how many samples there were."""

    def correct(self, t: float, stance: Stance) -> bool:
        self.__dict__["times"] = self.__dict__.get("times", 0) + 1
        self.lasted = 0.001 * self.__dict__["times"]
        return Resets.correct(self, t, stance)


@define
class Foretelling(ByMotion):
    def update(self, t: float, *rest: Any) -> Sequence[Seen]:
        return [Seen(one.cue, t + 1.0) for one in ByMotion.update(self, t, *rest)]


@define
class Listing(ByMotion):
    seen: list[float] = field(factory=list, init=False)

    def update(self, t: float, *rest: Any) -> Sequence[Seen]:
        self.seen.append(t)
        return ByMotion.update(self, t, *rest)


@define
class Turning(ByMotion):
    @property
    def sagittal(self) -> float:
        return nan


@pytest.mark.parametrize(
    ("part", "what"),
    [
        (Drifting(), "cannot hold Drifting.position: nan"),
        (Flat(), "position is three finite numbers"),
        (Growing(), "attitude is a unit quaternion"),
        (Certain(), "a covariance is seven finite numbers"),
        (Hoarding(), "more and more"),
        (Leaving(), "in no field"),
        (Foretelling(), "a cue is of the past"),
        (Listing(), "more and more"),
        (Turning(), "sagittal is finite"),
    ],
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)
def test_a_broken_promise_is_named(part: Any, what: str) -> None:
    assert any([what in sentence for sentence in broken(part, WALKED)])


def test_a_class_that_extends_nothing_is_no_part() -> None:
    @define
    class Bare:
        limit: float = 1.0

    with pytest.raises(TypeError, match="Bare extends neither Detector nor Corrector nor Cues"):
        broken(Bare(), WALKED)  # type: ignore[arg-type]


def test_a_corrector_need_not_be_one_of_ours() -> None:
    assert Corrector in Resets.__mro__ and not issubclass(ByMotion, LinearDedrift)
