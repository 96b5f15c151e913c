"""The parts of recipes keep the rules of a part, and a part that breaks one is named."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from itertools import count
from math import inf, nan
from typing import Any, ClassVar

import pytest
from attrs import define, evolve, field
from own import CELLS, WALKED, ByMotion, Resets, StillDetector

from solepath import recipes
from solepath.body.part import LayoutReported, Notice, Part, PartInput, PartOutput
from solepath.emulate import Route, Walker
from solepath.events import StrideTaken, WearerMoved
from solepath.foot.cues.cues import TimedCue
from solepath.foot.stance.stance import Stance
from solepath.foot.view import FootView
from solepath.recipes import NAMES, by_name
from solepath.testing.promises import violations
from solepath.types import Foot, Vec3
from solepath.types.vector import ZERO

RECIPE_PARTS = [part for one in map(by_name, NAMES) for part in (one.detector, one.corrector, one.cues)]
PARTS: dict[str, Any] = {type(part).__name__: part for part in (*RECIPE_PARTS, StillDetector(), Resets(), ByMotion())}


@pytest.mark.parametrize("name", PARTS)
def test_the_parts_that_recipes_have_keep_their_promises(name: str) -> None:
    assert violations(PARTS[name], WALKED, CELLS) == []


@define
class Hoarder(StillDetector):
    seen: list[float] = field(factory=list, init=False)

    def update(self, t: float, *rest: Any) -> Stance:
        self.seen.append(t)
        return StillDetector.update(self, t, *rest)


@define
class Restless(StillDetector):
    def update(self, t: float, *rest: Any) -> Stance:
        return StillDetector.update(self, t, *rest)._replace(statistic=float(next(TURNS)))


TURNS = count()


@define(slots=False)
class Forgetful(StillDetector):
    def update(self, t: float, *rest: Any) -> Stance:
        self.__dict__["calls"] = self.__dict__.get("calls", 0.0) + 1.0
        return StillDetector.update(self, t, *rest)._replace(statistic=self.__dict__["calls"])


@define
class Sharing(StillDetector):
    window: deque[float] = field(factory=deque, init=False)

    def __deepcopy__(self, memo: Any) -> Sharing:
        copy = Sharing(self.limit)
        copy.window, copy.since = self.window, self.since
        return copy

    def update(self, t: float, *rest: Any) -> Stance:
        self.window.append(t)
        while len(self.window) > 10:
            self.window.popleft()
        return StillDetector.update(self, t, *rest)


@define
class Reckless(StillDetector):
    def update(self, t: float, *rest: Any) -> Stance:
        return Stance((nan, 0.0, 0.0), 0.0, inf, True)  # type: ignore[arg-type]


@define
class Altered(StillDetector):
    counts: dict[str, int] = field(factory=Counter, init=False)

    def update(self, t: float, *rest: Any) -> Stance:
        self.counts["still" if self.since else "moving"] += 1
        return StillDetector.update(self, t, *rest)._replace(statistic=float("missing" in self.counts))


@define
class Learning(StillDetector):
    def update(self, t: float, *rest: Any) -> Stance:
        self.limit = 0.9
        return StillDetector.update(self, t, *rest)


@define
class Lost(StillDetector):
    best: float = field(default=0.0, init=False)

    def update(self, t: float, *rest: Any) -> Stance:
        self.best = inf
        return StillDetector.update(self, t, *rest)


@define
class Drifting(Resets):
    """A corrector whose position becomes nan."""

    def correct(self, t: float, stance: Stance) -> bool:
        if t > 6.0:
            self.position = (nan, 0.0, 0.0)
        return Resets.correct(self, t, stance)


@define
class Flat(Resets):
    def correct(self, t: float, stance: Stance) -> bool:
        accepted = Resets.correct(self, t, stance)
        if t > 1e5:
            self.position = (0.0, 0.0, inf)
        return accepted


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
    """A corrector that counts samples outside its fields."""

    def correct(self, t: float, stance: Stance) -> bool:
        self.__dict__["times"] = self.__dict__.get("times", 0) + 1
        self.time_since_anchor = 0.001 * self.__dict__["times"]
        return Resets.correct(self, t, stance)


@define
class Foretelling(ByMotion):
    def update(self, t: float, *rest: Any) -> Sequence[TimedCue]:
        return [TimedCue(one.cue, t + 1.0) for one in ByMotion.update(self, t, *rest)]


@define
class Expecting(ByMotion):
    at: float | None = field(default=None, init=False)

    def update(self, t: float, *rest: Any) -> Sequence[TimedCue]:
        self.at = t + 0.02
        return ByMotion.update(self, t, *rest)

    @property
    def impact_at(self) -> float | None:
        return self.at


@define
class Listing(ByMotion):
    seen: list[float] = field(factory=list, init=False)

    def update(self, t: float, *rest: Any) -> Sequence[TimedCue]:
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
        (Hoarder(), "without bound"),
        (Restless(), "second run"),
        (Forgetful(), "not in a field"),
        (Sharing(), "share"),
        (Altered(), "its field counts comes back as a dict and was a Counter"),
        (Learning(), "its setting limit changes"),
        (Lost(), "cannot hold Lost.best: inf"),
        (Reckless(), "sigma is above 0"),
        (Reckless(), "v_ref"),
        (Reckless(), "statistic is finite"),
        (Reckless(), "hint is"),
        (Drifting(), "cannot hold Drifting.position: nan"),
        (Flat(), "position is three finite numbers"),
        (Growing(), "attitude is a unit quaternion"),
        (Certain(), "a covariance is seven finite numbers"),
        (Hoarding(), "without bound"),
        (Leaving(), "not in a field"),
        (Foretelling(), "a cue is of the past"),
        (Expecting(), "impact_at is of the past"),
        (Listing(), "without bound"),
        (Turning(), "sagittal is finite"),
    ],
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)
def test_a_broken_promise_is_named(part: Any, what: str) -> None:
    assert any([what in sentence for sentence in violations(part, WALKED)])


def test_a_detector_that_returns_something_else_or_has_unsavable_fields_is_named() -> None:
    class Odd(StillDetector):
        def update(self, t: float, *rest: Any) -> Any:
            return True

    assert violations(Odd(), WALKED) == ["update returns a Stance, not a bool"]
    with pytest.raises(TypeError):
        violations(evolve(Odd(), limit=object()), WALKED)


def test_a_class_that_extends_nothing_is_no_part() -> None:
    @define
    class Bare:
        limit: float = 1.0

    with pytest.raises(TypeError, match="Bare extends neither Detector nor Corrector nor Cues"):
        violations(Bare(), WALKED)  # type: ignore[arg-type]


@define
class Lasting(Part):
    """A part that counts its inputs in a setting, which a packed session loses."""

    count: int = 0
    newest: float | None = field(default=None, init=False)

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        self.count += len(events)
        return ()


@define
class Foreseeing(Part):
    needs_samples: ClassVar[bool] = True

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        return (
            [] if view is None else [WearerMoved(t=view.t + 1.0, known_at=view.t, position=ZERO, covariance=(0.0,) * 6)]
        )


@define
class Lingering(Part):
    """A part that returns an event at the end of the session, after it has received a layout."""

    notices: ClassVar[tuple[type[Notice], ...]] = (LayoutReported,)
    cells: int = field(default=0, init=False)

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        for event in events:
            if isinstance(event, LayoutReported):
                self.cells = len(event.layout.cells)
        return ()

    def finish(self, now: float) -> Sequence[PartOutput]:
        return [WearerMoved(t=now + self.cells, known_at=now, position=ZERO, covariance=(0.0,) * 6)]


@define
class Remembering(Part):
    """A part that remembers the lengths of the last strides, which are more than one short walk has."""

    lengths: tuple[float, ...] = field(default=(), init=False)

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        for event in events:
            if isinstance(event, StrideTaken):
                self.lengths = (*self.lengths, event.length)[-30:]
        return ()


def test_a_window_of_strides_that_a_short_walk_does_not_fill_is_bounded() -> None:
    assert violations(Remembering(), WALKED) == []


@pytest.mark.soak
def test_parts_of_the_body_keep_their_promises_and_those_that_do_not_are_named() -> None:
    longer = Walker(Route().stand(2).walk(60).stop(2)).samples(Foot.LEFT, 50.0, layout=CELLS)
    for part in recipes.DEFAULT.parts:  # what checks and activities remember fills in the first ten seconds
        assert violations(part, longer, CELLS) == []
    assert violations(Lasting(), WALKED) == ["its setting count changes: what does is state, a field with init=False"]
    assert violations(Lingering(), WALKED) == []
    for part, layout in ((Foreseeing(), None), (Lingering(), CELLS)):
        (sentence,) = violations(part, WALKED, layout)
        assert sentence.startswith("an event was when it was known or earlier")
