"""Learns the network of `Activities` from blocks of half a second whose activity is known.

    solepath-lab train activities DATA_DIR

writes activities.json beside the part. The same data give the same file.

The training data are hugadb, as recorded and at other rates; level walks of other wearers, sensors and mountings; and
emulated wearers with seeds from 101. In the level walks the wearers also stood, unlabelled, so only blocks with a
stride are used. The recorded stairs of gaitmap_examples and xio_closed_walks are not training data."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Iterable, Iterator, Sequence
from copy import deepcopy
from operator import attrgetter
from pathlib import Path

import attrs
import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from solepath import recipes
from solepath.body.activity import motion
from solepath.body.activity.elevator_evidence import BlockForce
from solepath.body.activity.foot_blocks import (
    BLOCK_DURATION,
    FEATURE_COUNT,
    FIRST_STRIDE_FEATURE,
    WINDOW_REACH,
    FootBlocks,
)
from solepath.body.activity.motion import MotionModel, block_force
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.parts import LSM6DSOX, MPU6050, MPU9250, Imu
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.shoe import IN_SOLE, ON_INSTEP, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.stance.shoe import ShoeDetector
from solepath.foot.tracker import FootTracker
from solepath.link.decoder import Decoder
from solepath.recipes import Recipe
from solepath.recording.samples import load_samples
from solepath.types import SITE_OF_FOOT, Activity, Foot, Sample, Site
from solepath.types.vector import TIME_EPSILON

from . import emulated
from .activities_course import FootEvidence, LabelledCourse, chances, shifts
from .activities_net import CLASSES, feature_statistics, fit_networks, to_json
from .hugadb import Span, labels, recordings, spans
from .resampling import resampled

Floats = NDArray[np.float64]
Label = Callable[[float], Activity | None]

STRAPDOWN = Recipe("strapdown", ShoeDetector(), LinearDedrift())
"""Recipe of a plain zero-velocity method, so that the model does not depend on the strides of one recipe."""
VARIANTS: tuple[tuple[float | None, Recipe], ...] = (
    (None, recipes.DEFAULT),
    (100.0, recipes.DEFAULT),
    (20.0, recipes.DEFAULT),
    (10.0, recipes.DEFAULT),
    (None, STRAPDOWN),
    (20.0, STRAPDOWN),
)
"""Rate in Hz (None: as recorded) and recipe with which each recording is processed."""
MISLABELLED = ("various_03_05", "various_03_06")
"""Recordings that are left out because most of their labels are mistakes (known.toml says why).

The other corrections are of rides, in which feet stand; these recordings are learnt with their labels as they are."""
LEVEL_WALKS = ("ipol_10m_uturn", "gumushane_gcp", "felius_2min_walk", "tripod_treadmill")
EMULATED = range(emulated.FIRST_TRAINING_SEED, emulated.FIRST_TRAINING_SEED + 16)
DEVICES: tuple[tuple[float, Imu, Mounting] | CC2650 | CC2541, ...] = (
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
EMULATED_WEARER = 2000
"""Wearer number that all emulated wearers share."""
STILLNESS_FEATURE, STILLNESS_LIMIT = 1, 0.0
"""Index of the log variance of |acc| in the stillest of five blocks, and its value above which a foot always moves.

