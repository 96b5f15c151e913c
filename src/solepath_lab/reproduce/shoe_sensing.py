"""Li et al. 2016: walking, jogging, stairs, a rectangle and five minutes in a building with an MPU-6050 on one shoe.

Ten wearers go 19.2 m there and back at a walk and at a jog, and a flight up and down, twice each: twenty rounds in all.
They go around a rectangle, over ramps, and for five minutes through a building (shoe/walks.py). Two methods are
compared everywhere: the printed one and ours. On a short walk each of our additions is left out once, and windows of
other lengths are tried; other rates, shoes and sensors walk it too (shoe/variants.py). The values of a row are the
single strides of all wearers, unless stated otherwise. The paper calls strides steps, and so do the rows. It draws
figures 21 and 22 and does not print their values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import chain, product

import numpy as np

from solepath.papers.shoe_sensing.recipe import SHOE_SENSING

from .published import PUBLISHED, rows_of
from .runner import Runner
from .shoe.notes import Results, figures, notes, walk_of
from .shoe.scores import relative_error
from .shoe.variants import (
    BEFORE,
    BY_ANGLE,
    DEFAULT_ROW,
    LESS,
    LEVEL,
    MAGNITUDE,
    METHODS,
    OURS,
    PRINTED,
    SETUPS,
    SHORT,
    STAIRS,
    STATES,
)
from .shoe.walks import SLOPES, TITLES, ShoeJob, walk
from .tables import Claim, FigureRow, Panel, Reproduction, WalkResults, claim, row_of

NAME = SHOE_SENSING.name
WALKS = 10
"""Number of wearers, each with two rounds; section 4.2.1: "20 rounds each (i.e., back and forth)"."""
LONG_WALKS = ("walking", "jogging", "stairs", "rectangle", "ramps", "five minutes", "short")


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom walks every experiment."""
    count = WALKS if walks is None else walks
    done = runner.run(walk, jobs_of(count, seed), _describe)
    setups, wearers = done[: len(SETUPS)], done[len(SETUPS) :]
    names = [job.walk for job in jobs_of(count, seed)[len(SETUPS) :]]
    results = {
        name: [one for one, of in zip(wearers, names, strict=True) if of == name] for name in dict.fromkeys(names)
    }
    return Reproduction(
        name=NAME,
        paper_title=PUBLISHED[NAME]["title"],
        emulation=f"{count} wearers with an MPU-6050 on one worn shoe at 100 Hz, another sensor for each walk",
        unit="as named",
        rows=tuple(_rows(results)),
        panels=_panels(results),
        claims=tuple(_claims(results)),
        notes=notes(results, setups),
    )


def jobs_of(count: int, seed: int) -> list[ShoeJob]:
    """Return the short walk of each setup, and all walks of each of `count` wearers."""
    jobs = [ShoeJob(1000 * seed + 900, "short", setup) for setup in SETUPS]
    for k in range(count):
        jobs += [ShoeJob(1000 * seed + 10 * k + number, name, drawn=k == 0) for number, name in enumerate(LONG_WALKS)]
    return jobs


def _describe(one: WalkResults) -> str:
    names = [f"{method}: {state} steps" for state in STATES for method in METHODS]
    steps = [f"{name} {one.values[name][0]:.1f} %" for name in names if name in one.values]
    ends = [f"{one.values[f'{name}: end'][0]:.2f} m {name}" for name in METHODS]
    return f"{', '.join(steps)}; end off by {', '.join(ends)}"


