"""The result of a six-minute walk in sentences: what is not a whole test is compared with nothing, before and after."""

from __future__ import annotations

import pytest
from made_walks import walk, without

from solepath.events import Event
from solepath.show.outcomes import Person, Sex
from solepath.show.outcomes.clinic import ClinicalResults, OutcomeRequest, WalkTest
from solepath.types import Foot
from solepath.walk.walk import Walk

L, R = Foot.LEFT, Foot.RIGHT
# 400 strides of 1 s and 1.2 m of each foot; 21 of them; and no sample of either foot for a minute
WOMAN = Person(72.0, Sex.FEMALE, 1.62, 68.0)
WHOLE, SLOWER = walk(10.0, 400), walk(10.0, 400, 1.0)
UNFINISHED = walk(10.0, 21)
WITHOUT_FEET = without(without(WHOLE, L, 100.2, 160.3), R, 100.1, 160.0)
ENDS = "the recording ends before the six minutes do"
ABSENT = "no foot was measured for 1 min 0 s of the six minutes"
NOTHING = "it is compared with no prediction and no other walk."
PREDICTED = "432.0 m, 99 % of the predicted 436.9 m (lower limit of normal 297.9 m)."


def results(events: list[Event], start: float | None = None) -> ClinicalResults:
    marks = () if start is None else (start,)
    return OutcomeRequest(test=WalkTest.SIX_MINUTE, marks=marks, person=WOMAN).results(Walk.of(events))


@pytest.mark.parametrize(
    ("after", "start", "words"),
    [
        (WHOLE, None, [PREDICTED]),
        (UNFINISHED, None, ["25.20 m in 21 s of the six minutes.", f"{ENDS}: {NOTHING}"]),
        (WHOLE, 300.0, ["132.6 m in 1 min 50 s of the six minutes.", f"{ENDS}: {NOTHING}"]),
        (WITHOUT_FEET, None, ["at least 359.4 m.", f"{ABSENT}: {NOTHING}"]),
        (without(WHOLE, L, 100.2, 160.3), None, ["432.0 m, 1 min 0 s of it by the right foot alone, 99 % of the "]),
    ],
)
@pytest.mark.parametrize(
    ("before", "said"),
    [
        (SLOWER, "360.0 m."),
        (UNFINISHED, f"25.20 m in 21 s of the six minutes: {ENDS}, so that no change is given."),
        (WITHOUT_FEET, f"at least 359.4 m: {ABSENT}, so that no change is given."),
    ],
)
def test_only_whole_tests_have_a_prediction_and_a_change(
    after: list[Event], start: float | None, words: list[str], before: list[Event], said: str
) -> None:
    text = " ".join(results(after, start).answer(results(before)))
    assert [one for one in words if one.lower() not in text.lower()] == []
    are_whole = "of the predicted" in text and before is SLOWER
    assert ("The change, +72.0 m, reaches the smallest that matters, 30 m." in text) == are_whole
    assert ("The change" in text) == are_whole and f"Before: {said}" in text


def test_a_walk_before_without_a_result_says_why_and_a_test_names_itself() -> None:
    late = results(WHOLE, 900.0)
    sentence = (
        "there is no outcome of the six-minute walk. The recording is from 11.0 to 410.5 s on its clock; 900 s is"
    )
    assert late.answer()[0].lower().startswith(sentence.lower())
    assert results(WHOLE).answer(late)[-1].startswith(f"Before: {sentence}")
    marks = OutcomeRequest(test=WalkTest.UP_AND_GO, marks=(800.0, 900.0)).results(Walk.of(WHOLE))
    assert "800 and 900 s are not within it." in marks.answer()[0]
    one = OutcomeRequest(test=WalkTest.UP_AND_GO, marks=(20.0, 900.0)).results(Walk.of(WHOLE))
    assert "; 900 s is not within it." in one.answer()[0]
