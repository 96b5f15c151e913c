"""No sentence of a report is denied by its own tables: the rules on which its sentences and large figures rely.

1. Speed and cadence of the first sentence, and the large figures, are those of the gait table.
2. Double support is the sum of its two rows, and stance and single support fill the cycle as they must.
3. The foot that "swings longer" is the one whose stance is shorter in the table.
4. The cycles that "count" are those of the gait table.
5. Nothing is missing by the quality if nothing is missing by the table of sensors.
6. What the quality withholds (times of the feet that could not be compared) is in no table.
7. Distance is not more than either foot went, nor less, by a tenth.
8. Strides are good, and nothing contradicts physics, as far as the findings have few or no degraded strides.
9. By how much the feet differ in stride length or step time is the asymmetry of the gait table.
10. What is left out for its interval is in no table, card or sentence; what is not has an interval that says something.
11. The result of a test is that of its table; compared is only what was measured of a whole test, at its own pace."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from math import pi

import pytest
from attrs import evolve
from pages import Node, parse_page
from reported_walks import ROUTES, events_of, report_of
from soak import longer
from walks import insoles, run_session, samples

from solepath.emulate.routes.route import Route
from solepath.events import Event, Flaw, GaitCycleMeasured, StrideTaken
from solepath.show.outcomes import Person, Sex
from solepath.show.outcomes.clinic import OutcomeRequest, WalkTest
from solepath.show.report.bands import mean_bands
from solepath.show.report.sections.quality import GOOD_DEGRADED_SHARE
from solepath.types import Foot
from solepath_lab.emulated import slow_walkers

Rows = dict[str, dict[str, str]]


def numbers(text: str) -> list[float]:
    return [float(one) for one in re.findall(r"-?\d+(?:\.\d+)?", text)]


def table_with(page: Node, first: str) -> Rows:
    """Return the rows of the table whose first column has this name, by their first cells and their columns."""
    for table in page.all("table"):
        head, *rows = [[cell.text for cell in row.children] for row in table.all("tr")]
        if head[0] == first:
            return {row[0]: dict(zip(head[1:], row[1:], strict=True)) for row in rows}
    return {}


def one_foot(foot: Foot) -> Sequence[Event]:
    fed = [one for one in samples(ROUTES["walk"], cells=0, rate=100.0) if one.site.foot is foot]
    return run_session(fed, poses=True, pressures=True)


def limping() -> Sequence[Event]:
    fed = slow_walkers.samples_of(next(one for one in slow_walkers.GAITS if one.name == "limping"), 3, 100.0)
    return run_session(fed, poses=True, pressures=True)


WALKS: dict[str, Callable[[], Sequence[Event]]] = {
    "walk": lambda: events_of("walk"),
    "slow": lambda: events_of("slow"),
    "left foot alone": lambda: one_foot(Foot.LEFT),
    "right foot alone": lambda: one_foot(Foot.RIGHT),
    "limping": limping,
    "one sensor's scale wrong": lambda: with_longer_right_strides(1.05),
    "one sensor's scale wrong, and faster in the end": lambda: faster_in_the_end(),
    "ends of a range": lambda: clipped(),
    "there and back": lambda: there_and_back(),
}
TESTS: dict[str, OutcomeRequest | None] = {
    "no test": None,
    "six-minute": OutcomeRequest(test=WalkTest.SIX_MINUTE, person=Person(72.0, Sex.FEMALE, 1.62, 68.0)),
    "tug": OutcomeRequest(test=WalkTest.UP_AND_GO, marks=(1.0, 12.0), person=Person(72.0, Sex.FEMALE)),
    "walk test": OutcomeRequest(test=WalkTest.WALK, person=Person(72.0, Sex.FEMALE), outcomes=True),
}


def with_longer_right_strides(factor: float) -> Sequence[Event]:
    return [
        evolve(one, stride_length=factor * (one.stride_length or 0.0), speed=factor * (one.speed or 0.0))
        if isinstance(one, GaitCycleMeasured) and one.foot is Foot.RIGHT
        else one
        for one in events_of("walk")
    ]


def faster_in_the_end() -> Sequence[Event]:
    """Return a walk whose strides grow, those of the right foot more, and of which the last left ones do not count."""
    made: list[Event] = []
    for one in with_longer_right_strides(1.08):
        if isinstance(one, GaitCycleMeasured):
            grown = (one.stride_length or 0.0) * (1.0 + 0.003 * one.number)
            steady = one.steady and (one.foot is Foot.RIGHT or one.number < 12)
            one = evolve(one, stride_length=grown, speed=grown / one.stride_time, steady=steady)
        made.append(one)
    return made


def clipped() -> Sequence[Event]:
    """Return a walk in which every third stride has values at the end of a range."""
    return [
        evolve(one, flaws=(Flaw.RANGE,)) if isinstance(one, StrideTaken) and one.number % 3 == 0 else one
        for one in events_of("walk")
    ]


def there_and_back() -> Sequence[Event]:
    route = Route().stand(2.0).walk(3.0, 1.0).turn(pi, radius=0.4).walk(3.0, 1.0).stop(4.0)
    return run_session(insoles(route, seed=3).packets, poses=True, pressures=True)


@pytest.mark.parametrize("test", TESTS)
@pytest.mark.parametrize("name", [*[*WALKS][::2], *longer(*[*WALKS][1::2])])
def test_no_sentence_is_denied_by_its_own_table(name: str, test: str) -> None:
    report, request = report_of(()), TESTS[test]
    report.walk.limit, report.outcomes = None, request
    report.take(None, WALKS[name]())
    report.bands = mean_bands(Person(72.0, Sex.FEMALE))
    page = parse_page(report.text())
    said = page.named("headline" if request is None else "beside").text
    gait, links = table_with(page, "parameter"), table_with(page, "sensor")
    means = {label: cells.get("both") or next(iter(cells.values())) for label, cells in gait.items()}
    both = {label: numbers(cell)[0] for label, cell in means.items() if numbers(cell)}
    cards = {
        one.first("h3").text: numbers(one.named("value").text)[0]
        for one in page.all("div")
        if one.attributes.get("class") == "card"
    }
    # 1
    pace = re.search(r"at ([\d.]+) m/s(?: and (\d+) steps a minute)?", said)
    assert pace is not None and float(pace[1]) == pytest.approx(both["speed, m/s"], abs=0.006)
    assert pace[2] is None or float(pace[2]) == pytest.approx(both["cadence, steps/min"], abs=0.51)
    assert cards["Speed"] == float(pace[1])
    assert cards["Stride length"] == pytest.approx(both["stride length, m"], abs=0.006)
    # 2
    if "initial double support, %" in both:
        supports = both["initial double support, %"] + both["terminal double support, %"]
        assert cards["Double support"] == pytest.approx(supports, abs=0.11)
        assert both["single support, %"] + supports == pytest.approx(both["stance, %"], abs=0.21)
    # 3
    longer = re.search(r"the (left|right) foot swings \d+ % longer", said)
    if longer is not None:
        left, right = [numbers(gait["stance, %"][foot])[0] for foot in ("left", "right")]
        assert (longer[1] == "right") == (right < left)
    # 4 and 5
    quality = {row.first("span").text: row.first("dd").text for row in page.named("quality").children}
    cycles = [numbers(cell)[0] for foot, cell in gait["gait cycles"].items() if foot in ("left", "right")]
    assert numbers(quality["gait cycles"])[0] == sum(cycles)
    missing = sum(numbers(cells["missing"])[0] for cells in links.values())
    assert (quality["samples"] == "No sample is missing.") == (missing == 0)
    # 6
    if "clocks" not in quality:
        assert "step time, s" not in gait and "step-time" not in page.text
    # 7
    walked = numbers(said)[0]
    each = [float(one) for one in re.findall(r"strides over ([\d.]+) m", page.text)]
    assert each and all(abs(one - walked) < 0.1 * walked + 1.0 for one in each)
    # 8
    degraded = [
        int(one) / int(all_of) for one, all_of in re.findall(r"foot: (\d+) of (\d+) strides? degraded", page.text)
    ]
    verdicts = {row.first("span").text: row.first("strong").text for row in page.named("quality").children}
    assert (max(degraded, default=0.0) <= GOOD_DEGRADED_SHARE) == (verdicts["strides"] == "good") or test == "tug"
    assert (not degraded) == quality["plausibility"].endswith("or physics.")
    # 9
    for length_or_time, row in (("stride length", "stride length, m"), ("step time", "step time, s")):
        differ = re.search(rf"differ by (\d+) % in {length_or_time}", said)
        assert differ is None or float(differ[1]) == pytest.approx(abs(numbers(gait[row]["asymmetry"])[0]), abs=0.51)
    # 10
    left_out = " ".join(one.text for one in page.all("p") if one.text.startswith("Left out, because"))
    for label, cells in gait.items():
        if "asymmetry" in cells and numbers(cells["asymmetry"]):
            assert f" {label.rpartition(',')[0]}" not in left_out and "every asymmetry" not in left_out
    assert ("Asymmetry" in cards) <= ("asymmetry of swing time" not in left_out)
    assert "Asymmetry" not in cards or numbers(page.text.partition("of swing time, \N{PLUS-MINUS SIGN} ")[2])[0] <= 10.0
    # 11
    pace_of_others = "at their usual pace" in page.text
    assert pace_of_others == (request is None or request.usual_pace)
    if request is not None:
        result, outcome = page.named("headline").text, table_with(page, "outcome")
        value = next(iter(outcome.values()))["value"]
        assert f": {value} " in result
        assert "predicted" not in page.text, "no walk here lasts for six minutes"