def _rows(results: Results) -> Iterator[FigureRow]:
    """Yield the rows of the table."""
    of_state = [(state, method, results[walk_of(state)]) for state, method in product(STATES, METHODS)]
    of_level = [one for one in of_state if one[0] in LEVEL]
    for state in STATES:  # figs. 21 and 22
        for method in (*METHODS, MAGNITUDE):
            walks = results["short" if method == MAGNITUDE else walk_of(state)]
            yield _row(f"{state}, steps, {method} %", figures(walks, method, f"{state} steps"), digits=1)
    for state, method, walks in of_state:
        right = [one.values[f"{method}: {state} right"] for one in walks]
        yield _row(f"{state}, state, {method} %", [100.0 * sum(one) / max(1, len(one)) for one in right], digits=1)
    for method in METHODS:  # table 1, without height correction, as the paper's strides must have been
        for name, states in (("plane", LEVEL), *((state, (state,)) for state in STAIRS)):
            angles = [figures(results[walk_of(state)], BEFORE[method], f"{state} angles") for state in states]
            yield _row(f"{name}, {method} deg/m", chain.from_iterable(angles))
    for state, method, walks in of_level:
        for word, recipe in (("before", BEFORE[method]), ("after", method)):
            yield _row(f"{state}, height {word}, {method} m", _sizes(walks, recipe, f"{state} heights"))
    for state, method, walks in of_state:
        yield _row(f"{state}, length, {method} m", _sizes(walks, method, f"{state} lengths"))
        if state in STAIRS:
            yield _row(f"{state}, height, {method} m", _sizes(walks, method, f"{state} heights"))
    for state, method, walks in of_state:
        kind = "heights" if state == "upstairs" else "lengths"
        pairs = [[figures([one], method, f"{state} {name}") for name in (kind, f"true {kind}")] for one in walks]
        shares = [100.0 * relative_error(*pair) / PUBLISHED[NAME]["table-2-divisor"] for pair in pairs if pair[0]]
        yield _row(f"{state}, table 2, {method} %", shares)
    for state, method, walks in of_level:  # figs. 25, 33 and 34
        yield _row(f"{state}, 19.2 m, {method} m", figures(walks, method, "legs"), digits=2)
    for method in METHODS:
        walks = results["rectangle"]
        sides, true = (figures(walks, method, name) for name in ("legs", "true legs"))
        off = np.abs(np.subtract(sides, true)).tolist()
        yield _row(f"rectangle, side off, {method} m", off, digits=2)
        yield _row(f"rectangle, end off, {method} m", figures(walks, method, "end"), digits=2)
    for state, method, walks in of_level:
        yield _row(f"{state}, course, {method} deg", _sizes(walks, method, "courses"), digits=2)
    for k, name in enumerate((*(f"slope {100.0 * slope:g} %" for slope in SLOPES), "kerb 0.1 m")):
        for recipe in (*METHODS, BY_ANGLE, DEFAULT_ROW):
            rises = [abs(rise) for one in results["ramps"] for rise in one.values[f"{recipe}: rises"][2 * k :][:2]]
            yield _row(f"{name}, height off, {recipe} m", rises, digits=2)
    for recipe in (*METHODS, DEFAULT_ROW):
        walks = results["five minutes"]
        yield _row(f"five minutes, end off, {recipe} m", figures(walks, recipe, "end"), digits=2)
        yield _row(f"five minutes, height off, {recipe} m", _sizes(walks, recipe, "end height"), digits=2)
    for recipe in SHORT:  # ours without one addition at a time, and the printed method by window
        walks = results["short"]
        for state in LEVEL:
            yield _row(f"short: {recipe}, {state}, steps %", figures(walks, recipe, f"{state} steps"), digits=1)
        yield _row(f"short: {recipe}, length m", _sizes(walks, recipe, *(f"{state} lengths" for state in STATES)))
        heights = _sizes(walks, recipe, *(f"{state} heights" for state in STAIRS))
        yield _row(f"short: {recipe}, stair height m", heights)
        yield _row(f"short: {recipe}, end height m", _sizes(walks, recipe, "end height"))


def _claims(results: Results) -> Iterator[Claim]:
    """Yield the comparisons of the documents; a margin is that of one wearer."""
    short, tours, ramps = results["short"], results["five minutes"], results["ramps"]
    for state in STATES:
        walks = results[walk_of(state)]
        yield claim(f"{state}: lengths err less with ours than as printed", *_both(walks, f"{state} lengths"))
    found = {name: _by_wearer(short, name, "jogging steps") for name in SHORT}
    for name in (PRINTED, *LESS):
        yield claim(f"jogging: ours finds more strides than {name}", found[OURS], found[name], "%")
    for state in STATES:
        energy, magnitude = (_by_wearer(short, name, f"{state} steps") for name in (PRINTED, MAGNITUDE))
        yield claim(f"{state}: energy finds more strides than magnitude", energy, magnitude, "%")
    lengths = {name: _by_wearer(short, name, *(f"{state} lengths" for state in STATES)) for name in SHORT}
    for name in LESS:
        yield claim(f"short: lengths err less with ours than with {name}", lengths[name], lengths[OURS])
    states = [figure for state in STATES for figure in _by_wearer(results[walk_of(state)], PRINTED, f"{state} right")]
    yield Claim("states of the strides found are right for more than 95 %", [100.0 * one - 95.0 for one in states], "%")
    yield claim("the end of five minutes: ours errs less than printed", *_both(tours, "end"))
    by_angle, ours = (_by_wearer(ramps, name, "rises") for name in (BY_ANGLE, OURS))
    yield claim("ramps and kerbs: heights err less with ours than with level by angle", by_angle, ours)
    by_angle, ours = (_by_wearer(short, name, "end height") for name in (BY_ANGLE, OURS))
    yield claim("short: the end's height errs less with level by angle than with ours", ours, by_angle)
    for name in METHODS:
        for walks, what, of in (
            (tours, "the end of five minutes", "end"),
            (ramps, "ramps and kerbs: heights", "rises"),
        ):
            worse, better = (_by_wearer(walks, recipe, of) for recipe in (name, DEFAULT_ROW))
            yield claim(f"{what}: default errs less than {name}", worse, better)


def _by_wearer(walks: Sequence[WalkResults], recipe: str, *names: str) -> list[float]:
    """Return the mean magnitude of these figures in each walk."""
    return [float(np.mean(np.abs(figures([one], recipe, *names) or [0.0]))) for one in walks]


def _both(walks: Sequence[WalkResults], name: str) -> tuple[list[float], list[float]]:
    """Return the figures of each walk as printed and with ours."""
    return _by_wearer(walks, PRINTED, name), _by_wearer(walks, OURS, name)


_row = partial(row_of, rows_of(NAME), digits=3)


def _sizes(walks: Sequence[WalkResults], recipe: str, *names: str) -> list[float]:
    """Return figures without their signs."""
    return [abs(value) for value in figures(walks, recipe, *names)]


def _panels(results: Results) -> tuple[Panel, ...]:
    """Return figs. 3, 7 and 20, and tracks in space of figs. 25, 28 and 35, for the first wearer."""
    return tuple([panel for name in ("short", *TITLES) for panel in results[name][0].panels])
