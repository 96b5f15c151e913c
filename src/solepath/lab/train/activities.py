"""Learns the network of `Activities` from blocks of half a second whose activity is known.

    python -m solepath.lab.train.activities DATA_DIR [--out FILE] [--without FOLD]

writes activities.json beside the part, or FILE. The same data give the same file. `--without` leaves out the wearers of
a fold of hugadb (hugadb.py, from 0), for scoring on them.

The data are hugadb, as recorded and at other rates; level walks of other wearers, sensors and mountings (only walking
is known of them, so only blocks with a step count); and emulated wearers with seeds from 101. The recorded stairs of
gaitmap_examples and xio_closed_walks are not among them."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from copy import deepcopy
from operator import attrgetter
from pathlib import Path

import attrs
import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from ... import recipes
from ...body.activity import motion
from ...body.activity.features import BLOCK, COUNT, REACH, STRIDE
from ...body.activity.foot_blocks import FootBlocks
from ...body.activity.motion import MotionModel, to_json
from ...body.activity.ride import BlockForce
from ...body.activity.votes import block_force
from ...emulate.sensors.device import Device
from ...emulate.sensors.parts import LSM6DSOX, MPU6050, MPU9250, Imu
from ...emulate.sensors.sensortags import CC2541, CC2650
from ...emulate.walk import emulate
from ...emulate.wearers.shoe import IN_SOLE, ON_INSTEP, Mounting
from ...emulate.wearers.walker import Walker
from ...foot.navigate.dedrift import LinearDedrift
from ...foot.stance.shoe import ShoeDetector
from ...foot.tracker import FootTracker
from ...link.decoder import Decoder
from ...recipes import Recipe
from ...recording.samples import load_samples
from ...types import SITE_OF_FOOT, Activity, Foot, Sample, Site
from ...types.vector import TIE, ZERO
from . import emulated
from .activities_course import FootEvidence, LabelledCourse, chances, shifts
from .activities_net import CLASSES, networks, usual
from .hugadb import FOLDS, Span, labels, recordings, spans

Floats = NDArray[np.float64]
Label = Callable[[float], Activity | None]

STRAPDOWN = Recipe("strapdown", ShoeDetector(), LinearDedrift())
"""Recipe of a plain zero-velocity method, because the features of a step must not depend on one recipe."""
WAYS: tuple[tuple[float | None, Recipe], ...] = (
    (None, recipes.DEFAULT),
    (100.0, recipes.DEFAULT),
    (20.0, recipes.DEFAULT),
    (10.0, recipes.DEFAULT),
    (None, STRAPDOWN),
    (20.0, STRAPDOWN),
)
"""Rate in Hz (None: as recorded) and recipe with which each recording is processed."""
MISLABELLED = ("various_03_05", "various_03_06")
"""Recordings whose labels are taken for mistakes, so that nothing is learnt from them.

They are labelled as going down, but each stride rises by 0.4 m and swings as two steps up at a time do with other
wearers."""
LEVEL_WALKS = ("ipol_10m_uturn", "gumushane_gcp", "felius_2min_walk", "tripod_treadmill")
EMULATED = range(emulated.FIRST_TO_LEARN_FROM, emulated.FIRST_TO_LEARN_FROM + 16)
WORN: tuple[tuple[float, Imu, Mounting] | CC2650 | CC2541, ...] = (
    (100.0, LSM6DSOX, IN_SOLE),
    CC2650(),
    (20.0, MPU6050, IN_SOLE),
    CC2541(),
    (100.0, MPU9250, ON_INSTEP),
    CC2541(rate=20.0),
    (50.0, MPU6050, ON_INSTEP),
    (10.0, MPU9250, IN_SOLE),
)
"""Sensors of the emulated wearers, in rotation: rate in Hz, inertial sensor and mounting, or a device as it is sold."""
EMULATOR = 2000
"""Wearer number of all emulated wearers together."""
AFOOT = 0.0
"""Limit of feature 1 (the stillest block of five) for a foot that walks all the time.

