"""Li et al. 2016: walking, jogging, stairs and five minutes in a building with an MPU-6050 on one shoe at 100 Hz.

Twenty wearers take a hundred strides at a walk and at a jog, two flights of stairs upwards and two downwards, and walk
for five minutes (shoe_walks.py). The values of a row are the single strides of all wearers, unless stated otherwise.
The paper calls strides steps, and so do the rows. It draws figures 21 and 22 and does not print their values."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from ...papers.shoe_sensing.recipe import SHOE_SENSING
from ..measures.matching import Errors
from . import published
from .runner import Runner
from .shoe_walks import STATES, ShoeResults, score_wearer
from .tables import DrawStyle, FigureRow, FloorPanel, PictureTrack, Reproduction, row_of

NAME = SHOE_SENSING.name
WALKS = 20
"""Number of wearers; section 4.2.1: "20 rounds"."""
STAIR_STATES = ("upstairs", "downstairs")


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom walks every experiment."""
    count = WALKS if walks is None else walks
    seeds = [1000 * seed + k for k in range(count)]
    results = runner.run(score_wearer, seeds, _describe)
    return Reproduction(
        name=NAME,
        paper_title=published.SHOE_SENSING_TITLE,
        emulation=f"{count} wearers with an MPU-6050 on one shoe at 100 Hz, another one each time",
        unit="as named",
        rows=tuple([row for part in ROW_FUNCTIONS for row in part(results)]),
        panels=_panels(results),
        notes=_notes(results),
    )


def _describe(one: ShoeResults) -> str:
    found = ", ".join(f"{state} {one.energy[state].stride_f1:.1f}" for state in STATES)
    return f"strides found, %: {found}; five minutes end {one.tour.end_error:.2f} m off"


_row = partial(row_of, published.SHOE_SENSING, digits=3)


def _extraction(results: Sequence[ShoeResults]) -> list[FigureRow]:
    """Return the rows of figs. 21 and 22, with one value for each wearer."""
    rows = []
    for state in STATES:
        rows.append(_row(f"{state}, steps by energy %", [one.energy[state].stride_f1 for one in results], digits=1))
        rows.append(
            _row(f"{state}, steps by magnitude %", [one.magnitude[state].stride_f1 for one in results], digits=1)
        )
    rows += [
        _row(f"{state}, state right %", [one.energy[state].right_share for one in results], digits=1)
        for state in STATES
    ]
    return rows


def _table_1(results: Sequence[ShoeResults]) -> list[FigureRow]:
    """Return the rows of table 1 for strides without height correction, as those of the paper must have been."""
    plane = [a for one in results for state in STATES[:2] for a in one.before[state].angles]
    stairs = [
        _row(f"{state} deg/m", [a for one in results for a in one.before[state].angles]) for state in STAIR_STATES
    ]
    return [_row("plane deg/m", plane), *stairs]


def _heights(results: Sequence[ShoeResults]) -> list[FigureRow]:
    rows = []
    for state in STATES[:2]:
        by_name = {"before": [one.before[state] for one in results], "after": [one.energy[state] for one in results]}
        for name, scores in by_name.items():
            rows.append(_row(f"{state}, height {name} m", [abs(error) for one in scores for error, _ in one.heights]))
            rows.append(_row(f"{state}, height of 100 steps {name} m", [abs(one.height) for one in scores]))
    return rows


def _lengths(results: Sequence[ShoeResults]) -> list[FigureRow]:
    rows = []
    for state in STATES:
        stride_errors = [one.energy[state] for one in results]
        rows.append(_row(f"{state}, length m", [abs(error) for one in stride_errors for error, _ in one.lengths]))
        if state in STAIR_STATES:
            rows.append(_row(f"{state}, height m", [abs(error) for one in stride_errors for error, _ in one.heights]))
    for state in STATES:
        stride_errors = [one.energy[state] for one in results]
        errors = [one.heights if state == "upstairs" else one.lengths for one in stride_errors if one.found]
        rows.append(_row(f"{state}, table 2 %", [100.0 * _relative(of) / published.TABLE_2_DIVISOR for of in errors]))
    return rows


def _relative(errors: Sequence[tuple[float, float]]) -> float:
    """Return the mean magnitude of the error over the mean true value, as the paper computes it."""
    off, true = (Errors(values).mean for values in zip(*errors, strict=True))
    return off / true if off is not None and true else 0.0


def _course_rows(results: Sequence[ShoeResults]) -> list[FigureRow]:
    return [
        *[
            _row(
                f"{state}, course deg",
                [abs(off) for one in results for off in one.energy[state].course_errors],
                digits=2,
            )
            for state in STATES[:2]
        ],
        _row("five minutes, end off m", [one.tour.end_error for one in results], digits=2),
        _row("five minutes, height off m", [abs(one.tour.height_error) for one in results], digits=2),
    ]


ROW_FUNCTIONS = (_extraction, _table_1, _heights, _lengths, _course_rows)


