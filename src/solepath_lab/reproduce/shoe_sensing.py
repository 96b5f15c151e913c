"""Li et al. 2016: walking, jogging, stairs, a rectangle and five minutes in a building with an MPU-6050 on one shoe.

Ten wearers go 19.2 m there and back at a walk and at a jog, and a flight up and down, twice each: twenty rounds in all.
They go around a rectangle, over ramps, and for five minutes through a building (shoe/walks.py). One of them goes there
and back twenty times more. Two methods are compared everywhere: the printed one and ours. On a short walk of some
wearers each of our additions is left out once, and windows of other lengths are tried; other rates, shoes and sensors
walk it too (shoe/variants.py). The values of a row are the single strides of all wearers, unless stated otherwise. The
paper calls strides steps, and so do the rows. It draws figures 21 and 22 and does not print their values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

from solepath.papers.shoe_sensing.recipe import SHOE_SENSING

from .published import PUBLISHED, rows_of
from .runner import Runner
from .shoe.notes import Results, notes, scores_of_state
from .shoe.scores import relative_error
from .shoe.variants import BEFORE, BY_ANGLE, DEFAULT_ROW, LEVEL, MAGNITUDE, METHODS, OURS, SETUPS, SHORT, STAIRS, STATES
from .shoe.walks import SLOPES, SessionScores, ShoeJob, ShoeResults, walk
from .tables import FigureRow, Panel, Plot, Reproduction, row_of

NAME = SHOE_SENSING.name
WALKS = 10
"""Number of wearers, each with two rounds; section 4.2.1: "20 rounds each (i.e., back and forth)"."""
SHORT_WALKS = 4
"""Number of wearers who go the short walk for all recipes."""
LONG_WALKS = ("walking", "jogging", "stairs", "rectangle", "ramps", "five minutes", "short")
STRIDES = 100
"""Number of strides over which heights are added up (section 4.2.3)."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom walks every experiment."""
    count = WALKS if walks is None else walks
    done = runner.run(walk, jobs_of(count, seed), _describe)
    setups, long_walk, wearers = done[: len(SETUPS)], done[len(SETUPS)], done[len(SETUPS) + 1 :]
    names = [job.walk for job in jobs_of(count, seed)[len(SETUPS) + 1 :]]
    results = {
        name: [one for one, of in zip(wearers, names, strict=True) if of == name] for name in dict.fromkeys(names)
    }
    return Reproduction(
        name=NAME,
        paper_title=PUBLISHED[NAME]["title"],
        emulation=f"{count} wearers with an MPU-6050 on one worn shoe at 100 Hz, another sensor for each walk",
        unit="as named",
        rows=tuple([row for part in ROW_FUNCTIONS for row in part(results)]),
        panels=_panels(results),
        notes=notes(results, long_walk, SETUPS, setups),
    )


def jobs_of(count: int, seed: int) -> list[ShoeJob]:
    """Return the short walk of each setup, a walk of twenty rounds, and all walks of each of `count` wearers."""
    jobs = [ShoeJob(1000 * seed + 900, "short", setup) for setup in SETUPS]
    jobs.append(ShoeJob(1000 * seed + 901, "twenty rounds"))
    for k in range(count):
        jobs += [
            ShoeJob(1000 * seed + 10 * k + number, name, drawn=k == 0)
            for number, name in enumerate(LONG_WALKS)
            if name != "short" or k < SHORT_WALKS
        ]
    return jobs


def _describe(one: ShoeResults) -> str:
    found = [
        f"{state} {', '.join(f'{of.states[state].stride_f1:.1f} % {name}' for name, of in _methods(one))}"
        for state in one.scores[OURS].states
    ]
    ends = ", ".join(f"{of.track.end_error:.2f} m {name}" for name, of in _methods(one))
    return f"steps found: {'; '.join(found)}; end off by {ends}"


def _methods(one: ShoeResults) -> list[tuple[str, SessionScores]]:
    return [(name, one.scores[name]) for name in METHODS]


_row = partial(row_of, rows_of(NAME), digits=3)


def _extraction(results: Results) -> list[FigureRow]:
    """Return the rows of figs. 21 and 22, with one value for each wearer."""
    rows = []
    for state in STATES:
        by_method = {method: scores_of_state(results, state, method) for method in METHODS}
        by_method[MAGNITUDE] = [one.scores[MAGNITUDE].states[state] for one in results["short"]]
        rows += [
            _row(f"{state}, steps, {method} %", [of.stride_f1 for of in scores], digits=1)
            for method, scores in by_method.items()
        ]
    for state in STATES:
        rows += [
            _row(
                f"{state}, state, {method} %",
                [of.right_share for of in scores_of_state(results, state, method)],
                digits=1,
            )
            for method in METHODS
        ]
    return rows


def _table_1(results: Results) -> list[FigureRow]:
    """Return the rows of table 1 for strides without height correction, as those of the paper must have been."""
    rows = []
    for method in METHODS:
        for name, states in (("plane", LEVEL), *((state, (state,)) for state in STAIRS)):
            scores = [of for state in states for of in scores_of_state(results, state, BEFORE[method])]
            rows.append(_row(f"{name}, {method} deg/m", [angle for of in scores for angle in of.angles]))
    return rows


