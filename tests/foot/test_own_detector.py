"""A stance detector of an app's own: in a recipe, in a snapshot, and held against what a session needs of one."""

from __future__ import annotations

import json
from collections import Counter, deque
from itertools import count
from math import inf, nan
from typing import Any

import pytest
from attrs import define, evolve, field
from walks import of, samples

from solepath import Foot, Phase, Session, SnapshotError, StrideTaken, recipes
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.insoles import layout
from solepath.foot.stance.stance import Detector, Load, Stance
from solepath.recipes import NAMES, by_name
from solepath.saving.codec import load, save
from solepath.testing.promises import broken
from solepath.types import Quat, Vec3
from solepath.types.vector import IDENTITY, ZERO

WALKED = tuple(Walker(Route().stand(2).walk(8).stop(2)).samples(Foot.LEFT, 100.0, layout=layout(24, Foot.LEFT)))


@define
class Quiet(Detector):
    """A foot that turned slowly for a while."""

    limit: float = 0.8
    hold: float = 0.04
    since: float | None = field(default=None, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        x, y, z = gyro
        rate = (x * x + y * y + z * z) ** 0.5
        if rate > self.limit:
            self.since = None
            return Stance(ZERO, inf, rate, None)
        self.since = t if self.since is None else self.since
        sure = t - self.since >= self.hold
        return Stance(ZERO, 0.01 if sure else 0.1, rate, Phase.STATIONARY if sure else None)


OWN = evolve(recipes.DEFAULT, name="quiet", detector=Quiet())


def test_a_walk_with_a_detector_of_ones_own_is_saved_and_goes_on_when_its_class_is_named_again() -> None:
    walked = samples(cells=0)
    whole, half = Session(OWN), len(walked) // 2
    events = [whole.feed(sample) for sample in walked]
    assert len(of(StrideTaken, sum(events, []))) >= 6
    first = Session(OWN)
    first.feed(walked[:half])
    saved = json.loads(json.dumps(first.snapshot()))
    with pytest.raises(SnapshotError, match="'Quiet'"):
        Session.restore(saved)
    second = Session.restore(saved, parts=[Quiet])
    assert [second.feed(sample) for sample in walked[half:]] == events[half:]
    assert second.finish() == whole.finish() and second.recipe == OWN
    assert json.dumps(second.snapshot()) == json.dumps(whole.snapshot())


def test_a_clock_that_begins_anew_leaves_a_detector_of_ones_own_with_its_settings_alone() -> None:
    session = Session(evolve(OWN, detector=Quiet(limit=0.7)))
    session.feed(WALKED[:50])
    tracker = session.feet[Foot.LEFT]
    assert tracker.detector != evolve(OWN.detector, limit=0.7)
    tracker.interrupt()
    assert tracker.detector == evolve(OWN.detector, limit=0.7)


def test_classes_that_are_no_parts_or_share_a_name_are_refused() -> None:
    saved = Session(OWN).snapshot()
    other = define(type("Quiet", (), {"__annotations__": {}}))
    with pytest.raises(TypeError, match="attrs class"):
        Session.restore(saved, parts=[int])
    with pytest.raises(ValueError, match="one name"):
        Session.restore(saved, parts=[Quiet, other])
    with pytest.raises(SnapshotError):
        Session.restore(saved, parts=[other])


@define
class Usual(Quiet):
    """Beside what was usual lately, by windows that forget by themselves."""

    rates: deque[float] = field(factory=lambda: deque(maxlen=8), init=False)
    by_kind: dict[str, deque[float]] = field(factory=dict, init=False)

    def update(self, t: float, dt: float, acc: Vec3, gyro: Vec3, *rest: Any) -> Stance:
        rate = sum([w * w for w in gyro]) ** 0.5
        self.rates.append(rate)
        self.by_kind.setdefault("all", deque(maxlen=5)).append(rate)
        usual = sum(self.rates) / len(self.rates) + sum(self.by_kind["all"])
        return Quiet.update(self, t, dt, acc, gyro, *rest)._replace(statistic=usual)


def test_a_window_that_forgets_by_itself_still_does_after_it_was_saved() -> None:
    assert broken(Usual(), WALKED) == []
    one = Usual()
    for sample in WALKED[:20]:
        assert sample.acc is not None and sample.gyro is not None
        one.update(sample.t, 0.01, sample.acc, sample.gyro, None)
    saved: Any = json.loads(json.dumps(save(one)))
    again = load(Usual, saved)
    assert again == one and again.rates.maxlen == 8 and again.by_kind["all"].maxlen == 5
    assert save(again) == saved
    for most, items in ((8, None), (2, [1.0, 2.0, 3.0]), (-1, []), (True, [1.0]), ("8", [])):
        with pytest.raises(SnapshotError):
            load(Usual, saved | {"rates": {"maxlen": most, "is": items}})


@define
class Window:
    recent: deque = field(factory=deque)  # type: ignore[type-arg]


@define
class Level:
    highest: float = inf


@define
class Holder:
    held: Window | Level | None


def test_what_a_snapshot_cannot_hold_is_named_with_its_class_and_field() -> None:
    with pytest.raises(TypeError, match=r"cannot hold Window\.recent: .* write deque\[float\]"):
        save(Holder(Window()))
    with pytest.raises(SnapshotError, match=r"cannot hold Level\.highest: inf"):
        save(Holder(Level()))
    with pytest.raises(TypeError, match=r"cannot hold Holder\.held: a Quiet where Window or Level is known"):
        save(Holder(Quiet()))  # type: ignore[arg-type]


def test_what_cannot_be_saved_says_so_when_it_is_to_be_saved() -> None:
    class Bare:
        update = Quiet.update

    Same = define(type("ShoeDetector", (), {"__annotations__": {}, "update": Quiet.update}))
    for detector, what in ((Bare(), "no attrs class"), (Same(), "give it another name")):
        session = Session(evolve(recipes.DEFAULT, detector=detector))
        session._state.wearer._keep(session._state.wearer._tracker(Foot.LEFT))
        for save_it in (session.snapshot, session.pack):
            with pytest.raises(TypeError, match=what):
                save_it()


# --- promises ---------------------------------------------------------------------------------------------------------

DETECTORS = {type(recipe.detector).__name__: recipe.detector for recipe in map(by_name, NAMES)}


@pytest.mark.parametrize("name", [*DETECTORS, "Quiet"])
def test_detectors_that_recipes_have_keep_their_promises(name: str) -> None:
    assert broken({**DETECTORS, "Quiet": Quiet()}[name], WALKED, layout(24, Foot.LEFT)) == []


@define
class Hoarder(Quiet):
    seen: list[float] = field(factory=list, init=False)

    def update(self, t: float, *rest: Any) -> Stance:
        self.seen.append(t)
        return Quiet.update(self, t, *rest)


@define
class Restless(Quiet):
    def update(self, t: float, *rest: Any) -> Stance:
        return Quiet.update(self, t, *rest)._replace(statistic=float(next(TURNS)))


TURNS = count()


@define(slots=False)
class Forgetful(Quiet):
    def update(self, t: float, *rest: Any) -> Stance:
        self.__dict__["calls"] = self.__dict__.get("calls", 0.0) + 1.0
        return Quiet.update(self, t, *rest)._replace(statistic=self.__dict__["calls"])


@define
class Sharing(Quiet):
    window: deque[float] = field(factory=deque, init=False)

    def __deepcopy__(self, memo: Any) -> Sharing:
        copy = Sharing(self.limit)
        copy.window, copy.since = self.window, self.since
        return copy

    def update(self, t: float, *rest: Any) -> Stance:
        self.window.append(t)
        while len(self.window) > 10:
            self.window.popleft()
        return Quiet.update(self, t, *rest)


@define
class Reckless(Quiet):
    def update(self, t: float, *rest: Any) -> Stance:
        return Stance((nan, 0.0, 0.0), 0.0, inf, True)  # type: ignore[arg-type]


@define
class Altered(Quiet):
    counts: dict[str, int] = field(factory=Counter, init=False)

    def update(self, t: float, *rest: Any) -> Stance:
        self.counts["still" if self.since else "moving"] += 1
        return Quiet.update(self, t, *rest)._replace(statistic=float("missing" in self.counts))


@define
class Learning(Quiet):
    def update(self, t: float, *rest: Any) -> Stance:
        self.limit = 0.9
        return Quiet.update(self, t, *rest)


@define
class Lost(Quiet):
    best: float = field(default=0.0, init=False)

    def update(self, t: float, *rest: Any) -> Stance:
        self.best = inf
        return Quiet.update(self, t, *rest)


@pytest.mark.parametrize(
    ("detector", "what"),
    [
        (Hoarder(), "more and more"),
        (Restless(), "twice"),
        (Forgetful(), "in no field"),
        (Sharing(), "share"),
        (Altered(), "its field counts comes back as a dict and was a Counter"),
        (Learning(), "its setting limit changes"),
        (Lost(), "cannot hold Lost.best: inf"),
        (Reckless(), "sigma is above 0"),
        (Reckless(), "v_ref"),
        (Reckless(), "statistic is finite"),
        (Reckless(), "hint is"),
    ],
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)
def test_a_broken_promise_is_named(detector: Any, what: str) -> None:
    assert any([what in sentence for sentence in broken(detector, WALKED)])


def test_a_detector_that_returns_something_else_or_has_unsavable_fields_is_named() -> None:
    class Odd(Quiet):
        def update(self, t: float, *rest: Any) -> Any:
            return True

    assert broken(Odd(), WALKED) == ["update returns a Stance, not a bool"]
    with pytest.raises(TypeError):
        broken(evolve(Odd(), limit=object()), WALKED)