def _panels(results: Sequence[ShoeResults]) -> tuple[FloorPanel, ...]:
    """Return fig. 35 from above and from the side, for the first wearer."""
    tour = results[0].tour
    views = (("five minutes (fig. 35), from above", tour.top_view), ("height over the way", tour.side_view))
    return tuple(
        [
            FloorPanel(title, (PictureTrack("true path", true, DrawStyle.TRUTH), PictureTrack(NAME, ours)))
            for title, (ours, true) in views
        ]
    )


def _notes(results: Sequence[ShoeResults]) -> tuple[str, ...]:
    return (*DEFINITIONS, *_length_notes(results), *_height_notes(results), *_tour_notes(results), *PAPER_NOTES)


DEFINITIONS = (
    'Rows: length and height are errors of single steps without their signs, all wearers together; "height of 100 '
    'steps" is what the track of a whole level walk gained, one figure a wearer; course is the direction of single '
    "steps over the first 19.2 m, the first two metres laid on the truth; steps by energy or magnitude is F1 of steps "
    "that end within 0.3 s of a true one; state right is the share of the steps found whose own angle is of the state "
    "walked; table 2 is a wearer's mean error over the mean length, divided by 22.5, of the height upstairs and of the "
    "length otherwise; before is without and after is with the elimination of height errors on level steps.",
    "Table 1 is of steps before their heights are corrected. What theta' is made of is in body/activity/steepness.py; "
    "the paper's words for it do not fit its figures.",
)
PAPER_NOTES = (
    "The paper: lengths right to 90.8 % walking, 91.9 % jogging, 90.8 % upstairs and 80.0 % downstairs, at worst "
    "off by 0.34, 0.49, 0.32 and 0.38 m; heights of level steps after elimination at worst off by 0.26 m walking and "
    "0.61 m jogging; states above 95 %, steps nearly 100 %; of the five minutes it has a picture and no figure.",
)


def _length_notes(results: Sequence[ShoeResults]) -> list[str]:
    lines = []
    for state in STATES:
        stride_errors = [one.energy[state] for one in results]
        lengths = [pair for one in stride_errors for pair in one.lengths]
        if not lengths:
            continue
        merged, split = sum([one.merged for one in stride_errors]), sum([one.split for one in stride_errors])
        worst = max([abs(error) for error, _ in lengths])
        line = (
            f"{state.capitalize()}: steps of {np.mean([true for _, true in lengths]):.2f} m on average, lengths right "
            f"to {100.0 * (1.0 - _relative(lengths)):.1f} %, at worst off by {worst:.2f} m"
        )
        others = [abs(error) for one in stride_errors for error in one.whole]
        if merged + split and others:
            line += (
                f"; of {len(lengths)} steps {merged} were joined with the step before, whose stance was missed, "
                f"and {split} in two pieces; the others are at worst off by {max(others):.2f} m"
            )
        lines.append(f"{line}.")
    return lines


def _height_notes(results: Sequence[ShoeResults]) -> list[str]:
    lines = [
        "Heights after elimination say little: a step that is judged level ends exactly as high as it began, by "
        "construction, on any floor, a ramp too. What is left comes of level steps that were not judged so."
    ]
    for state in STATES[:2]:
        before = [abs(one.before[state].height) for one in results]
        after = [abs(one.energy[state].height) for one in results]
        n_level = sum([height < 1e-6 for height in after])
        lines.append(
            f"{state.capitalize()} 100 steps on the level: {n_level} of {len(results)} tracks end exactly as high "
            f"as they began, at worst {max(after):.2f} m off; without elimination they drift by "
            f"{np.mean(before):.2f} m on average and {max(before):.2f} m at worst."
        )
    lines.append(
        'The paper\'s heights before elimination (0.12 m walking, 0.17 m jogging) are of "100 sets of data", and it '
        "does not say how many steps a set has; they stand beside ours of single steps. Ours of a whole walk are "
        "metres where the paper has decimetres: an offset of the accelerometer, emulated as large as its data sheet "
        "has it, tilts every step the same way, and without elimination nothing in the method finds it."
    )
    return lines


def _tour_notes(results: Sequence[ShoeResults]) -> list[str]:
    tours = [one.tour for one in results]
    errors = [one.end_error for one in tours]
    share = 100.0 * sum(errors) / sum([one.path_length for one in tours])
    headings = [abs(one.heading_error) for one in tours]
    heights = [abs(one.height_error) for one in tours]
    n_exact = sum([one.reported == one.true for one in tours])
    return [
        f"Five minutes: flights reported exactly in {n_exact} of {len(results)} walks; the end is off by "
        f"{np.mean(errors):.1f} m on average, {share:.1f} % of the way, and by {max(errors):.1f} m at worst, its "
        f"height by {np.mean(heights):.2f} m and {max(heights):.2f} m.",
        f"The heading of the five minutes' last steps is off by {np.mean(headings):.0f} degrees on average and "
        f"{max(headings):.0f} at worst: it is integrated from the gyroscope, and nothing in the method corrects it. "
        "The way goes round and back, which hides much of that at its end.",
    ]
