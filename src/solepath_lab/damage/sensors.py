"""Recordings damaged on purpose: how many of the damages the default recipe reports, and its alarms on what is whole.

    solepath-lab damage sensors DIR [--processes N] [--only NAME]

prints the table of docs/checks.md as Markdown. DIR holds recorded data. Of every foot with at least 15 s of walking,
the first 20 s of walking are damaged, with up to 3 s before them. Whole recordings are searched for alarms. A sensor
that clips, repeats its values or does not close in the recording itself is listed in KNOWN. The run takes about 15
minutes on two processors."""

from __future__ import annotations

from argparse import Namespace
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from attrs import frozen

from solepath.body.checks.stances import StanceFinder
from solepath.events import Defect, DefectFound, Event
from solepath.recording import RecordingError
from solepath.recording.samples import load_samples
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Sample, Vec3
from solepath.types.vector import GRAVITY
from solepath.validate.alignment import Floats

from .. import markdown
from ..options import add_command, add_folder, add_only, add_processes
from ..processes import run_jobs

KNOWN: dict[str, set[Defect]] = {
    "felius_2min_walk": {Defect.AXES},
    "hugadb": {Defect.CLIPPED},
    "smart_insole_35": {Defect.REPEATED},
    "xio_closed_walks": {Defect.CLIPPED},
}
"""Defects that recordings of these data sets have.

They are an accelerometer that clips at 2 g (hugadb) or 8 g (xio), values that are repeated (smart_insole_35), and a
left foot whose strides close best with all axes of one sensor reversed, and then badly (felius)."""
MS = 1e3
"""Number of ms in a second."""
BEFORE, WALKING, LEAST_WALKING = 3.0, 20.0, 15.0
"""Time kept before the first stride, time of walking that is damaged, and the least that counts, s."""
CLIP_ACC, CLIP_GYRO, BEYOND = 2.0 * GRAVITY, float(np.radians(250.0)), 1.05
"""Ranges of the sensor that clips, m/s^2 and rad/s, and part of them that the motion must exceed for it to be cut."""
CORRECTION_RATE = 0.5
"""Rate at which the device that removes gravity pulls its attitude towards the specific force, 1/s."""
TILT = float(np.radians(10.0))
"""Angle by which the accelerometer is turned against the gyroscope, rad."""
SEED = 19
"""Seed of the rotations of the whole sensor."""

Damaged = tuple[Floats, Floats, Floats]
"""Times, (n,), s, specific force, (n,3), m/s^2, and angular rate, (n,3), rad/s."""
Make = Callable[[Floats, Floats, Floats], Damaged]
"""Function of undamaged times, specific force and angular rate."""


@frozen
class Damage:
    """A damage, and the defect that has to be reported."""

    name: str
    defect: Defect | None
    """None when nothing has to be reported."""
    make: Make
    changes: Callable[[Floats, Floats], bool] = lambda acc, gyro: True
    """Function of the undamaged values that returns whether the damage changes them."""


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


Change = Callable[[Floats], Floats]
"""Function of the values of one sensor."""


