"""The share of recordings with separate clocks of the feet that a session reports, and of the others that it reports.

    python -m solepath.lab.damage.clocks DIR [--only NAME] [--processes N]

prints a table as Markdown. DIR holds recorded data. The times of the right foot's events are shifted by an offset, or
stretched as by a clock that runs at another rate. A foot's events do not depend on the other foot's clock, so the
samples are processed once. Walks of at least a minute are repeated to ten minutes for clocks of different rates. The
recordings in `KNOWN_APART` have separate clocks already; they are listed below the table with what is reported. The run
takes two minutes on one processor."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Sequence
from math import ceil, inf, isfinite
from pathlib import Path
from statistics import median

import numpy as np
from attrs import evolve, frozen

from ...body.checks.clocks import FootClocks
from ...calibration import Calibration
from ...emulate.walk import sampled
from ...emulate.wearers.gait import Wearer
from ...events import DefectFound, Event, FootFlat, HeelStrike, SampleGap, ToeOff
from ...recording import RecordingError
from ...recording.samples import load_samples
from ...session import Session
from ...types import Foot, Sample
from ..emulated.walks import insoles_of, long_walk
from ..evaluate.insoles import force_sensors, switches
from ..processes import run_jobs

OFFSETS = (0.05, 0.1, 0.2, 0.3, 0.5)
"""Sizes of the offsets, s; each is added and subtracted."""
RATE = 200e-6
"""Relative difference of the rates of two clocks, of which each may be wrong by 100 ppm."""
LONG = 600.0
"""Duration of a walk with clocks of different rates, s."""
MIN_WALKING = 12.0
"""Least time of walking of a recording that is scored, s; an offset needs ten steps of each foot without a fault."""
MINUTE = 60.0
"""Time of walking within which an offset has to be reported, s."""
PAUSE = 2.5
"""Time between two contacts of a foot above which the wearer did not walk, s."""
SEEDS = (201, 202)
"""Seeds of the emulated walks."""
DATA_SETS = (
    "ipol_10m_uturn", "tripod_treadmill", "gaitmap_examples", "marpino_heel_toe", "gaitpdb_vgrf", "hugadb",
    "felius_2min_walk", "moticon_opengo", "smart_insole_35",
)  # fmt: skip
"""Folders of the data sets with recordings of both feet."""
EMULATED = "emulated"
KNOWN_APART = {
    "tripod_treadmill": "the light barrier of the treadmill shows 75 ms in PWS and 19 ms in PWS_minus20",
    "felius_2min_walk": "the sensors have no common clock",
    "smart_insole_35": "each stream is stamped from its own start, and they start 60 to 290 ms apart",
    "ms_patient": "the feet are not synchronised, says the source",
}
"""Data sets and recordings whose feet have separate clocks, and the reason."""
CALIBRATIONS = {"marpino_heel_toe": switches, "gaitpdb_vgrf": force_sensors}
"""Functions that return the calibration of a data set's insoles."""


FootEvent = HeelStrike | ToeOff | FootFlat | SampleGap


@frozen
class ClockJob:
    """A recording of both feet, or an emulated walk."""

    data_set: str
    name: str
    path: Path | None = None
    """The recording; None for an emulated walk, whose seed is its name."""


@frozen
class ClockWalk:
    """The events of both feet in a walk."""

    job: ClockJob
    events: tuple[FootEvent, ...]
    end: float
    """Time of the last sample, s."""

    @property
    def is_known_apart(self) -> bool:
        """True if the feet have separate clocks already."""
        return self.job.data_set in KNOWN_APART or self.job.name in KNOWN_APART


def read_walk(job: ClockJob) -> ClockWalk | str:
    """Return the events of a walk, or the reason why the recording cannot be used."""
    calibration = CALIBRATIONS.get(job.data_set, Calibration)()
    session, events = Session(calibration=calibration), list[Event]()
    samples: Iterable[Sample]
    if job.path is None:
        seed = int(job.name)
        samples = sampled(long_walk(seed).walk(300.0), wearer=Wearer(), insoles=insoles_of(seed), seed=seed).samples
    else:
        try:
            recording = load_samples(job.path)
        except RecordingError as error:
            return str(error)
        if len(recording.tables) < 2:
            return "one foot"
        samples = recording
    try:
        for sample in samples:
            events += session.feed(sample)
    except RecordingError:
        pass  # the samples before the fault count
    return ClockWalk(job, tuple([event for event in events if isinstance(event, FootEvent)]), session.now or 0.0)


@frozen
class ClockOutcome:
    """The report of the clocks in one walk, with damage to the clock of the right foot."""

    walking: float
    """Time that both feet walked in the whole walk, s: that of the foot with fewer cycles."""
    walked: float | None
    """Time that they had walked when the clocks were reported, s; None when they were not."""
    reported: float | None
    """Offset that was reported first, s; None when none was."""
    offset: float
    """Offset that was added to the times of the right foot, s."""


