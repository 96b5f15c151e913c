"""Recordings damaged on purpose: how many of the damages the default recipe reports, and its alarms on what is whole.

    solepath-lab damage sensors DIR [--processes N] [--only NAME] [--every N]

prints a table as Markdown. DIR holds recorded data. Of every foot with at least 15 s of walking,
the first 20 s from three strides in a row on are damaged, with up to 3 s before them. Whole recordings are searched for
alarms. A sensor that clips, repeats its values or does not close in the recording itself is listed in
measures/alarms.py. The run takes about 15 minutes on two processors;
`--every 4` examines one in four feet."""

from __future__ import annotations

from argparse import Namespace
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from statistics import median

import numpy as np
from attrs import frozen

from solepath.body.checks.stances import StanceFinder
from solepath.cli.common.processes import run_jobs
from solepath.events import Defect, DefectFound
from solepath.recording import RecordingError
from solepath.recording.samples import load_samples
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Sample, Vec3
from solepath.types.vector import GRAVITY
from solepath.validate.alignment import Floats

from ..measures.alarms import KNOWN, NOT_ON_FEET, NOT_WALKING, alarms
from ..tables import markdown

MS = 1e3
"""Number of ms in a second."""
BEFORE, WALKING, LEAST_WALKING = 3.0, 20.0, 15.0
"""Time kept before the first stride, time of walking that is damaged, and the least that counts, s."""
LIMITS, BEYOND = np.array([np.inf, *[2.0 * GRAVITY] * 3, *[np.radians(250.0)] * 3]), 1.05
"""Limits of time and of a sensor that clips, s, m/s^2 and rad/s, and part of its range that motion must exceed."""
CORRECTION_RATE = 0.5
"""Rate at which the device that removes gravity pulls its attitude towards the specific force, 1/s."""
AXES = np.eye(3)
TILT = float(np.radians(10.0))
"""Angle by which the accelerometer is turned against the gyroscope, rad."""
SEED = 19
"""Seed of the rotations of the whole sensor."""

Make = Callable[[Floats], Floats]
"""Function of undamaged samples, (n,7): time, s, specific force, m/s^2, and angular rate, rad/s."""


@frozen
class Damage:
    """A damage, and the defect that has to be reported."""

    name: str
    defect: Defect | None
    """None when nothing has to be reported."""
    make: Make
    changes: Callable[[Floats], bool] = lambda samples: True
    """Function of the undamaged samples that returns whether the damage changes them."""


@frozen
class WalkingFoot:
    """The walking of one foot in a recording."""

    path: Path
    foot: Foot


@frozen
class DefectOutcome:
    """The defects that were reported for one foot of a recording."""

    piece: WalkingFoot
    whole: tuple[DefectFound, ...] = ()
    """Those of the whole recording."""
    damaged: tuple[tuple[str, bool, float | None, tuple[str, ...]], ...] = ()
    """For each damage: name, reported or not, time since the first stride, s, and names of all that was reported."""


def remove_gravity(samples: Floats) -> Floats:
    """Return what a device sends that subtracts gravity by its own attitude, in its own frame, m/s^2."""
    removed, t = samples.copy(), samples[:, 0]
    up = samples[: max(1, int(np.searchsorted(t, t[0] + 0.5))), 1:4].mean(axis=0)
    up /= np.linalg.norm(up)
    for row, dt in zip(removed, np.diff(t, prepend=t[0]), strict=True):
        up = up - np.cross(row[4:] * dt, up)
        norm = float(np.linalg.norm(row[1:4]))
        if norm > 0.0:
            up = up + CORRECTION_RATE * dt * (row[1:4] / norm - up)
        up /= np.linalg.norm(up)
        row[1:4] -= GRAVITY * up
    return removed


def _rotation(axis: Sequence[float], angle: float) -> Floats:
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation: Floats = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return rotation


