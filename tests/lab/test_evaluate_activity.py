"""Activity scores of labels and events worked out by hand, the folds, and the sources that each part learns from."""

from collections import Counter
from functools import partial

import pytest

from solepath import recipes
from solepath.events import ActivityChanged, LiftRidden
from solepath.types import Activity
from solepath.walk.timeline import Timeline
from solepath_lab.evaluate import learning
from solepath_lab.evaluate.activity import score_rides, score_samples, score_windows, stairs_figures
from solepath_lab.evaluate.jobs import evaluate
from solepath_lab.evaluate.learning import Learner, TrainingSource, train_parts
from solepath_lab.measures.confusion import ActivityScore
from solepath_lab.train.hugadb import FOLDS, fold_of

STANDING, WALKING, RUNNING = Activity.STANDING, Activity.WALKING, Activity.RUNNING
STAIRS_UP, UP, DOWN = Activity.STAIRS_UP, Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN


def timeline(*changes):
    """Return the timeline of changes (t, activity) or (t, activity, t of the change that it revises)."""
    found = Timeline()
    for t, activity, *revises in changes:
        found.add(
            ActivityChanged(
                t=t, known_at=t + 9.0, final=False, activity=activity, probability=None, revises=[*revises, None][0]
            )
        )
    return found


def ridden(t_start, end, up):
    return LiftRidden(t=end, known_at=end, t_start=t_start, up=up, height=None)


TIMES = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
TRUE = [STANDING, STANDING, STANDING, WALKING, WALKING, None, WALKING, RUNNING]


def test_labelled_samples_are_scored_by_the_activity_reported_at_their_time():
    # reported: nothing before 1.0, standing to 2.5, then walking
    score = score_samples(TIMES, TRUE, timeline((1.0, STANDING), (2.5, WALKING)))
    assert score.samples == {
        (STANDING, Activity.UNKNOWN): 1, (STANDING, STANDING): 2, (WALKING, WALKING): 3, (RUNNING, WALKING): 1,
    }  # fmt: skip
    assert score.accuracy == pytest.approx(5 / 7)
    assert score.most_frequent == pytest.approx(3 / 7)
    # standing: 2 right, 3 true, 2 reported; walking: 3 right, 3 true, 4 reported; running: none right, 1 true
    assert score.f1(STANDING) == pytest.approx(2 * 2 / (3 + 2))
    assert score.f1(WALKING) == pytest.approx(2 * 3 / (3 + 4))
    assert score.f1(RUNNING) == 0.0
    assert score.f1(UP) is None
    assert score.table == {
        "STANDING": {"STANDING": 2, "WALKING": 0, "UNKNOWN": 1},
        "WALKING": {"STANDING": 0, "WALKING": 3, "UNKNOWN": 0},
        "RUNNING": {"STANDING": 0, "WALKING": 1, "UNKNOWN": 0},
    }


def test_a_ride_is_found_by_one_in_its_direction_at_its_time():
    true = [(0.0, 5.0, STANDING), (5.0, 15.0, UP), (15.0, 20.0, STANDING), (20.0, 30.0, DOWN), (40.0, 50.0, UP)]
    # the first fits, the second goes the wrong way, the third comes too late by more than half of its own length
    score = score_rides(true, [ridden(7.0, 14.0, True), ridden(20.0, 30.0, True), ridden(47.0, 55.0, True)])
    assert (score.rides_true, score.rides_found, score.rides_invented) == (3, 1, 2)


def test_windows_of_two_seconds_lie_within_one_activity():
    # 0-5 s: windows 0-2, 2-4; 5-9.9 s: 5-7, 7-9; their middles are 1, 3, 6 and 8 s
    score = score_windows([(0.0, 5.0, STANDING), (5.0, 9.9, WALKING)], timeline((0.0, STANDING), (6.5, WALKING)))
    assert score.samples == {(STANDING, STANDING): 2, (WALKING, STANDING): 1, (WALKING, WALKING): 1}


def test_shares_of_stairs_and_of_level_ways_by_hand():
    score = ActivityScore(
        Counter({
            (STAIRS_UP, STAIRS_UP): 6, (STAIRS_UP, Activity.STAIRS_DOWN): 2, (STAIRS_UP, WALKING): 2,
            (WALKING, WALKING): 9, (WALKING, STAIRS_UP): 1,
        })
    )  # fmt: skip
    assert stairs_figures(score) == {"stairs_called": 0.8, "stairs_direction": 0.6, "level_called": 0.1}


def test_every_wearer_is_in_one_fold():
    wearers = [wearer for fold in FOLDS for wearer in fold]
    assert len(FOLDS) == 5 and len(wearers) == len(set(wearers))
    assert all(fold_of(wearer) == number for number, fold in enumerate(FOLDS) for wearer in fold)
    with pytest.raises(ValueError, match="wearer 99"):
        fold_of(99)


def test_a_part_scored_on_a_wearer_is_trained_without_that_wearer(monkeypatch):
    class FakePart:
        """Stands for a part; its features are the wearers that it is trained on."""

    monkeypatch.setitem(learning.LEARNERS, FakePart, Learner(lambda folder: [], tuple))
    wearers = sorted(wearer for fold in FOLDS for wearer in fold)
    sources = [TrainingSource(FakePart, partial(str, wearer), wearer) for wearer in wearers] + [
        TrainingSource(FakePart, partial(str, "emulated"), None)
    ]
    parts = train_parts(sources, [source.features() for source in sources])
    for number, fold in enumerate(FOLDS):
        assert parts[FakePart, number] == (*(str(wearer) for wearer in wearers if wearer not in fold), "emulated")


@pytest.mark.long
def test_the_papers_classifier_in_five_folds(data_dir):
    (result,) = evaluate(data_dir, [recipes.by_name("footstep-tracker-printed")], only=["hugadb"], processes=2)
    (every,) = [summary for summary in result.summaries if summary.group == "all"]
    assert every.count == 115 and not result.failures
    assert (every.together["accuracy"] or 0.0) > 0.74
    assert every.together["f1_running"] == 0.0
    assert (every.together["rides_found"] or 0.0) >= 0.8 * (every.together["rides_true"] or 0.0)
