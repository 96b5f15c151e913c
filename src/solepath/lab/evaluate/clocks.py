"""The share of recordings with separate clocks of the feet that a session reports, and of the others that it reports.

    python -m solepath.lab.evaluate.clocks DIR [--only NAME] [--processes N]

prints a table as Markdown. DIR holds recorded data. The times of the right foot are shifted by an offset, or stretched
as by a clock that runs at another rate; recordings of at least a minute of walking, repeated to ten minutes, and
emulated walks of that length are stretched. The session receives the shifted samples. The recordings in `KNOWN_APART`
have separate clocks already; they are listed below the table with what is reported. The run takes about 30 minutes on
one processor."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from statistics import median

import numpy as np
from attrs import evolve, frozen

from ...calibration import Calibration
from ...emulate.walk import sampled
from ...emulate.wearers.gait import Wearer
from ...events import Defect, DefectFound, HeelStrike
from ...recording import RecordingError
from ...recording.samples import SampleRecording, load_samples
from ...session import Session
from ...types import SITE_OF_FOOT, Foot, Sample
from ..emulated.walks import insoles_of, long_walk
from ..processes import run_jobs
from .insoles import force_sensors, switches

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


@frozen
class ClockJob:
    """A recording, or an emulated walk, with the damage to the clock of its right foot."""

    data_set: str
    name: str
    path: Path | None
    """The recording; None for an emulated walk, whose seed is its name."""
    offset: float = 0.0
    """Offset that is added to the times of the right foot, s."""
    rate: float = 0.0
    """Relative difference of the rate of the right foot's clock."""
    duration: float = 0.0
    """Least duration to which the recording is repeated, s."""


@frozen
class ClockOutcome:
    """The report of the clocks in one run."""

    walking: float
    """Time that both feet walked in the whole run, s: that of the foot with fewer cycles."""
    walked: float | None
    """Time that it had walked when the clocks were reported, s; None when they were not."""
    offset: float | None
    """Offset that was reported first, s; None when none was."""


def run_job(job: ClockJob) -> ClockOutcome | str:
    """Run a job; return its outcome, or the reason why the recording cannot be used."""
    samples: Iterable[Sample]
    calibration = CALIBRATIONS.get(job.data_set, Calibration)()
    if job.path is None:
        seed = int(job.name)
        walk = sampled(long_walk(seed).walk(300.0), wearer=Wearer(), insoles=insoles_of(seed), seed=seed)
        samples = sorted([_shift(sample, job) for sample in walk.samples], key=lambda sample: sample.t)
    else:
        try:
            recording = load_samples(job.path)
        except RecordingError as error:
            return str(error)
        if len(recording.tables) < 2:
            return "one foot"
        _damage(recording, job)
        samples = recording
    session, reported, walked = Session(calibration=calibration), None, None
    walking, contacts = dict.fromkeys(Foot, 0.0), dict[Foot, float]()
    try:
        for sample in samples:
            for event in session.feed(sample):
                if isinstance(event, HeelStrike):
                    time = event.t - contacts.get(event.foot, -np.inf)
                    if time < PAUSE:
                        walking[event.foot] += time
                    contacts[event.foot] = event.t
                elif isinstance(event, DefectFound) and event.defect is Defect.CLOCKS and reported is None:
                    reported, walked = event.offset, min(walking.values())
    except RecordingError:
        pass  # the samples before the fault count
    return ClockOutcome(min(walking.values()), walked, reported)


def _shift(sample: Sample, job: ClockJob) -> Sample:
    if sample.site is not SITE_OF_FOOT[Foot.RIGHT]:
        return sample
    t = (1.0 + job.rate) * sample.t + job.offset
    return evolve(sample, t=t, known_at=t)


def _damage(recording: SampleRecording, job: ClockJob) -> None:
    """Repeat the recording to the job's duration and change the clock of the right foot."""
    start = min(float(table.t[0]) for table in recording.tables)
    period = max(float(table.t[-1]) for table in recording.tables) - start + 0.02
    count = max(1, int(np.ceil(job.duration / period)))
    for table in recording.tables:
        table.t = np.concatenate([table.t + period * number for number in range(count)])
        table.columns = {key: np.concatenate([column] * count) for key, column in table.columns.items()}
        if table.foot is Foot.RIGHT:
            table.t = (1.0 + job.rate) * table.t + job.offset


