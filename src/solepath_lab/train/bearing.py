"""Prints the weights of foot/bearing.py, learnt by a logistic regression over strides, and what they find and reject.

    solepath-lab train bearing DATA_DIR [--processes N]

The recordings are taken apart into strides without any check that the foot carries its walker. Strides of the data
sets of walks carry; those of bicycles, cars, chairs, elevators (`MOTIONS`) and of sensors that are on no foot do not.
Emulated patients and other motions are learnt too. Strides of both together have the same weight, and each kind of
recording that of the root of its number.

The tables show the share of strides that a session reports for each kind of recording, with weights that were learnt
without the wearer of the recording, and with weights that were learnt without any recording of its kind. A kind with
one wearer is parted by recordings instead. The chosen offset is the fitted one plus `MARGIN`."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from attrs import evolve, frozen
from numpy.typing import NDArray

from solepath import recipes
from solepath.cli.common.processes import run_jobs
from solepath.events import StrideTaken
from solepath.foot import bearing
from solepath.recording import RecordingError
from solepath.recording.samples import load_samples
from solepath.recording.samples.npz import read_arrays
from solepath.session import Session
from solepath.show.tables.table import table
from solepath.show.tables.words import activity_words
from solepath.types import Activity, Foot, Sample

from ..descriptions import read_description
from ..emulated import other_motions, slow_walkers
from ..evaluate.not_walking import MOTIONS
from ..measures.alarms import NOT_ON_FEET
from .hugadb import EIGHT_TIMES, LABELS, with_true_rates

Floats = NDArray[np.float64]

WALKS = (
    "felius_2min_walk", "gaitmap_examples", "gumushane_gcp", "hugadb", "hugadb_daily", "ipol_10m_uturn",
    "marpino_heel_toe", "moticon_opengo", "openshoe_loops", "pyshoe_vicon", "slow_gait", "smart_insole_35",
    "tripod_treadmill", "xio_closed_walks",
)  # fmt: skip
"""Data sets in which every stride without a label is one of a walk."""
LABELLED_TIME = 1.2
"""Longest time before a stride's end in whose middle its label is read, s: one cycle, because a rest may come first."""
SEEDS = range(101, 105)
"""Seeds of the emulated wearers; `solepath-lab emulated` scores others."""
RATES = (100.0, 50.0, 200.0, 20.0)
"""Sampling rates of the emulated wearers, in rotation, Hz."""
FOLDS = 8
"""Number of parts into which wearers are divided."""
MARGIN = 0.75
"""What is added to the fitted offset, a logarithm of a likelihood ratio.

It is in the middle of the columns of the tables between which few strides change: below it slow walks are lost, above
it pedals are found."""
OFFSETS = (-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0)
"""Changes of the chosen offset for which the tables have a column."""
ITERATIONS = 30
"""Steps of Newton's method; it converges in some ten."""
RIDGE = 1e-6
"""Weight of half the squared length of the standardised weights, against the mean loss of a stride."""


class Stride(NamedTuple):
    """A stride, the one before it in its bout, and whether its foot carries: None where that is not known."""

    taken: StrideTaken
    previous: StrideTaken | None
    kind: str
    carries: bool | None


@frozen
class Source:
    """A recording, or the emulated motion of a wearer, and where its samples come from."""

    kind: str
    """Name of the data set or of the emulated motion."""
    recording: str
    wearer: str
    """Name of the wearer; of the recording when it does not say who wore the sensors."""
    samples: Callable[[], Iterable[Sample]]
    carries: bool = True
    """Flag: feet carry wherever no label says otherwise."""
    path: Path | None = None
    """File with the labels, if there is one."""


@frozen
class StridesOfRecording:
    """The strides of one source, in their order of time for each foot."""

    recording: str
    wearer: str
    strides: tuple[Stride, ...] = ()


def sources_of(folder: Path) -> Iterator[Source]:
    """Yield the recordings of the folder's data sets, then the emulated wearers."""
    for name in (*WALKS, *NOT_ON_FEET):
        about = folder / name / "dataset.json"
        entries = read_description(about)["recordings"] if about.is_file() else {}
        for recording in sorted(entries):
            path = about.with_name(f"{recording}.npz")
            # the wearers of hugadb_daily are those of hugadb
            wearer = f"{name.removesuffix('_daily')} {entries[recording].get('subject', recording)}"
            read = partial(_read, path)
            yield Source(name, recording, wearer, read, name not in NOT_ON_FEET, path)
            if recording in EIGHT_TIMES:
                smaller = partial(_read, path, true_rates=True)
                yield Source(f"{name}, gyroscope / 8", recording, wearer, smaller, path=path)
    for seed in SEEDS:
        for motion in other_motions.MOTIONS:
            made = partial(other_motions.samples_of, motion, seed, RATES[seed % len(RATES)])
            yield Source(f"emulated: {motion.name}", f"{motion.name} {seed}", f"emulated {seed}", made, False)
        for gait in slow_walkers.GAITS:
            made = partial(slow_walkers.samples_of, gait, seed, RATES[seed % len(RATES)])
            yield Source(f"emulated: {gait.name}", f"{gait.name} {seed}", f"emulated {seed}", made)