def _hold(values: Floats) -> Floats:
    """Return the values of a sensor that measures at half the rate: each one twice."""
    return values[np.arange(len(values)) // 2 * 2]


def remove_gravity(t: Floats, acc: Floats, gyro: Floats) -> Floats:
    """Return what a device sends that subtracts gravity by its own attitude, in its own frame, m/s^2."""
    up = acc[: max(1, int(np.searchsorted(t, t[0] + 0.5)))].mean(axis=0)
    up /= np.linalg.norm(up)
    removed = np.empty_like(acc)
    for i, dt in enumerate(np.diff(t, prepend=t[0])):
        up = up - np.cross(gyro[i] * dt, up)
        norm = float(np.linalg.norm(acc[i]))
        if norm > 0.0:
            up = up + CORRECTION_RATE * dt * (acc[i] / norm - up)
        up /= np.linalg.norm(up)
        removed[i] = acc[i] - GRAVITY * up
    return removed


def _rotation(axis: Sequence[float], angle: float) -> Floats:
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation: Floats = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return rotation


def _same(values: Floats) -> Floats:
    return values


def _with(acc: Change = _same, gyro: Change = _same) -> Make:
    return lambda t, a, g: (t, acc(a), gyro(g))


def _by(matrix: Floats) -> Change:
    """Return the function that multiplies each value by a matrix, (3,3)."""
    return lambda values: values @ matrix.T


def _damages() -> Iterator[Damage]:
    axes = np.eye(3)
    changed = {f"{name} mirrored": axes - 2.0 * np.outer(axis, axis) for name, axis in zip("xyz", axes, strict=True)}
    changed |= {
        f"{'xyz'[a]} and {'xyz'[b]} exchanged": axes[[b if k == a else a if k == b else k for k in range(3)]]
        for a, b in ((0, 1), (0, 2), (1, 2))
    }
    for name, matrix in changed.items():
        yield Damage(f"gyroscope {name}", Defect.AXES, _with(gyro=_by(matrix)))
        yield Damage(f"accelerometer {name}", Defect.AXES, _with(acc=_by(matrix)))
    yield Damage("specific force in g", Defect.ACC_UNIT, lambda t, a, g: (t, a / GRAVITY, g))
    yield Damage("angular rate in deg/s", Defect.GYRO_UNIT, lambda t, a, g: (t, a, np.degrees(g)))
    yield Damage("times in ms", Defect.TIME_UNIT, lambda t, a, g: (MS * t, a, g))
    yield Damage("gravity removed", Defect.NO_GRAVITY, lambda t, a, g: (t, remove_gravity(t, a, g), g))
    yield Damage(
        "clipped at 2 g and 250 deg/s",
        Defect.CLIPPED,
        lambda t, a, g: (t, np.clip(a, -CLIP_ACC, CLIP_ACC), np.clip(g, -CLIP_GYRO, CLIP_GYRO)),
        lambda a, g: bool(np.abs(a).max() > BEYOND * CLIP_ACC or np.abs(g).max() > BEYOND * CLIP_GYRO),
    )
    yield Damage("half the rate, both repeated", Defect.REPEATED, _with(acc=_hold, gyro=_hold))
    yield Damage("half the rate, accelerometer alone", Defect.REPEATED, _with(acc=_hold))
    yield Damage("half the rate, gyroscope alone", Defect.REPEATED, _with(gyro=_hold))
    tilt = _rotation((1.0, 1.0, 0.0), TILT)
    yield Damage("accelerometer turned by 10 degrees", Defect.AXES, _with(acc=_by(tilt)))
    random = np.random.default_rng(SEED)
    for number in (1, 2):
        turn = _by(_rotation(random.normal(size=3).tolist(), random.uniform(0.0, np.pi)))
        yield Damage(f"whole sensor turned, {number}", None, _with(turn, turn))


def _columns(piece: WalkingFoot) -> Damaged:
    """Return the samples of the foot, which are finite."""
    (table,) = [table for table in load_samples(piece.path).tables if table.foot is piece.foot]
    acc, gyro = (np.column_stack(table.columns[quantity]) for quantity in ("acc", "gyro"))
    return np.array(table.t), acc, gyro


def _vectors(values: Floats) -> list[Vec3]:
    return [(x, y, z) for x, y, z in values.tolist()]


def _reported(values: Damaged, foot: Foot) -> list[DefectFound]:
    """Return the defects that a session of the default recipe reports while the samples come, not at their end."""
    t, acc, gyro = values
    session, events = Session(), list[Event]()
    site = SITE_OF_FOOT[foot]
    for time, force, rate in zip(t.tolist(), _vectors(acc), _vectors(gyro), strict=True):
        events += session.feed(Sample(time, site, force, rate))
    return [event for event in events if isinstance(event, DefectFound)]


def examine(piece: WalkingFoot) -> DefectOutcome | None:
    """Return what is reported for one foot, whole and with each damage; None when it walks for less than 4 strides."""
    t, acc, gyro = _columns(piece)
    rows = zip(t.tolist(), _vectors(acc), _vectors(gyro), strict=True)
    strides = [(time, stride) for time, stride in StanceFinder().add(rows) if len(stride.intervals) > 1]
    if len(strides) < 4:
        return None
    whole = tuple(_reported((t, acc, gyro), piece.foot))
    start = strides[0][0] - strides[0][1].duration
    kept = (t >= start - BEFORE) & (t <= start + WALKING)
    if t[kept][-1] - start < LEAST_WALKING:
        return DefectOutcome(piece, whole)
    t, acc, gyro = t[kept], acc[kept], gyro[kept]
    known = KNOWN.get(piece.path.parent.name, set())
    outcomes = []
    for damage in _damages():
        if damage.defect in known or not damage.changes(acc, gyro):
            continue
        if damage.defect is None and Defect.CLIPPED in known:
            continue  # once turned, cut peaks no longer end at the range of an axis, which no sensor does
        found = _reported(damage.make(t, acc, gyro), piece.foot)
        names = tuple([event.defect.name for event in found if event.defect not in known])
        unit = MS if damage.defect is Defect.TIME_UNIT else 1.0
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
    alarms = [
        (outcome, event)
        for outcome in outcomes
        for event in outcome.whole
        if event.defect not in KNOWN.get(outcome.piece.path.parent.name, set())
    ]
    share = 100.0 * len({outcome.piece for outcome, _ in alarms}) / max(1, len(outcomes))
    lines = [f"Alarms on {len(outcomes)} undamaged feet, without the known defects: {share:.1f} %."]
    lines += [
        f"- {outcome.piece.path.parent.name}/{outcome.piece.path.stem}, {outcome.piece.foot}: {event.what}"
        for outcome, event in alarms
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


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = add_command(commands, "sensors", "damaged sensors", __doc__ or "")
    add_folder(command)
    add_only(command)
    add_processes(command)
    command.set_defaults(run=run)


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    found = run_jobs(examine, pieces(options.dir, options.only), processes=options.processes)
    print("\n".join(table([outcome for outcome in found if outcome is not None])))
    return 0
