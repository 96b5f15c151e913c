"""Li et al. 2016: walking, jogging, stairs and five minutes in a building with an MPU-6050 on one shoe at 100 Hz.

Twenty wearers take a hundred steps at a walk and at a jog, two flights of stairs upwards and two downwards, and walk
for five minutes (shoe_walks.py). Rows are of single steps, all wearers together, unless they say otherwise. The figures
21 and 22 are drawn in the paper and not printed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..recipes import SHOE_SENSING
from . import published
from .picture import Drawn, Floor, Track
from .pool import Progress, each
from .shoe_walks import STATES, Steps, Walked, walked
from .tables import Reproduction, Row, Statistics

NAME = SHOE_SENSING.name
WALKS = 20
"""Section 4.2.1: "20 rounds"."""
ON_STAIRS = ("upstairs", "downstairs")


def reproduce(
    walks: int | None = None, seed: int = 1, *, processes: int = 1, progress: Progress | None = None
) -> Reproduction:
    """So many wearers, each of whom walks all of it."""
    count = WALKS if walks is None else walks
    done = list(each(walked, [1000 * seed + k for k in range(count)], processes=processes, progress=progress))
    return Reproduction(
        name=NAME,
        paper_title=published.SHOE_SENSING_TITLE,
        walked=f"{count} wearers with an MPU-6050 on one shoe at 100 Hz, another one each time",
        unit="as named",
        rows=tuple([row for part in PARTS for row in part(done)]),
        panels=_panels(done),
        notes=_notes(done),
    )


def _row(name: str, values: Iterable[float], digits: int = 3) -> Row:
    return Row(name, tuple(values), published.SHOE_SENSING.get(name, Statistics()), digits)


def _extraction(done: Sequence[Walked]) -> list[Row]:
    """Figs. 21 and 22, by wearer."""
    rows = []
    for state in STATES:
        rows.append(_row(f"{state}, steps by energy %", [one.energy[state].extracted for one in done], 1))
        rows.append(_row(f"{state}, steps by magnitude %", [one.magnitude[state].extracted for one in done], 1))
    rows += [_row(f"{state}, state right %", [_share(one.energy[state].right) for one in done], 1) for state in STATES]
    return rows


def _share(right: Sequence[bool]) -> float:
    return 100.0 * sum(right) / max(1, len(right))


def _table_1(done: Sequence[Walked]) -> list[Row]:
    """Of steps whose heights were left as they are, as the paper's must have been."""
    plane = [a for one in done for state in STATES[:2] for a in one.before[state].angles]
    rows = [_row("plane deg/m", plane)]
    for state in ON_STAIRS:
        rows.append(_row(f"{state} deg/m", [a for one in done for a in one.before[state].angles]))
    return rows


def _heights(done: Sequence[Walked]) -> list[Row]:
    rows = []
    for state in STATES[:2]:
        for name, of in (
            ("before", [one.before[state] for one in done]),
            ("after", [one.energy[state] for one in done]),
        ):
            rows.append(_row(f"{state}, height {name} m", [abs(error) for one in of for error, _ in one.heights]))
            rows.append(_row(f"{state}, height of 100 steps {name} m", [abs(one.height) for one in of]))
    return rows


def _lengths(done: Sequence[Walked]) -> list[Row]:
    rows = []
    for state in STATES:
        steps = [one.energy[state] for one in done]
        rows.append(_row(f"{state}, length m", [abs(error) for one in steps for error, _ in one.lengths]))
        if state in ON_STAIRS:
            rows.append(_row(f"{state}, height m", [abs(error) for one in steps for error, _ in one.heights]))
    for state in STATES:
        steps = [one.energy[state] for one in done]
        rows.append(_row(f"{state}, table 2 %", [_normalised(one, state) for one in steps if one.found]))
    return rows


def _normalised(steps: Steps, state: str) -> float:
    """Of one wearer, per cent."""
    errors = steps.heights if state == "upstairs" else steps.lengths
    off = sum([abs(error) for error, _ in errors]) / sum([abs(true) for _, true in errors])
    return 100.0 * off / published.NORMALISED


def _courses(done: Sequence[Walked]) -> list[Row]:
    return [
        _row(f"{state}, course deg", [abs(off) for one in done for off in one.energy[state].courses], 2)
        for state in STATES[:2]
    ]


def _tours(done: Sequence[Walked]) -> list[Row]:
    return [
        _row("five minutes, end off m", [one.tour.off for one in done], 2),
        _row("five minutes, height off m", [abs(one.tour.height) for one in done], 2),
    ]


PARTS = (_extraction, _table_1, _heights, _lengths, _courses, _tours)


def _panels(done: Sequence[Walked]) -> tuple[Floor, ...]:
    """Fig. 35 from above and from the side, of the first wearer."""
    found = []
    for one in done[:1]:
        views = (("five minutes (fig. 35), from above", one.tour.above), ("height over the way", one.tour.aside))
        for title, (ours, true) in views:
            found.append(Floor(title, (Track("true path", true, Drawn.TRUTH), Track(NAME, ours))))
    return tuple(found)


def _notes(done: Sequence[Walked]) -> tuple[str, ...]:
    lines = []
    for state in STATES:
        lengths = [pair for one in done for pair in one.energy[state].lengths]
        if lengths:
            off, true = np.abs(np.array(lengths)).mean(axis=0)
            worst = max(abs(error) for error, _ in lengths)
            lines.append(
                f"{state.capitalize()}: steps of {true:.2f} m on average, lengths right to "
                f"{100.0 * (1.0 - off / true):.1f} %, at worst off by {worst:.2f} m."
            )
    exact = sum([one.tour.told == one.tour.true for one in done])
    lines.append(f"Five minutes: flights told exactly in {exact} of {len(done)} walks.")
    lines.append(
        "The paper: lengths right to 90.8 % walking, 91.9 % jogging, 90.8 % upstairs and 80.0 % downstairs, at worst "
        "off by 0.34, 0.49, 0.32 and 0.38 m; states above 95 %, steps nearly 100 %."
    )
    lines.append(
        "Table 1 is of steps before their heights are corrected. What theta' is made of is in foot/steepness.py; the "
        "paper's words for it do not fit its figures."
    )
    return tuple(lines)
