"""An app's own detector, corrector and cues in a recipe and in a snapshot."""

from __future__ import annotations

import json
from array import array
from collections import deque
from math import inf
from typing import Any, ClassVar

import pytest
from attrs import define, evolve, field
from own import CELLS, WALKED, ByMotion, Resets, StillDetector
from walks import of, samples

from solepath import Foot, HeelStrike, Session, SnapshotError, StrideTaken, recipes
from solepath.calibration import Calibration, InsoleCalibration
from solepath.foot.stance.stance import Load, Stance
from solepath.saving.codec import load, save
from solepath.testing.promises import violations
from solepath.types import Quat, Vec3
from solepath.types.attrs import ROW_SIZE
from solepath.types.doubles import Doubles, doubles
from solepath.types.vector import IDENTITY

OWN_RECIPE = evolve(recipes.DEFAULT, name="mine", detector=StillDetector(), corrector=Resets(), cues=ByMotion())
PARTS = [StillDetector, Resets, ByMotion]


def test_a_walk_with_parts_of_ones_own_is_saved_and_goes_on_when_their_classes_are_named() -> None:
    walk_samples = samples(cells=0)
    uninterrupted, half = Session(OWN_RECIPE), len(walk_samples) // 2
    events = [uninterrupted.feed(sample) for sample in walk_samples]
    all_events = sum(events, [])
    assert len(of(StrideTaken, all_events)) >= 6 and len(of(HeelStrike, all_events)) >= 6
    assert all(foot.corrector.resets > 100 for foot in uninterrupted.feet.values())
    assert {foot.cues.for_foot for foot in uninterrupted.feet.values()} == {"left", "right"}
    first = Session(OWN_RECIPE)
    first.feed(walk_samples[:half])
    saved = json.loads(json.dumps(first.snapshot()))
    for missing in PARTS:
        with pytest.raises(SnapshotError, match=f"'{missing.__name__}'"):
            Session.restore(saved, parts=[part for part in PARTS if part is not missing])
    last_events = uninterrupted.finish()
    for second in (Session.restore(saved, parts=PARTS), Session.unpack(first.pack(), OWN_RECIPE)):
        assert [second.feed(sample) for sample in walk_samples[half:]] == events[half:]
        assert second.finish() == last_events and second.recipe == OWN_RECIPE
        assert json.dumps(second.snapshot()) == json.dumps(uninterrupted.snapshot())


def test_a_clock_reset_leaves_the_settings_of_an_own_detector_alone() -> None:
    session = Session(evolve(OWN_RECIPE, detector=StillDetector(limit=0.7)))
    session.feed(WALKED[:50])
    tracker = session.feet[Foot.LEFT]
    assert tracker.detector != evolve(OWN_RECIPE.detector, limit=0.7)
    tracker.reset()
    assert tracker.detector == evolve(OWN_RECIPE.detector, limit=0.7)


def test_own_cues_get_the_layout_and_work_for_an_insole_alone() -> None:
    session = Session(OWN_RECIPE, calibration=Calibration(insoles={Foot.LEFT: InsoleCalibration(CELLS)}))
    events = session.feed([evolve(sample, acc=None, gyro=None) for sample in WALKED])
    assert session.feet[Foot.LEFT].cues.cells == 24
    assert len(of(HeelStrike, events)) >= 3


