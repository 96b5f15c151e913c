"""The share of recordings with separate clocks of the feet that a session reports, and of the others that it reports.

    solepath-lab damage clocks DIR [--only NAME] [--processes N]

prints a table as Markdown. DIR holds recorded data. The times of the right foot's events are shifted by an offset, or
stretched as by a clock that runs at another rate. A foot's events do not depend on the other foot's clock, so the
samples are processed once. The last column is of even walkers: the reported offset is undone, and the medians of step
time and double support of each foot are compared with those of the undamaged walk; the worst of the four counts.
Walks of at least a minute are repeated to ten minutes for clocks of different rates. The recordings in `KNOWN_APART`
have separate clocks already; they are listed below the table with what is reported. The run takes some minutes on one
processor."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from math import ceil, inf, isfinite
from pathlib import Path
from statistics import median

import numpy as np
from attrs import evolve, frozen

from solepath.body.checks.foot_clocks import FootClocks
from solepath.cli.common.processes import run_jobs
from solepath.events import DefectFound, GaitEvent, HeelStrike, StrideTaken
from solepath.types import OTHER, Foot

from ..tables import markdown
from .clock_walks import KNOWN_APART, PAUSE, ClockJob, ClockWalk, FootEvent, error_between, foot_of, read_walk

OFFSETS = (0.05, 0.1, 0.2, 0.3, 0.5)
"""Sizes of the offsets, s; each is added and subtracted."""
SECONDS_APART = (5.0, 10.0)
"""Sizes of offsets that leave one foot walking while the other one stands, s."""
RATE = 200e-6
"""Relative difference of the rates of two clocks, of which each may be wrong by 100 ppm."""
LONG = 600.0
"""Duration of a walk with clocks of different rates, s."""
MIN_WALKING = 12.0
"""Least time of walking of a recording that is scored, s; an offset needs ten steps of each foot without a fault."""
MINUTE = 60.0
"""Time of walking within which an offset has to be reported, s."""
SEEDS = (201, 202)
"""Seeds of the emulated walks."""
DATA_SETS = (
    "ipol_10m_uturn", "tripod_treadmill", "gaitmap_examples", "marpino_heel_toe", "gaitpdb_vgrf", "hugadb",
    "felius_2min_walk", "moticon_opengo", "smart_insole_35",
)  # fmt: skip
"""Folders of the data sets with recordings of both feet."""
EMULATED = "emulated"


@frozen
class ClockOutcome:
    """The report of the clocks in one walk, with damage to the clock of the right foot."""

    walking: float
    """Time that both feet walked in the whole walk, s: that of the foot with fewer cycles."""
    walked: float | None
    """Time that they had walked when the clocks were reported, s; None when they were not."""
    reported: float | None
    """Offset that was reported first, s; None when none was, or one foot walked while the other one stood."""
    offset: float
    """Offset that was added to the times of the right foot, s."""
    undone: float | None
    """Largest error of the median step times and double supports once the reported offset is undone, s.

    None for a walker whose swings are uneven, and without an offset."""


def find_outcome(walk: ClockWalk, offset: float = 0.0, rate: float = 0.0, duration: float = 0.0) -> ClockOutcome:
    """Return what the part for clocks reports of a walk that is repeated to at least `duration`, s.

    The times of the right foot are shifted by `offset`, s, and stretched by 1 + `rate`."""
    damaged: list[FootEvent] = []
    spans = {foot: list[tuple[float, float]]() for foot in Foot}
    for number in range(max(1, ceil(duration / (walk.end + PAUSE)))):
        start = number * (walk.end + PAUSE)
        scales = {foot: (1.0 + rate, offset) if foot is Foot.RIGHT else (1.0, 0.0) for foot in Foot}
        for foot, (first, last) in walk.spans.items():
            scale, shift = scales[foot]
            spans[foot].append((scale * (start + first) + shift, scale * (start + last) + shift))
        for event in walk.events:
            scale, shift = scales[foot_of(event) or Foot.LEFT]
            names = ("t", "known_at", "t_start", "t_end") if isinstance(event, StrideTaken) else ("t", "known_at")
            damaged.append(evolve(event, **{name: scale * (start + getattr(event, name)) + shift for name in names}))
    part, reports, walked = FootClocks(), list[DefectFound](), None
    walking, contacts = dict.fromkeys(Foot, 0.0), dict[Foot, float]()
    for event in sorted(damaged, key=lambda event: event.known_at):
        if isinstance(event, HeelStrike):
            time = event.t - contacts.get(event.foot, -inf)
            if time < PAUSE:
                walking[event.foot] += time
            contacts[event.foot] = event.t
        if isinstance(event, GaitEvent):
            set_newest(part, event, spans)
        outputs = [*part.feed((event,), None), *part.finish(event.known_at)]
        if not reports and outputs:
            walked = min(walking.values())
        reports += [output for output in outputs if isinstance(output, DefectFound)]
    reported = reports[0].offset if reports else None
    undone = None if reported is None else error_between(walk, offset + reported)
    return ClockOutcome(min(walking.values()), walked, reported, offset, undone)


def set_newest(part: FootClocks, event: GaitEvent, spans: dict[Foot, list[tuple[float, float]]]) -> None:
    """Set the newest sample of the other foot at an event, as the views of the feet do in a session."""
    other = OTHER[event.foot]
    times = [min(event.known_at, last) for first, last in spans[other] if first <= event.known_at]
    part.lone.other_t, standing = max(times, default=None), part.lone.feet[other]
    if times and not standing.is_known:
        standing.is_known, standing.stood_since = True, times[-1]


def row(data: str, damage: str, outcomes: Sequence[ClockOutcome], limit: float) -> list[str]:
    """Return the cells of a row of the table; the clocks have to be reported within `limit` s of walking."""
    found = [(one.walked, one) for one in outcomes if one.walked is not None and one.walked <= limit]
    short = sum(one.walking < limit for one in outcomes)
    mirrored = [one for _, one in found if abs(one.offset) in OFFSETS]
    errors = [abs(one.reported + one.offset) for one in mirrored if one.reported is not None]
    undone = [one.undone for one in mirrored if one.undone is not None]
    return [
        data,
        damage,
        f"{len(found)} of {len(outcomes)}",
        str(short) if isfinite(limit) else "-",
        f"{median([walked for walked, _ in found]):.0f} s" if found else "-",
        *map(_errors, (errors, undone)),
    ]


def _errors(values: Sequence[float]) -> str:
    """Return median and 95th percentile of errors in s as text in ms."""
    if not values:
        return "-"
    return f"{1e3 * median(values):.0f} / {1e3 * float(np.percentile(values, 95)):.0f} ms"


HEADER = (
    "walks", "right foot's clock", "reported", "shorter than limit", "walked before, median",
    "offset wrong, median / 95 %", "step time, double support wrong once undone",
)  # fmt: skip


def find_jobs(folder: Path, names: Sequence[str]) -> list[ClockJob]:
    """Return a job for each recording of the data sets `names` in `folder`, and for the emulated walks."""
    jobs = [
        ClockJob(name, path.stem, path)
        for name in DATA_SETS
        if name in names
        for path in sorted((folder / name).glob("*.npz"))
    ]
    return jobs + [ClockJob(EMULATED, str(seed)) for seed in SEEDS if EMULATED in names]


def table(folder: Path, names: Sequence[str], processes: int) -> list[str]:
    """Return the lines of the table and of the lists below it."""
    read = run_jobs(read_walk, find_jobs(folder, names), processes=processes)
    walks = [(walk, find_outcome(walk)) for walk in read if isinstance(walk, ClockWalk)]
    scored = [walk for walk, usual in walks if usual.walking >= MIN_WALKING and not walk.is_known_apart]
    long = [walk for walk, usual in walks if usual.walking >= MINUTE and not walk.is_known_apart]
    groups = {"all": scored, "of a minute": long}
    rows = [row(name, "undamaged", list(map(find_outcome, group)), inf) for name, group in groups.items()]
    for size in OFFSETS + SECONDS_APART:
        text = f"{1e3 * size:.0f} ms" if size < 1.0 else f"{size:.0f} s"
        for name, group in groups.items():
            outcomes = [find_outcome(walk, sign * size) for walk in group for sign in (1.0, -1.0)]
            rows.append(row(name, f"{text} early or late", outcomes, MINUTE))
    outcomes = [find_outcome(walk, duration=LONG) for walk in long]
    rows.append(row("of a minute", "undamaged, ten minutes", outcomes, inf))
    outcomes = [find_outcome(walk, rate=sign * RATE, duration=LONG) for walk in long for sign in (1.0, -1.0)]
    rows.append(row("of a minute", "200 ppm fast or slow, ten minutes", outcomes, LONG))
    alarms = [walk.name for walk, usual in walks if usual.walked is not None and not walk.is_known_apart]
    few = sum(usual.walking < MIN_WALKING for _, usual in walks)
    return [
        *markdown.table(HEADER, rows, left=len(HEADER)),
        f"\nReported although undamaged: {', '.join(alarms) or 'none'}.",
        "\nKnown to have separate clocks, and not scored:\n",
        *[_apart(walk, usual) for walk, usual in walks if walk.is_known_apart],
        f"\n{few} recordings of both feet with less than {MIN_WALKING:.0f} s of walking are not scored, but searched "
        "for reports.",
    ]


def _apart(walk: ClockWalk, usual: ClockOutcome) -> str:
    """Return the line about a recording whose feet have separate clocks already."""
    result = "not reported" if usual.walked is None else "one foot walked while the other one stood"
    if usual.reported is not None:
        result = f"{1e3 * usual.reported:+.0f} ms reported"
    reason = KNOWN_APART.get(walk.job.data_set) or KNOWN_APART[walk.job.name]
    return f"- {walk.name}, {usual.walking:.0f} s of walking: {result}; {reason}"


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    names = options.only or [*DATA_SETS, EMULATED]
    print("\n".join(table(options.dir, names, options.processes)))
    return 0