It stands for a variance of |acc| above 1 (m/s^2)^2."""
PURE = 0.9
"""Smallest share of one label in a block that is used."""


@frozen(eq=False)
class Blocks:
    """Features (n, COUNT), classes (n) and wearers (n): a number for each wearer and source."""

    features: Floats
    classes: NDArray[np.int64]
    wearers: NDArray[np.int64]
    course: LabelledCourse | None = None
    """The whole recording, when the sequence of activities is learnt from it."""


def blocks_of(
    samples: Sequence[Sample],
    label: Label,
    recipe: Recipe,
    wearer: int,
    only_steps: bool = False,
    followed: Sequence[Span] | None = None,
) -> Blocks:
    """Return the labelled blocks of both feet.

    `only_steps` keeps the blocks with a step in them. `followed` has the true activities of a recording from which the
    sequence of activities is learnt."""
    rows: list[list[float]] = []
    classes: list[int] = []
    t_start = samples[0].t
    seen: dict[int, dict[Foot, FootEvidence]] = {}
    for foot in Foot:
        own = [sample for sample in samples if sample.site.foot is foot and sample.acc is not None]
        for index, features, force in _features(foot, own, t_start, recipe):
            seen.setdefault(index, {})[foot] = features, force
            now = _pure(label, t_start + index * BLOCK)
            if now is not None and (not only_steps or (features[STRIDE] and features[1] > AFOOT)):
                rows.append(features)
                classes.append(CLASSES[now])
    n = len(rows)
    course = None if followed is None else LabelledCourse(t_start, seen, tuple(followed), wearer != EMULATOR)
    return Blocks(np.array(rows).reshape(n, COUNT), np.array(classes, dtype=np.int64), np.full(n, wearer), course)


def _features(
    foot: Foot, samples: Sequence[Sample], t_start: float, recipe: Recipe
) -> Iterator[tuple[int, list[float], BlockForce | None]]:
    parts = deepcopy(recipe)
    tracker = FootTracker(foot, parts.detector, parts.corrector, cues=parts.cues)
    window = FootBlocks()
    for sample in samples:
        events = tracker.feed(sample)
        index = int((sample.t - t_start + TIE) / BLOCK)
        if window.index is None or index > window.index:
            if window.index is not None:
                window.close()
                judged = window.index - REACH
                found = window.features(judged, t_start + (judged + 0.5) * BLOCK)
                if found is not None:
                    yield judged, found, block_force(window.block(judged), window.resolution)
            rest = tracker.rest
            window.start_block(index, rest.bias, rest.grain if rest.count else 0.0)
        if sample.acc is not None:
            window.add(sample.acc, sample.gyro, tracker.corrector if tracker.levelled else None)
        if events:
            window.add_events(events, tracker.corrector.position[2])


def _pure(label: Label, t_start: float) -> Activity | None:
    """Return the label of at least the share PURE of the block that starts at `t_start` s; None when there is none."""
    n = 20
    found = [label(t_start + BLOCK * (k + 0.5) / n) for k in range(n)]
    most = max(set(found), key=found.count)
    return most if found.count(most) >= PURE * n else None


def hugadb(folder: Path, without: frozenset[int]) -> Iterator[Blocks]:
    """Yield the blocks of all wearers but `without`, with every entry of `WAYS`."""
    for one in recordings(folder):
        if one.subject in without or one.path.stem in MISLABELLED:
            continue
        times, known = labels(one.path)
        at = np.array(times)

        def label(t: float, at: Floats = at, known: list[Activity | None] = known) -> Activity | None:
            k = int(np.searchsorted(at, t))
            return known[k] if k < len(known) else None

        samples = list(load_samples(one.path))
        done = spans(times, known)
        for rate, recipe in WAYS:
            seen = samples if rate is None else resampled(samples, rate)
            followed = done if (rate, recipe) == WAYS[0] else None
            yield blocks_of(seen, label, recipe, one.subject, followed=followed)


def level_walks(data: Path) -> Iterator[Blocks]:
    """Yield the blocks of every other recorded walk without stairs."""
    for number, folder in enumerate(LEVEL_WALKS):
        for path in sorted((data / folder).glob("*.npz"))[::2]:
            samples = sorted(load_samples(path), key=attrgetter("t"))
            yield blocks_of(samples, lambda t: Activity.WALKING, recipes.DEFAULT, 1000 + number, only_steps=True)


def emulated_walks(seeds: Iterable[int] = EMULATED) -> Iterator[Blocks]:
    """Yield the blocks of each emulated walk; every seed has another wearer."""
    for seed in seeds:
        walker = emulated.walker(seed, jogging=True)
        samples = _worn(walker, WORN[seed % len(WORN)], seed)
        truth = walker.truth()
        yield blocks_of(samples, truth.activity, recipes.DEFAULT, EMULATOR, followed=truth.activities)
        yield blocks_of(samples, truth.activity, STRAPDOWN, EMULATOR)


def _worn(walker: Walker, device: tuple[float, Imu, Mounting] | CC2650 | CC2541, seed: int) -> list[Sample]:
    if isinstance(device, tuple):
        rate, part, mounting = device
        found = [one for foot in Foot for one in walker.samples(foot, rate, part, mounting=mounting)]
        return sorted(found, key=attrgetter("t"))
    devices: dict[Site, Device] = {site: attrs.evolve(device) for site in SITE_OF_FOOT.values()}
    walk = emulate(walker.route, wearer=walker.wearer, devices=devices, seed=seed)
    found = []
    for site in devices:
        decoder = Decoder(site)
        outputs = [one for packet in walk.packets if packet.site is site for one in decoder.feed(packet)]
        found += [one for one in outputs if isinstance(one, Sample)]
    return sorted(found, key=attrgetter("t"))


def resampled(samples: Sequence[Sample], rate: float) -> list[Sample]:
    """Return the samples at another rate, Hz, interpolated linearly between samples.

    They are first smoothed over half an interval where that is longer, as sensors do."""
    found: list[Sample] = []
    for foot in Foot:
        own = [one for one in samples if one.site.foot is foot and one.acc is not None]
        if len(own) < 2:
            continue
        t = np.array([one.t for one in own])
        width = max(1, round(0.5 / rate / float(np.median(np.diff(t)))))
        when = np.arange(t[0], t[-1], 1.0 / rate)

        turns = all([one.gyro is not None for one in own])
        held = np.array([(*(one.acc or ZERO), *((one.gyro or ZERO) if turns else ())) for one in own])
        smooth = [np.convolve(channel, np.ones(width) / width, "same") for channel in held.T]
        rows = np.column_stack([np.interp(when, t, channel) for channel in smooth]).tolist()
        for at, (x, y, z, *turn) in zip(when.tolist(), rows, strict=True):
            found.append(attrs.evolve(own[0], t=at, acc=(x, y, z), gyro=(turn[0], turn[1], turn[2]) if turns else None))
    return sorted(found, key=attrgetter("t"))


def fit_model(parts: Iterable[Blocks], note: str) -> MotionModel:
    """Return the model that is learnt from all these blocks."""
    held = [part for part in parts if len(part.classes)]
    features = np.concatenate([part.features for part in held])
    classes = np.concatenate([part.classes for part in held])
    whole, alone = networks(features, classes, np.concatenate([part.wearers for part in held]))
    means, deviations = usual(features, classes)
    courses = [part.course for part in held if part.course is not None]
    model = MotionModel(note, whole, alone, means, deviations, chances(courses), ())
    return attrs.evolve(model, shifts=shifts(courses, model))


def train_model(data: Path, without: int | None) -> MotionModel:
    """Return the model without the wearers of the fold `without`."""
    left_out = frozenset[int]() if without is None else FOLDS[without]
    fold = "all wearers" if without is None else f"the wearers but {sorted(left_out)}"
    note = (
        f"{fold} of HuGaDB (without {' and '.join(MISLABELLED)}) as recorded and at 100, 20 and 10 Hz; level walks of "
        f"{', '.join(LEVEL_WALKS)}; emulated wearers, seeds {EMULATED[0]} to {EMULATED[-1]}"
    )
    return fit_model([*hugadb(data / "hugadb", left_out), *level_walks(data), *emulated_walks()], note)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m solepath.lab.train.activities", description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--out", type=Path, default=Path(motion.__file__).with_name("activities.json"))
    parser.add_argument("--without", type=int, choices=range(len(FOLDS)))
    options = parser.parse_args(arguments)
    model = train_model(options.data, options.without)
    options.out.write_text(_lines(to_json(model), 0) + "\n", encoding="utf-8")
    return 0


def _lines(value: object, depth: int) -> str:
    """Return JSON with a line for each row of numbers."""
    inner, close = "\n" + " " * (depth + 1), "\n" + " " * depth
    if isinstance(value, dict):
        rows = [f"{json.dumps(key)}: {_lines(one, depth + 1)}" for key, one in value.items()]
        return "{" + inner + ("," + inner).join(rows) + close + "}"
    if isinstance(value, list) and value and isinstance(value[0], list):
        return "[" + inner + ("," + inner).join([json.dumps(row) for row in value]) + close + "]"
    return json.dumps(value)


if __name__ == "__main__":
    sys.exit(main())