@frozen
class Row:
    """A row of the table: the outcomes of the runs of a data set with one damage."""

    data_set: str
    damage: str
    runs: list[tuple[ClockJob, ClockOutcome]]
    limit: float
    """Time of walking within which the clocks have to be reported, s."""

    def line(self) -> str:
        """Return the row as a line of Markdown."""
        found = [one for one in self.runs if one[1].walked is not None and one[1].walked <= self.limit]
        short = sum(outcome.walking < self.limit for _, outcome in self.runs)
        times = [outcome.walked for _, outcome in found if outcome.walked is not None]
        errors = [abs(error) for error in map(_error, found) if error is not None]
        cells = [
            self.data_set,
            self.damage,
            f"{len(found)} of {len(self.runs)}",
            str(short) if np.isfinite(self.limit) else "-",
            f"{median(times):.0f} s" if times else "-",
            f"{1e3 * median(errors):.0f} / {1e3 * float(np.percentile(errors, 95)):.0f} ms" if errors else "-",
        ]
        return f"| {' | '.join(cells)} |"


def _error(run: tuple[ClockJob, ClockOutcome]) -> float | None:
    """Return the error of the reported offset, s; None for clocks of different rates, whose offset changes."""
    job, outcome = run
    return None if outcome.offset is None or job.rate or not job.offset else outcome.offset + job.offset


HEADER = """\
| data | right foot's clock | reported | shorter than limit | walked before, median | offset wrong, median / 95 % |
|---|---|---|---|---|---|"""


def find_recordings(folder: Path, names: Sequence[str]) -> list[ClockJob]:
    """Return an undamaged job for each recording of the data sets `names` in `folder`."""
    chosen = [name for name in DATA_SETS if name in names]
    return [ClockJob(name, path.stem, path) for name in chosen for path in sorted((folder / name).glob("*.npz"))]


def is_known_apart(job: ClockJob) -> bool:
    """Return whether the feet of the recording have separate clocks already."""
    return job.data_set in KNOWN_APART or job.name in KNOWN_APART


def table(folder: Path, names: Sequence[str], processes: int) -> Iterator[str]:
    """Yield the lines of the table and of the lists below it."""
    run_all = partial(run_jobs, run_job, processes=processes)
    jobs = find_recordings(folder, names)
    emulated = [ClockJob(EMULATED, str(seed), None) for seed in SEEDS if EMULATED in names]
    undamaged = [(job, one) for job, one in zip(jobs, run_all(jobs), strict=True) if isinstance(one, ClockOutcome)]
    scored = [(job, one) for job, one in undamaged if one.walking >= MIN_WALKING and not is_known_apart(job)]
    yield HEADER
    data_sets = list(dict.fromkeys(job.data_set for job, _ in scored))
    for name in data_sets:
        yield Row(name, "undamaged", [one for one in scored if one[0].data_set == name], np.inf).line()
    yield Row("all", "undamaged", scored, np.inf).line()
    for size in OFFSETS:
        damaged = [evolve(job, offset=sign * size) for job, _ in scored for sign in (1.0, -1.0)]
        runs = [(job, one) for job, one in zip(damaged, run_all(damaged), strict=True) if isinstance(one, ClockOutcome)]
        for name in data_sets:
            of_set = [one for one in runs if one[0].data_set == name]
            yield Row(name, f"{1e3 * size:.0f} ms early or late", of_set, MINUTE).line()
        yield Row("all", f"{1e3 * size:.0f} ms early or late", runs, MINUTE).line()
    long = [evolve(job, duration=LONG) for job, one in scored if one.walking >= MINUTE] + emulated
    for rate, damage in ((0.0, "undamaged, repeated to 10 minutes"), (RATE, "200 ppm fast or slow")):
        stretched = [evolve(job, rate=sign * rate) for job in long for sign in ((1.0, -1.0) if rate else (1.0,))]
        outcomes = run_all(stretched)
        runs = [(job, one) for job, one in zip(stretched, outcomes, strict=True) if isinstance(one, ClockOutcome)]
        yield Row("recordings and emulated walks", damage, runs, LONG if rate else np.inf).line()
    yield "\nReported although undamaged:\n"
    alarms = [(job, one) for job, one in scored if one.offset is not None]
    yield from (f"- {job.data_set}/{job.name}: {1e3 * (one.offset or 0.0):+.0f} ms" for job, one in alarms)
    yield "- none" if not alarms else ""
    yield "\nKnown to have separate clocks, and not scored:\n"
    for job, one in undamaged:
        if is_known_apart(job):
            reported = "not reported" if one.offset is None else f"{1e3 * one.offset:+.0f} ms reported"
            reason = KNOWN_APART.get(job.data_set) or KNOWN_APART[job.name]
            yield f"- {job.data_set}/{job.name}, {one.walking:.0f} s of walking: {reported}; {reason}"
    few = sum(one.walking < MIN_WALKING for _, one in undamaged)
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