def _heights(results: Results) -> list[FigureRow]:
    rows = []
    for state in LEVEL:
        for method in METHODS:
            for word, recipe in (("before", BEFORE[method]), ("after", method)):
                scores = scores_of_state(results, state, recipe)
                rows.append(_row(f"{state}, height {word}, {method} m", _sizes(of.heights for of in scores)))
                sums = [abs(sum([error for error, _ in of.heights[:STRIDES]])) for of in scores]
                rows.append(_row(f"{state}, height of 100 steps {word}, {method} m", sums))
    return rows


def _lengths(results: Results) -> list[FigureRow]:
    rows = []
    for state in STATES:
        for method in METHODS:
            scores = scores_of_state(results, state, method)
            rows.append(_row(f"{state}, length, {method} m", _sizes(of.lengths for of in scores)))
            if state in STAIRS:
                rows.append(_row(f"{state}, height, {method} m", _sizes(of.heights for of in scores)))
    for state in STATES:
        for method in METHODS:
            scores = scores_of_state(results, state, method)
            errors = [of.heights if state == "upstairs" else of.lengths for of in scores if of.found]
            shares = [100.0 * relative_error(of) / PUBLISHED[NAME]["table-2-divisor"] for of in errors]
            rows.append(_row(f"{state}, table 2, {method} %", shares))
    return rows


def _legs(results: Results) -> list[FigureRow]:
    """Return the rows of figs. 25, 33 and 34: legs of 19.2 m, the rectangle, courses."""
    rows = []
    for state in LEVEL:
        for method in METHODS:
            legs = [one.scores[method].legs for one in results[state]]
            lengths = [sum(leg.length) for walked in legs for leg in walked]
            rows.append(_row(f"{state}, 19.2 m, {method} m", lengths, digits=2))
    for method in METHODS:
        scores = [one.scores[method] for one in results["rectangle"]]
        sides = [abs(leg.length[0]) for of in scores for leg in of.legs]
        rows.append(_row(f"rectangle, side off, {method} m", sides, digits=2))
        ends = [of.track.end_error for of in scores]
        rows.append(_row(f"rectangle, end off, {method} m", ends, digits=2))
    for state in LEVEL:
        for method in METHODS:
            legs = [one.scores[method].legs for one in results[state]]
            courses = [abs(course) for walked in legs for leg in walked for course in leg.courses]
            rows.append(_row(f"{state}, course, {method} deg", courses, digits=2))
            ends = [abs(walked[-1].heading) for walked in legs if walked]
            rows.append(_row(f"{state}, heading after all rounds, {method} deg", ends, digits=1))
    return rows


def _slopes(results: Results) -> list[FigureRow]:
    """Return the rows of heights that are not zero: two ramps up and down, and a kerb up and down."""
    rows = []
    names = (*(f"slope {100.0 * slope:g} %" for slope in SLOPES), "kerb 0.1 m")
    for k, name in enumerate(names):
        for recipe in (*[one for method in METHODS for one in (method, BEFORE[method])], BY_ANGLE, DEFAULT_ROW):
            rises = [one.scores[recipe].rises[2 * k :][:2] for one in results["ramps"]]
            rows.append(_row(f"{name}, height off, {recipe} m", _sizes(rises), digits=2))
    return rows


def _tours(results: Results) -> list[FigureRow]:
    rows = []
    for recipe in (*METHODS, DEFAULT_ROW):
        tracks = [one.scores[recipe].track for one in results["five minutes"]]
        rows.append(_row(f"five minutes, end off, {recipe} m", [of.end_error for of in tracks], digits=2))
        rows.append(_row(f"five minutes, height off, {recipe} m", [abs(of.height_error) for of in tracks], digits=2))
    return rows


def _additions(results: Results) -> list[FigureRow]:
    """Return the rows of the short walk: ours without one addition at a time, and the printed method by window."""
    rows = []
    for recipe in SHORT:
        walks = [one.scores[recipe] for one in results["short"]]
        for state in LEVEL:
            shares = [of.states[state].stride_f1 for of in walks]
            rows.append(_row(f"short: {recipe}, {state}, steps %", shares, digits=1))
        lengths = _sizes(of.states[state].lengths for of in walks for state in STATES)
        rows.append(_row(f"short: {recipe}, length m", lengths))
        heights = _sizes(of.states[state].heights for of in walks for state in STAIRS)
        rows.append(_row(f"short: {recipe}, stair height m", heights))
        rows.append(_row(f"short: {recipe}, end height m", [abs(of.track.height_error) for of in walks]))
    return rows


def _sizes(errors: Iterable[Sequence[tuple[float, float]]]) -> list[float]:
    """Return the errors without their signs of all groups of (error, true value)."""
    return [abs(error) for group in errors for error, _ in group]


ROW_FUNCTIONS = (_extraction, _table_1, _heights, _lengths, _legs, _slopes, _tours, _additions)


def _panels(results: Results) -> tuple[Panel, ...]:
    """Return figs. 3, 7 and 20, and tracks in space of figs. 25, 28 and 35, for the first wearer."""
    titles = {"walking": "there and back (fig. 25a)", "rectangle": "rectangle (fig. 25b)", "stairs": "stairs (fig. 28)"}
    titles["five minutes"] = "five minutes (fig. 35)"
    spaces = [Plot(title, results[name][0].tracks) for name, title in titles.items()]
    return (*results["short"][0].curves, *spaces)
