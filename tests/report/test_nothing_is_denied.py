"""No sentence of a report is denied by its own tables: the rules on which its sentences and large figures rely.

1. Speed and cadence of the first sentence, and the large figures, are those of the gait table.
2. Double support is the sum of its two rows, and stance and single support fill the cycle as they must.
3. The foot that "swings longer" is the one whose stance is shorter in the table.
4. The cycles that "count" are those of the gait table.
5. Nothing is missing by the quality if nothing is missing by the table of sensors.
6. What the quality withholds (times of the feet that could not be compared) is in no table.
7. Distance is not more than either foot went, nor less, by a tenth."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

import pytest
from pages import Node, parse_page
from reported_walks import ROUTES, events_of, report_of
from walks import run_session, samples

from solepath.events import Event
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
}


@pytest.mark.parametrize("name", WALKS)
def test_no_sentence_is_denied_by_its_own_table(name: str) -> None:
    page = parse_page(report_of(WALKS[name]()).text())
    said, gait, links = page.first("main").all("p")[0].text, table_with(page, "parameter"), table_with(page, "sensor")
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