@define
class SeesCentres(StillDetector):
    """Beside the centres of pressure that it was given."""

    uses_centre: ClassVar[bool] = True

    centres: int = field(default=0, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        self.centres += load is not None and load.centre is not None
        return StillDetector.update(self, t, dt, acc, gyro, load, attitude)


@define
class SeesNone(SeesCentres):
    """The same without the centres."""

    uses_centre: ClassVar[bool] = False


def test_a_detector_gets_the_centre_of_pressure_on_request_and_strides_have_the_same_without() -> None:
    calibration, found = Calibration(insoles={Foot.LEFT: InsoleCalibration(CELLS)}), []
    for detector in (SeesCentres(), SeesNone()):
        session = Session(evolve(OWN_RECIPE, detector=detector), calibration=calibration)
        found.append([stride.features.cop for stride in of(StrideTaken, session.feed(WALKED))])
        assert (session.feet[Foot.LEFT].detector.centres > 100) is detector.uses_centre
    assert found[0] == found[1] and any(found[0])


def test_classes_that_are_no_parts_or_share_a_name_are_rejected() -> None:
    saved = Session(OWN_RECIPE).snapshot()
    other = define(type("StillDetector", (), {"__annotations__": {}}))
    with pytest.raises(TypeError, match="attrs class"):
        Session.restore(saved, parts=[int])
    with pytest.raises(ValueError, match="one name"):
        Session.restore(saved, parts=[StillDetector, other])
    with pytest.raises(SnapshotError):
        Session.restore(saved, parts=[other])


@define
class RecentRates(StillDetector):
    """Beside what was usual lately, by windows that forget by themselves."""

    rates: deque[float] = field(factory=lambda: deque(maxlen=8), init=False)
    by_kind: dict[str, deque[float]] = field(factory=dict, init=False)

    def update(self, t: float, dt: float, acc: Vec3, gyro: Vec3, *rest: Any) -> Stance:
        rate = sum([w * w for w in gyro]) ** 0.5
        self.rates.append(rate)
        self.by_kind.setdefault("all", deque(maxlen=5)).append(rate)
        usual = sum(self.rates) / len(self.rates) + sum(self.by_kind["all"])
        return StillDetector.update(self, t, dt, acc, gyro, *rest)._replace(statistic=usual)


def test_a_bounded_window_stays_bounded_after_it_was_saved() -> None:
    assert violations(RecentRates(), WALKED) == []
    one = RecentRates()
    for sample in WALKED[:20]:
        assert sample.acc is not None and sample.gyro is not None
        one.update(sample.t, 0.01, sample.acc, sample.gyro, None)
    saved: Any = json.loads(json.dumps(save(one)))
    loaded = load(RecentRates, saved)
    assert loaded == one and loaded.rates.maxlen == 8 and loaded.by_kind["all"].maxlen == 5
    assert save(loaded) == saved
    for most, items in ((8, None), (2, [1.0, 2.0, 3.0]), (-1, []), (True, [1.0]), ("8", [])):
        with pytest.raises(SnapshotError):
            load(RecentRates, saved | {"rates": {"maxlen": most, "is": items}})


@define
class Sums:
    by_cell: Doubles = field(factory=doubles)
    extremes: Doubles = field(factory=doubles, metadata={ROW_SIZE: 2})


@define
class Counts:
    counts: array  # type: ignore[type-arg]


@define
class Rows:
    rows: list[float] = field(factory=list, metadata={ROW_SIZE: 2})


def test_doubles_come_back_as_they_were_and_other_arrays_are_refused_before_their_values_change() -> None:
    one = Sums(doubles([1, 2.5]), doubles([0.1, 7e300]))
    loaded = load(Sums, json.loads(json.dumps(save(one))))
    assert loaded == one and loaded.by_cell.typecode == "d"
    with pytest.raises(TypeError, match=r"Counts\.counts: <class 'array.array'> is no .*Doubles"):
        save(Counts(array("q", [2**62 + 1])))
    with pytest.raises(TypeError, match="is no Doubles"):
        save(Sums(Doubles(array("q", [2**62 + 1]))))
    with pytest.raises(TypeError, match=r"Rows\.rows: only bytes and Doubles have a row size"):
        save(Rows())


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
    with pytest.raises(TypeError, match=r"cannot hold Holder\.held: a StillDetector where Window or Level is known"):
        save(Holder(StillDetector()))  # type: ignore[arg-type]


def test_saving_a_part_that_cannot_be_saved_raises() -> None:
    class Bare:
        update = StillDetector.update

    Same = define(type("ShoeDetector", (), {"__annotations__": {}, "update": StillDetector.update}))
    for detector, message in ((Bare(), "no attrs class"), (Same(), "give it another name")):
        session = Session(evolve(recipes.DEFAULT, detector=detector))
        session._state._add_tracker(session._state._tracker(Foot.LEFT))
        for save_it in (session.snapshot, session.pack):
            with pytest.raises(TypeError, match=message):
                save_it()