def _read(path: Path, true_rates: bool = False) -> list[Sample]:
    """Return the samples of a recording, if wanted `with_true_rates`; none when it cannot be read."""
    try:
        samples = list(load_samples(path, report=lambda sentence: None))
    except (OSError, RecordingError):
        return []
    return with_true_rates(samples) if true_rates else samples


def collect(source: Source) -> StridesOfRecording:
    """Return all strides of a source."""
    session = Session(evolve(recipes.DEFAULT, name="every stride", every_stride=True))
    events = [event for sample in source.samples() for event in session.feed(sample)] + list(session.finish())
    truth = {} if source.path is None else read_arrays(source.path, lambda key: key in ("t", "activity"))
    last: dict[Foot, StrideTaken] = {}
    strides: list[Stride] = []
    for event in events:
        if isinstance(event, StrideTaken):
            previous = last.get(event.foot)
            if previous is not None and event.t_end - previous.t_end > bearing.LONGEST_WAIT:
                previous = None
            last[event.foot] = event
            strides.append(Stride(event, previous, *_kind(source, event, truth)))
    return StridesOfRecording(source.recording, source.wearer, tuple(strides))


def _kind(source: Source, stride: StrideTaken, truth: Mapping[str, NDArray[Any]]) -> tuple[str, bool | None]:
    """Return the kind of recording that the stride belongs to, and whether a foot carries in it."""
    if "activity" not in truth:
        return source.kind, source.carries
    middle = 0.5 * (max(stride.t_start, stride.t_end - LABELLED_TIME) + stride.t_end)
    code = int(truth["activity"][min(int(np.searchsorted(truth["t"], middle)), len(truth["t"]) - 1)])
    if code in MOTIONS:
        return f"{source.kind}, {MOTIONS[code]}", False
    activity = LABELS.get(code, Activity.UNKNOWN)
    # who stands may step aside
    carries = None if activity in (Activity.UNKNOWN, Activity.STANDING) else True
    return f"{source.kind}, {activity_words(activity)}", carries


def fit(rows: Floats, carries: Floats, weights: Floats) -> tuple[Floats, float]:
    """Return the weights of the features and the offset of a logistic regression, by Newton's method.

    `rows` (n, features), `carries` (n,) 1 or 0, `weights` (n,) with the sum 1."""
    mean, deviation = rows.mean(0), rows.std(0)
    x = np.column_stack([(rows - mean) / deviation, np.ones(len(rows))])
    found = np.zeros(x.shape[1])
    ridge = RIDGE * np.diag([*[1.0] * rows.shape[1], 0.0])
    for _ in range(ITERATIONS):
        chance = 1.0 / (1.0 + np.exp(-(x @ found)))
        slope = x.T @ (weights * (chance - carries)) + ridge @ found
        found = found - np.linalg.solve((x.T * (weights * chance * (1.0 - chance))) @ x + ridge, slope)
    scaled = found[:-1] / deviation
    return scaled, float(found[-1] - mean @ scaled)


def values(strides: Sequence[Stride]) -> Floats:
    """Return the features of strides, (n, features)."""
    before = [None if one.previous is None else bearing.StrideBefore.of(one.previous) for one in strides]
    return np.array([bearing.features(one.taken, previous) for one, previous in zip(strides, before, strict=True)])


def fit_strides(strides: Sequence[Stride], rows: Floats) -> tuple[Floats, float]:
    """Return the weights and the offset that strides teach which are known to be carried or not."""
    kinds, carries = np.array([one.kind for one in strides]), np.array([float(bool(one.carries)) for one in strides])
    names, index, counts = np.unique(kinds, return_inverse=True, return_counts=True)
    weights = 1.0 / np.sqrt(counts[index])
    for answer in (0.0, 1.0):
        weights[carries == answer] *= 0.5 / weights[carries == answer].sum()
    return fit(rows, carries, weights)