def _linear(acc: Floats = AXES, gyro: Floats = AXES, time: float = 1.0) -> Make:
    """Return the function that multiplies time, specific force and angular rate by a number and matrices."""
    matrix = np.diag([time, *[0.0] * 6])
    matrix[1:4, 1:4], matrix[4:, 4:] = acc, gyro
    return lambda samples: samples @ matrix.T


def _held(columns: slice) -> Make:
    """Return the function that repeats values as of a sensor that measures at half the rate: each one twice."""

    def hold(samples: Floats) -> Floats:
        held = samples.copy()
        held[:, columns] = samples[np.arange(len(samples)) // 2 * 2, columns]
        return held

    return hold


def _damages() -> Iterator[Damage]:
    changed = {f"{name} mirrored": AXES - 2.0 * np.outer(axis, axis) for name, axis in zip("xyz", AXES, strict=True)}
    for a, b in ((0, 1), (0, 2), (1, 2)):
        order = [b if k == a else a if k == b else k for k in range(3)]
        changed[f"{'xyz'[a]} and {'xyz'[b]} exchanged"] = AXES[order]
    for name, matrix in changed.items():
        yield Damage(f"gyroscope {name}", Defect.AXES, _linear(gyro=matrix))
        yield Damage(f"accelerometer {name}", Defect.AXES, _linear(acc=matrix))
    yield Damage("specific force in g", Defect.ACC_UNIT, _linear(acc=AXES / GRAVITY))
    yield Damage("angular rate in deg/s", Defect.GYRO_UNIT, _linear(gyro=np.degrees(AXES)))
    yield Damage("times in ms", Defect.TIME_UNIT, _linear(time=MS))
    for factor, words in ((1.5, "long"), (1.0 / 1.5, "short")):
        yield Damage(f"times 1.5 times too {words}", Defect.CONTRADICTION, _linear(time=factor))
    yield Damage("gravity removed", Defect.NO_GRAVITY, remove_gravity)
    yield Damage(
        "clipped at 2 g and 250 deg/s",
        Defect.CLIPPED,
        lambda samples: np.clip(samples, -LIMITS, LIMITS),
        lambda samples: bool((np.abs(samples) > BEYOND * LIMITS).any()),
    )
    yield Damage("half the rate, both repeated", Defect.REPEATED, _held(slice(1, 7)))
    yield Damage("half the rate, accelerometer alone", Defect.REPEATED, _held(slice(1, 4)))
    yield Damage("half the rate, gyroscope alone", Defect.REPEATED, _held(slice(4, 7)))
    tilt = _rotation((1.0, 1.0, 0.0), TILT)
    yield Damage("accelerometer turned by 10 degrees", Defect.AXES, _linear(acc=tilt))
    random = np.random.default_rng(SEED)
    for number in (1, 2):
        turn = _rotation(random.normal(size=3).tolist(), random.uniform(0.0, np.pi))
        yield Damage(f"whole sensor turned, {number}", None, _linear(turn, turn))


def _rows(samples: Floats) -> list[tuple[float, Vec3, Vec3]]:
    return [(t, (a, b, c), (x, y, z)) for t, a, b, c, x, y, z in samples.tolist()]


def _reported(samples: Floats, foot: Foot) -> list[DefectFound]:
    """Return the defects that a session of the default recipe reports while the samples come, not at their end."""
    session, site = Session(), SITE_OF_FOOT[foot]
    events = [event for row in _rows(samples) for event in session.feed(Sample(row[0], site, row[1], row[2]))]
    return [event for event in events if isinstance(event, DefectFound)]


def examine(piece: WalkingFoot) -> DefectOutcome | None:
    """Return what is reported of one foot, whole and damaged; None of no foot, and of one with less than 4 strides."""
    (table,) = [table for table in load_samples(piece.path).tables if table.foot is piece.foot]
    samples = np.column_stack([table.t, *table.columns["acc"], *table.columns["gyro"]])
    strides = [(time, stride) for time, stride in StanceFinder().add(_rows(samples)) if len(stride.intervals) > 1]
    if len(strides) < 4 or piece.path.parent.name in NOT_ON_FEET:
        return None
    whole = tuple(_reported(samples, piece.foot))
    walks = [all([stride.walked for _, stride in strides[i + 1 : i + 3]]) for i in range(len(strides) - 2)]
    if True not in walks or piece.path.parent.name in NOT_WALKING:
        return DefectOutcome(piece, whole)
    known_at, first_stride = strides[walks.index(True)]
    start = known_at - first_stride.duration
    t = samples[:, 0]
    samples = samples[(t >= start - BEFORE) & (t <= start + WALKING)]
    if samples[-1, 0] - start < LEAST_WALKING:
        return DefectOutcome(piece, whole)
    known = KNOWN.get(piece.path.parent.name, set())
    outcomes = []
    for damage in _damages():
        if damage.defect in known or not damage.changes(samples):
            continue
        if damage.defect is None and Defect.CLIPPED in known:
            continue  # once turned, cut peaks no longer end at the range of an axis, which no sensor does
        found = _reported(damage.make(samples), piece.foot)
        names = tuple([event.defect.name for event in found if event.defect not in known])
        unit = float(damage.make(samples[-1:])[0, 0] / samples[-1, 0])
        first = next((event.t / unit for event in found if event.defect is damage.defect), None)
        hit = not names if damage.defect is None else first is not None
        outcomes.append((damage.name, hit, None if first is None else first - start, names))
    return DefectOutcome(piece, whole, tuple(outcomes))


def pieces(folder: Path, only: Sequence[str] = ()) -> list[WalkingFoot]:
    """Return the feet with accelerometer and gyroscope in the recordings of a folder of data sets."""
    found = []
    for path in sorted(folder.glob("*/*.npz")):
        if only and path.parent.name not in only:
            continue
        try:
            tables = load_samples(path, report=lambda sentence: None).tables
        except RecordingError:
            continue
        found += [WalkingFoot(path, table.foot) for table in tables if {"acc", "gyro"} <= set(table.columns)]
    return found


def table(outcomes: Sequence[DefectOutcome]) -> list[str]:
    """Return the lines of the page: alarms on what is whole, and the table of damages."""
    raised = [
        (outcome, event) for outcome in outcomes for event in alarms(outcome.piece.path.parent.name, outcome.whole)
    ]
    share = 100.0 * len({outcome.piece for outcome, _ in raised}) / max(1, len(outcomes))
    lines = [f"Alarms on {len(outcomes)} undamaged feet, without the known defects: {share:.1f} %."]
    lines += [
        f"- {outcome.piece.path.parent.name}/{outcome.piece.path.stem}, {outcome.piece.foot}: {event.what}"
        for outcome, event in raised
    ]
    rows = []
    for damage in _damages():
        found = [row for outcome in outcomes for row in outcome.damaged if row[0] == damage.name]
        if not found:
            continue
        hits = [row for row in found if row[1]]
        delays = [row[2] for row in hits if row[2] is not None]
        wanted = damage.defect and damage.defect.name
        others = Counter(name for row in found for name in row[3] if name != wanted)
        words = ", ".join(f"{name.lower().replace('_', ' ')} {count}" for name, count in others.most_common())
        silent = "silent " * (damage.defect is None)
        share = 100.0 * len(hits) / len(found)
        after = f"{median(delays):.1f} s" if delays else "-"
        rows.append((damage.name, len(found), f"{silent}{share:.1f} %", after, words or "-"))
    header = ("damage", "feet", "reported", "after, median", "what else is reported")
    return [*lines, "", *markdown.table(header, rows, left=len(header))]


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    found = run_jobs(examine, pieces(options.dir, options.only)[:: options.every], processes=options.processes)
    print("\n".join(table([outcome for outcome in found if outcome is not None])))
    return 0
