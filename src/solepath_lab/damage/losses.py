"""Losses cut into recordings: how far lengths of strides err, how sure the session is, and which it calls flawed.

    solepath-lab damage losses DIR [--processes N]

prints tables as Markdown, one for each data set of DIR whose true lengths are known: walks that a
motion-capture lab filmed (pyshoe_vicon), where the marker gives the length between the two foot-flats of every stride
that is found, and walks whose every footprint was surveyed (gumushane_surveyed). Losses are drawn from the recording's
name: single samples at random, and bursts 1.5 to 4 s apart.

The numbers of gaps (foot/stride.py, foot/navigate/error_state.py, events/foot.py) were chosen by hand on the first
eight walks of pyshoe_vicon. gumushane_surveyed was not looked at."""

from __future__ import annotations

import random
from argparse import Namespace
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from solepath import Sample, Session, StrideTaken
from solepath.cli.common.failure import Failure
from solepath.cli.common.processes import run_jobs
from solepath.recording.samples import load_samples
from solepath.validate.alignment import Floats, at_times

from ..evaluate.jobs import find_data_sets, recordings
from ..evaluate.run import Arrays, truth_of
from ..measures.strides import END_TOLERANCE
from ..tables import markdown

DATA_SETS = ("pyshoe_vicon", "gumushane_surveyed")
SHARES = (0.0, 0.03, 0.1)
"""Shares of single samples that are lost."""
BURSTS = (0.05, 0.1, 0.2, 0.4, 0.8)
"""Durations of the bursts that are lost, s."""
BETWEEN_BURSTS = (1.5, 4.0)
"""Shortest and longest time between two bursts, s."""
HEADER = (
    "lost", "strides", "missing %", "mean error m", "within 1 sigma %", "within 2 sigma %", "with flaws %",
    "error with flaws m", "without m",
)  # fmt: skip


ScoredStride = tuple[str, float, StrideTaken]
"""What was lost, in words, magnitude of the error of a stride's length, m, and the stride."""


def damaged(samples: Sequence[Sample], seed: str) -> Iterator[tuple[str, list[Sample]]]:
    """Yield what is lost, in words, and the samples that remain."""
    for share in SHARES:
        drawn = random.Random(f"{seed} {share}")
        yield f"{100.0 * share:g} % of the samples", [one for one in samples if drawn.random() >= share]
    for duration in BURSTS:
        drawn = random.Random(f"{seed} {duration}")
        start, kept = samples[0].t + drawn.uniform(*BETWEEN_BURSTS), list[Sample]()
        for one in samples:
            if one.t >= start + duration:
                start = one.t + drawn.uniform(*BETWEEN_BURSTS)
            if one.t < start:
                kept.append(one)
        yield f"bursts of {1e3 * duration:g} ms", kept


def true_places(truth: Arrays, times: Floats) -> Floats:
    """Return the true place (n,2), m, of a foot that lay flat at `times` (n,), s."""
    if "gt_pos" in truth:
        return at_times(truth["t"], truth["gt_pos"][:, :2], times)
    ends, footprints = truth["t"][truth["gt_stride_index"]], truth["gt_stride_xy"]  # a foot-flat is early in its stance
    k = np.searchsorted(ends, times - END_TOLERANCE)
    return np.asarray(footprints[np.minimum(k, len(ends) - 1), :2], np.float64)


def examine(path: Path) -> list[ScoredStride]:
    """Return the strides of a recording with each kind of loss."""
    truth, samples = truth_of(path), list(load_samples(path))
    scored = []
    for loss, kept in damaged(samples, path.stem):
        session = Session()
        events = [event for sample in kept for event in session.feed(sample)] + session.finish()
        for stride in events:
            if isinstance(stride, StrideTaken) and stride.final:
                ends = np.array([stride.t_start, stride.t_end])
                start, end = true_places(truth, ends)
                error = abs(stride.length - float(np.linalg.norm(end - start)))
                scored.append((loss, error, stride))
    return scored


def table(strides: Sequence[ScoredStride]) -> list[str]:
    """Return the lines of the table: a row for each kind of loss, and one for all."""
    rows = []
    for loss in [*dict.fromkeys(loss for loss, _, _ in strides), "all"]:
        of_loss = [(error, stride) for name, error, stride in strides if loss in (name, "all")]
        flawed = [error for error, stride in of_loss if stride.flaws]
        sound = [error for error, stride in of_loss if not stride.flaws]
        known: list[list[float]] = [
            [stride.missing for _, stride in of_loss],
            *[[float(error <= factor * one.length_sigma) for error, one in of_loss] for factor in (1.0, 2.0)],
            [bool(stride.flaws) for _, stride in of_loss],
        ]
        percents = [f"{100.0 * np.mean(values):.1f}" for values in known]
        means = [f"{np.mean(errors):.3f}" if errors else "-" for errors in ([*flawed, *sound], flawed, sound)]
        rows.append((loss, len(of_loss), percents[0], means[0], *percents[1:], *means[1:]))
    return markdown.table(HEADER, rows)


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    present = [one for one in find_data_sets(options.dir) if one.name in DATA_SETS]
    if not present:
        raise Failure(f"{options.dir}: has none of {', '.join(DATA_SETS)}")
    for data_set in present:
        paths = [path for path, _ in recordings(options.dir, data_set)]
        found = run_jobs(examine, paths, processes=options.processes)
        title = f"{data_set.name}: {len(paths)} walks"
        print("\n".join([title, "", *table([stride for strides in found for stride in strides]), ""]), flush=True)
    return 0