def find_outcome(walk: ClockWalk, offset: float = 0.0, rate: float = 0.0, duration: float = 0.0) -> ClockOutcome:
    """Return what the part for clocks reports of a walk that is repeated to at least `duration`, s.

    The times of the right foot are shifted by `offset`, s, and stretched by 1 + `rate`."""
    damaged: list[FootEvent] = []
    for number in range(max(1, ceil(duration / (walk.end + PAUSE)))):
        start = number * (walk.end + PAUSE)
        for event in walk.events:
            foot = event.site.foot if isinstance(event, SampleGap) else event.foot
            scale, shift = (1.0 + rate, offset) if foot is Foot.RIGHT else (1.0, 0.0)
            t, known_at = scale * (start + event.t) + shift, scale * (start + event.known_at) + shift
            damaged.append(evolve(event, t=t, known_at=known_at))
    part, reported, walked = FootClocks(), None, None
    walking, contacts = dict.fromkeys(Foot, 0.0), dict[Foot, float]()
    for event in sorted(damaged, key=lambda event: event.known_at):
        if isinstance(event, HeelStrike):
            time = event.t - contacts.get(event.foot, -inf)
            if time < PAUSE:
                walking[event.foot] += time
            contacts[event.foot] = event.t
        for output in part.receive(event):
            if isinstance(output, DefectFound) and reported is None:
                reported, walked = output.offset, min(walking.values())
    return ClockOutcome(min(walking.values()), walked, reported, offset)


def row(data: str, damage: str, outcomes: Sequence[ClockOutcome], limit: float) -> str:
    """Return a row of the table as Markdown; the clocks have to be reported within `limit` s of walking."""
    found = [(one.walked, one) for one in outcomes if one.walked is not None and one.walked <= limit]
    short = sum(one.walking < limit for one in outcomes)
    errors = [abs(one.reported + one.offset) for _, one in found if one.reported is not None and one.offset]
    cells = [
        data,
        damage,
        f"{len(found)} of {len(outcomes)}",
        str(short) if isfinite(limit) else "-",
        f"{median([walked for walked, _ in found]):.0f} s" if found else "-",
        f"{1e3 * median(errors):.0f} / {1e3 * float(np.percentile(errors, 95)):.0f} ms" if errors else "-",
    ]
    return f"| {' | '.join(cells)} |"


HEADER = """\
| data | right foot's clock | reported | shorter than limit | walked before, median | offset wrong, median / 95 % |
|---|---|---|---|---|---|"""


def find_jobs(folder: Path, names: Sequence[str]) -> list[ClockJob]:
    """Return a job for each recording of the data sets `names` in `folder`, and for the emulated walks."""
    jobs = [
        ClockJob(name, path.stem, path)
        for name in DATA_SETS
        if name in names
        for path in sorted((folder / name).glob("*.npz"))
    ]
    return jobs + [ClockJob(EMULATED, str(seed)) for seed in SEEDS if EMULATED in names]


def table(folder: Path, names: Sequence[str], processes: int) -> Iterator[str]:
    """Yield the lines of the table and of the lists below it."""
    walks = [
        one for one in run_jobs(read_walk, find_jobs(folder, names), processes=processes) if isinstance(one, ClockWalk)
    ]
    usual = {walk.job: find_outcome(walk) for walk in walks}
    scored = [walk for walk in walks if usual[walk.job].walking >= MIN_WALKING and not walk.is_known_apart]
    data_sets = {name: [walk for walk in scored if walk.job.data_set == name] for name in DATA_SETS + (EMULATED,)}
    groups = {name: of_set for name, of_set in data_sets.items() if of_set} | {"all": scored}
    long = [walk for walk in scored if usual[walk.job].walking >= MINUTE]
    groups |= {"all of a minute": long}
    yield HEADER
    for name, of_group in groups.items():
        yield row(name, "undamaged", [usual[walk.job] for walk in of_group], inf)
    for size in OFFSETS:
        for name, of_group in groups.items():
            outcomes = [find_outcome(walk, sign * size) for walk in of_group for sign in (1.0, -1.0)]
            yield row(name, f"{1e3 * size:.0f} ms early or late", outcomes, MINUTE)
    yield row("all of a minute", "undamaged, ten minutes", [find_outcome(walk, duration=LONG) for walk in long], inf)
    outcomes = [find_outcome(walk, rate=sign * RATE, duration=LONG) for walk in long for sign in (1.0, -1.0)]
    yield row("all of a minute", "200 ppm fast or slow, ten minutes", outcomes, LONG)
    alarms = [walk.job for walk in scored if usual[walk.job].reported is not None]
    yield (
        "\nReported although undamaged: " + (", ".join(f"{job.data_set}/{job.name}" for job in alarms) or "none") + "."
    )
    yield "\nKnown to have separate clocks, and not scored:\n"
    for walk in walks:
        if walk.is_known_apart:
            job, one = walk.job, usual[walk.job]
            result = "not reported" if one.reported is None else f"{1e3 * one.reported:+.0f} ms reported"
            reason = KNOWN_APART.get(job.data_set) or KNOWN_APART[job.name]
            yield f"- {job.data_set}/{job.name}, {one.walking:.0f} s of walking: {result}; {reason}"
    few = sum(one.walking < MIN_WALKING for one in usual.values())
    yield f"\n{few} recordings of both feet with less than {MIN_WALKING:.0f} s of walking are not scored."


def main() -> None:
    """Print the table."""
    options = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    options.add_argument("dir", metavar="DIR", type=Path)
    options.add_argument("--only", metavar="NAME", action="append", default=[], help="only this data set")
    options.add_argument("--processes", metavar="N", type=int, default=1)
    chosen = options.parse_args()
    for line in table(chosen.dir, chosen.only or [*DATA_SETS, EMULATED], chosen.processes):
        print(line, flush=True)


if __name__ == "__main__":
    main()