0 stands for a variance of 1 (m/s^2)^2."""
MIN_LABEL_SHARE = 0.9
"""Smallest share of a block that its most frequent label must have for the block to be used."""


@frozen(eq=False)
class Blocks:
    """The features, classes and wearers of blocks of half a second."""

    windows: tuple[Floats, ...]
    """Features, (n, FEATURE_COUNT), with all, with one and with no later block in the window."""
    classes: NDArray[np.int64]
    """Numbers of activities_net.CLASSES, (n,)."""
    wearers: NDArray[np.int64]
    """Wearer numbers, (n,); other data sets than hugadb have one number each."""
    course: LabelledCourse | None = None
    """The whole recording, when its sequence of activities is learnt too."""


def blocks_of(
    samples: Sequence[Sample],
    label: Label,
    recipe: Recipe,
    wearer: int,
    only_strides: bool = False,
    course_spans: Sequence[Span] | None = None,
) -> Blocks:
    """Return the labelled blocks of both feet.

    `only_strides` leaves out blocks without a stride or with a standing foot. `course_spans` are the true activities of
    a recording from which the sequence of activities is learnt too."""
    rows: list[list[list[float]]] = []
    classes: list[int] = []
    t_start = samples[0].t
    evidence: dict[int, dict[Foot, FootEvidence]] = {}
    for foot in Foot:
        foot_samples = [sample for sample in samples if sample.site.foot is foot and sample.acc is not None]
        for index, windows, force in _features(foot, foot_samples, t_start, recipe):
            features = windows[0]
            evidence.setdefault(index, {})[foot] = features, force
            activity = _block_label(label, t_start + index * BLOCK_DURATION)
            with_stride = features[FIRST_STRIDE_FEATURE] and features[STILLNESS_FEATURE] > STILLNESS_LIMIT
            if activity is not None and (with_stride or not only_strides):
                rows.append(windows)
                classes.append(CLASSES[activity])
    n = len(rows)
    by_hand = wearer != EMULATED_WEARER
    course = None if course_spans is None else LabelledCourse(t_start, evidence, tuple(course_spans), by_hand)
    windows_of_blocks = np.array(rows).reshape(n, WINDOW_REACH + 1, FEATURE_COUNT)
    return Blocks(
        tuple(windows_of_blocks.swapaxes(0, 1)), np.array(classes, dtype=np.int64), np.full(n, wearer), course
    )


def _features(
    foot: Foot, samples: Sequence[Sample], t_start: float, recipe: Recipe
) -> Iterator[tuple[int, list[list[float]], BlockForce | None]]:
    """Yield the number, the features with all, one and no later block, and the force of each block."""
    parts = deepcopy(recipe)
    tracker = FootTracker(foot, parts.detector, parts.corrector, parts.cues)
    window, found = FootBlocks(), dict[int, list[list[float]]]()
    for sample in samples:
        events = tracker.feed(sample)
        index = int((sample.t - t_start + TIME_EPSILON) / BLOCK_DURATION)
        if window.index is None or index > window.index:
            if window.index is not None:
                window.close()
                complete = window.index - WINDOW_REACH
                for k in range(complete, window.index + 1):
                    features = window.features(k, t_start + (k + 0.5) * BLOCK_DURATION)
                    if features is not None:
                        found.setdefault(k, []).insert(0, features)
                if (windows := found.pop(complete, None)) is not None:
                    windows += windows[-1:] * (WINDOW_REACH + 1 - len(windows))  # where later blocks are empty
                    yield complete, windows, block_force(window.block(complete), window.resolution)
            rest = tracker.rest
            window.start_block(index, rest.bias, rest.grain if rest.count else 0.0)
        if sample.acc is not None:
            corrector = tracker.corrector
            velocity = corrector.velocity if tracker.levelled else None
            window.add(sample.acc, sample.gyro, velocity, corrector.position[2])
        if events:
            window.add_events(events, tracker.corrector.position[2])


def _block_label(label: Label, t_start: float) -> Activity | None:
    """Return the label of the block that starts at `t_start` s; None when no label has the share MIN_LABEL_SHARE."""
    n = 20
    block_labels = [label(t_start + BLOCK_DURATION * (k + 0.5) / n) for k in range(n)]
    most_frequent = max(set(block_labels), key=block_labels.count)
    return most_frequent if block_labels.count(most_frequent) >= MIN_LABEL_SHARE * n else None


def hugadb(folder: Path, without: frozenset[int]) -> Iterator[Blocks]:
    """Yield the blocks of all wearers of hugadb but `without`, once for every entry of VARIANTS."""
    for one in recordings(folder):
        if one.subject in without or one.path.stem in MISLABELLED:
            continue
        times, activities = labels(one.path)
        label_times = np.array(times)

        def label(
            t: float, label_times: Floats = label_times, activities: list[Activity | None] = activities
        ) -> Activity | None:
            k = int(np.searchsorted(label_times, t))
            return activities[k] if k < len(activities) else None

        samples = list(load_samples(one.path))
        activity_spans = spans(times, activities)
        for rate, recipe in VARIANTS:
            variant = samples if rate is None else resampled(samples, rate)
            course_spans = activity_spans if (rate, recipe) == VARIANTS[0] else None
            yield blocks_of(variant, label, recipe, one.subject, course_spans=course_spans)


def level_walks(data: Path) -> Iterator[Blocks]:
    """Yield the blocks of every second recording of LEVEL_WALKS."""
    for number, folder in enumerate(LEVEL_WALKS):
        for path in sorted((data / folder).glob("*.npz"))[::2]:
            samples = sorted(load_samples(path), key=attrgetter("t"))
            yield blocks_of(samples, lambda t: Activity.WALKING, recipes.DEFAULT, 1000 + number, only_strides=True)


def emulated_walks(seeds: Iterable[int] = EMULATED) -> Iterator[Blocks]:
    """Yield the blocks of each emulated walk; every seed has another wearer."""
    for seed in seeds:
        walker = emulated.walker(seed, jogging=True)
        samples = _sample_walk(walker, DEVICES[seed % len(DEVICES)], seed)
        truth = walker.truth()
        yield blocks_of(samples, truth.activity, recipes.DEFAULT, EMULATED_WEARER, course_spans=truth.activities)
        yield blocks_of(samples, truth.activity, STRAPDOWN, EMULATED_WEARER)


def _sample_walk(walker: Walker, device: tuple[float, Imu, Mounting] | CC2650 | CC2541, seed: int) -> list[Sample]:
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


def fit_model(sources: Iterable[Blocks], note: str) -> MotionModel:
    """Return the model that is fitted to the blocks of all sources; `note` states the training data."""
    used = [blocks for blocks in sources if len(blocks.classes)]
    windows = [np.concatenate(one) for one in zip(*[blocks.windows for blocks in used], strict=True)]
    classes = np.concatenate([blocks.classes for blocks in used])
    wearers = np.concatenate([blocks.wearers for blocks in used])
    n = len(windows)
    full_network, accelerometer_network = fit_networks(
        np.concatenate(windows), np.tile(classes, n), np.tile(wearers, n)
    )
    means, deviations = feature_statistics(windows[0], classes)
    courses = [blocks.course for blocks in used if blocks.course is not None]
    model = MotionModel(note, full_network, accelerometer_network, means, deviations, chances(courses), ())
    return attrs.evolve(model, shifts=shifts(courses, model))


def run(options: Namespace) -> int:
    """Train the activity model on all training data and write it; return the exit status."""
    note = (
        f"all wearers of HuGaDB (without {' and '.join(MISLABELLED)}) as recorded and at 100, 20 and 10 Hz; level "
        f"walks of {', '.join(LEVEL_WALKS)}; emulated wearers, seeds {EMULATED[0]} to {EMULATED[-1]}"
    )
    sources = [*hugadb(options.dir / "hugadb", frozenset()), *level_walks(options.dir), *emulated_walks()]
    Path(motion.__file__).with_name("activities.json").write_text(to_json(fit_model(sources, note)), encoding="utf-8")
    return 0