def reported(strides: Sequence[Stride], weights: Sequence[float], offset: float) -> list[bool]:
    """Return for each stride of a recording whether a session would report it with these weights."""
    feet: dict[Foot, bearing.Bearing] = {}
    found: set[tuple[Foot, float]] = set()
    kept = {name: vars(bearing)[name] for name in ("WEIGHTS", "OFFSET")}
    vars(bearing).update(WEIGHTS=tuple(weights), OFFSET=offset)
    try:
        for one in strides:
            known, _ = feet.setdefault(one.taken.foot, bearing.Bearing()).add(one.taken)
            found |= {(stride.foot, stride.t_end) for stride in known}
    finally:
        vars(bearing).update(kept)
    return [(one.taken.foot, one.taken.t_end) in found for one in strides]


def folds_of(recordings: Sequence[StridesOfRecording]) -> list[int]:
    """Return the fold of each recording: that of its wearer, or its own where a kind has one wearer."""
    wearers: dict[str, set[str]] = {}
    for recording in recordings:
        for one in recording.strides:
            wearers.setdefault(one.kind, set()).add(recording.wearer)
    groups = [
        one.recording if any(len(wearers[stride.kind]) == 1 for stride in one.strides) else one.wearer
        for one in recordings
    ]
    order = sorted(set(groups))
    return [order.index(group) % FOLDS for group in groups]


def shares(
    recordings: Sequence[StridesOfRecording], left_out: Callable[[int, Stride], Hashable]
) -> dict[tuple[bool, str], list[float]]:
    """Return the share of the strides that are reported, for each of `OFFSETS`, by (whether they carry, kind).

    `left_out` names the group of a stride, by the number of its recording. The weights that decide about a stride are
    learnt from the strides of all other groups."""
    known = [(k, one) for k, recording in enumerate(recordings) for one in recording.strides if one.carries is not None]
    groups = [left_out(k, one) for k, one in known]
    rows = values([one for _, one in known])
    counts: dict[tuple[bool, str], list[list[bool]]] = {}
    for group in dict.fromkeys(groups):
        kept = np.array([one != group for one in groups])
        weights, offset = fit_strides([one for (_, one), keep in zip(known, kept, strict=True) if keep], rows[kept])
        for k in dict.fromkeys([k for (k, _), one in zip(known, groups, strict=True) if one == group]):
            strides = recordings[k].strides
            found = [reported(strides, weights.tolist(), offset + MARGIN + change) for change in OFFSETS]
            for one, row in zip(strides, zip(*found, strict=True), strict=True):
                if one.carries is not None and left_out(k, one) == group:
                    counts.setdefault((one.carries, one.kind), []).append(list(row))
    return {key: [*np.mean(rows_of, axis=0).tolist(), len(rows_of)] for key, rows_of in sorted(counts.items())}


def share_table(title: str, found: Mapping[tuple[bool, str], Sequence[float]]) -> str:
    """Return the table of the shares of `shares`, in percent."""
    header = [title, "strides", *[f"{change:+g}" for change in OFFSETS]]
    rows = [
        [f"{'carries' if carries else 'does not'}: {kind}", str(n), *[f"{100.0 * one:.1f}" for one in row]]
        for (carries, kind), (*row, n) in found.items()
    ]
    return table(header, rows)


def released(recordings: Sequence[StridesOfRecording]) -> tuple[list[float], float]:
    """Return the weights and the offset, fitted to all strides and rounded as in foot/bearing.py."""
    known = [one for recording in recordings for one in recording.strides if one.carries is not None]
    weights, offset = fit_strides(known, values(known))
    return [float(f"{one:.2g}") for one in weights.tolist()], round(offset + MARGIN, 1)


def collected(folder: Path, processes: int) -> list[StridesOfRecording]:
    """Return the recordings of the folder, and the emulated ones, that have strides."""
    found = run_jobs(collect, list(sources_of(folder)), processes=processes)
    return [one for one in found if one.strides]


def run(options: Namespace) -> int:
    """Print the weights and the tables; return the exit status."""
    recordings = collected(options.dir, options.processes)
    weights, offset = released(recordings)
    print(f"OFFSET = {offset}\nWEIGHTS = {tuple(weights)}\n")
    folds = folds_of(recordings)
    print("Strides that are reported, %, by the change of the offset.\n")
    print(share_table("without the wearer", shares(recordings, lambda k, one: folds[k])), end="\n\n")
    print(share_table("without the kind", shares(recordings, lambda k, one: one.kind)))
    return 0
