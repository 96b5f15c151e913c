"""Learns the curves of `Activities` from blocks of half a second whose activity is known.

    solepath-lab train activities DATA_DIR [--processes N]

writes activities.json beside the part, and prints what each kind of evidence earns. The same data give the same file.

The training data are hugadb, as recorded and at other rates; level walks of other wearers, sensors and mountings;
emulated wearers and patients with seeds from 101; and what is not walking: the bicycles of hugadb_daily and emulated
motions. In the level walks the wearers also stood, unlabelled, so only blocks with a stride are used; of what is not
walking only blocks in which the foot moves. The recorded stairs of gaitmap_examples and xio_closed_walks are not
training data."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Iterable, Iterator, Sequence
from copy import deepcopy
from functools import partial
from operator import attrgetter, call
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from solepath import recipes
from solepath.body.activity import motion
from solepath.body.activity.elevator_evidence import BlockForce
from solepath.body.activity.foot_blocks import (
    BLOCK_DURATION,
    FEATURES,
    FORCE_FEATURES,
    MOVING_VARIANCE,
    WINDOW_REACH,
    BlockFeatures,
    FootBlocks,
    Row,
    force_features_of,
)
from solepath.body.activity.motion import MotionModel, block_force, log_probabilities
from solepath.cli.common.processes import run_jobs
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
from solepath.recording.samples.npz import read_arrays
from solepath.show.tables.table import percent
from solepath.types import SITE_OF_FOOT, Activity, Foot, Sample, Site
from solepath.types.vector import TIME_EPSILON

from ..emulated import other_motions, slow_walkers
from ..evaluate.not_walking import MOTIONS
from ..tables import markdown
from . import emulated
from .activities_course import FootEvidence, LabelledCourse, chances, shifts
from .activities_fit import CLASSES, STRIDE_FEATURES, fit, fit_both, to_json
from .hugadb import FOLDS, Span, fold_of, labels, recordings, spans
from .resampling import resampled

Floats = NDArray[np.float64]
Label = Callable[[float], Activity | None]

STRAPDOWN = Recipe("strapdown", ShoeDetector(), LinearDedrift())
"""Recipe of a plain zero-velocity method, so that the model does not depend on the strides of one recipe."""
VARIANTS: tuple[tuple[float | None, Recipe], ...] = (
    (None, recipes.DEFAULT),
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
EMULATED_WEARER, EMULATED_WAY, EMULATED_PATIENT, EMULATED_OTHER, RIDER = 2000, 2050, 2100, 2200, 3000
"""Wearer numbers that all emulated wearers share, all on ramps, all patients, all other emulated motions, all rides."""
PATIENTS = range(emulated.FIRST_TRAINING_SEED, emulated.FIRST_TRAINING_SEED + 4)
PATIENT_RATES = (100.0, 50.0, 200.0, 20.0)
"""Seeds of the emulated patients and other motions, and their sampling rates, Hz, in rotation."""
OTHER_MOTIONS = (
    "bicycling", "inline skating", "in a wheelchair", "sitting, legs dangle", "marching on the spot", "jumping",
    "walking, in the hands", "walking, in the pockets",
)  # fmt: skip
"""Emulated motions that are learnt as none of the activities; whoever sits in a vehicle may be standing."""
RIDES = tuple([code for code, motion in MOTIONS.items() if motion == "bicycling"])
"""Label codes of hugadb_daily that are none of the activities."""
MIN_LABEL_SHARE = 0.9
"""Smallest share of a block that its most frequent label must have for the block to be used."""


@frozen(eq=False)
class Blocks:
    """The features, classes and wearers of blocks of half a second.

    The number of later blocks in a block's window is two, one or none, in rotation, as `Activities` sees them."""

    features: Floats
    """FEATURES, (n, features); NaN where the foot has no gyroscope."""
    forces: Floats
    """FORCE_FEATURES, (n, features)."""
    classes: NDArray[np.int64]
    """Numbers of activities_fit.CLASSES, (n,)."""
    wearers: NDArray[np.int64]
    """Wearer numbers, (n,); other data sets than hugadb have one number each."""
    fold: int | None = None
    """Number of the fold in which the blocks are not learnt; None when they are learnt in each."""
    course: LabelledCourse | None = None
    """The whole recording, when its sequence of activities is learnt too."""


@frozen
class Shown:
    """What a foot shows in a block, with some later blocks."""

    features: BlockFeatures
    forces: Row
    """FORCE_FEATURES, whether the foot has a gyroscope or not."""
    moves: bool
    """Flag: the foot moves in the block."""
    always_moves: bool
    """Flag: the foot moves in each block of the window."""


def blocks_of(
    samples: Sequence[Sample],
    label: Label,
    recipe: Recipe,
    wearer: int,
    only_strides: bool = False,
    course_spans: Sequence[Span] | None = None,
    fold: int | None = None,
) -> Blocks:
    """Return the labelled blocks of both feet.

    `only_strides` leaves out blocks without a stride or with a standing foot. `course_spans` are the true activities of
    a recording from which the sequence of activities is learnt too."""
    unknown = (np.nan,) * len(FEATURES)
    rows: list[Row] = []
    forces: list[Row] = []
    classes: list[int] = []
    t_start = samples[0].t
    evidence: dict[int, dict[Foot, FootEvidence]] = {}
    for foot in Foot:
        foot_samples = [sample for sample in samples if sample.site.foot is foot and sample.acc is not None]
        for index, windows, force in _features(foot, foot_samples, t_start, recipe):
            whole = windows[0]
            evidence.setdefault(index, {})[foot] = whole.features, force
            activity = _block_label(label, t_start + index * BLOCK_DURATION)
            with_stride = whole.features.stride is not None and whole.always_moves
            if activity is Activity.UNKNOWN and not whole.moves:
                activity = None
            if activity is not None and (with_stride or not only_strides):
                shown = windows[index % len(windows)]
                rows.append(shown.features.values if shown.features.gyroscope else unknown)
                forces.append(shown.forces)
                classes.append(CLASSES[activity])
    n = len(rows)
    by_hand = wearer < EMULATED_WEARER
    course = None if course_spans is None else LabelledCourse(t_start, evidence, tuple(course_spans), by_hand)
    return Blocks(
        np.array(rows).reshape(n, len(FEATURES)),
        np.array(forces).reshape(n, len(FORCE_FEATURES)),
        np.array(classes, dtype=np.int64),
        np.full(n, wearer),
        fold,
        course,
    )


def _features(
    foot: Foot, samples: Sequence[Sample], t_start: float, recipe: Recipe
) -> Iterator[tuple[int, list[Shown], BlockForce | None]]:
    """Yield the number, what is shown with all, one and no later block, and the force of each block."""
    parts = deepcopy(recipe)
    tracker = FootTracker(foot, parts.detector, parts.corrector, parts.cues)
    blocks, found = FootBlocks(), dict[int, list[Shown]]()
    for sample in samples:
        events = tracker.feed(sample)
        index = int((sample.t - t_start + TIME_EPSILON) / BLOCK_DURATION)
        if blocks.index is None or index > blocks.index:
            if blocks.index is not None:
                blocks.close()
                complete = blocks.index - WINDOW_REACH
                for k in range(complete, blocks.index + 1):
                    if (shown := _show(blocks, k, t_start)) is not None:
                        found.setdefault(k, []).insert(0, shown)
                if (windows := found.pop(complete, None)) is not None:
                    windows += windows[-1:] * (WINDOW_REACH + 1 - len(windows))  # where later blocks are empty
                    yield complete, windows, block_force(blocks.block(complete), blocks.resolution)
            rest = tracker.rest
            blocks.start_block(index, rest.bias, rest.grain if rest.count else 0.0)
        if sample.acc is not None:
            blocks.add(sample.acc, sample.gyro, tracker.corrector.velocity if tracker.levelled else None)
        if events:
            blocks.add_events(events, tracker.corrector.position[2])


def _show(blocks: FootBlocks, index: int, t_start: float) -> Shown | None:
    judged, window = blocks.block(index), blocks.window(index)
    features = blocks.features(index, t_start + (index + 0.5) * BLOCK_DURATION)
    if judged is None or features is None:
        return None
    always_moves = min([block.variance for block in window]) > MOVING_VARIANCE
    return Shown(features, force_features_of(judged, window), judged.variance > MOVING_VARIANCE, always_moves)


def _block_label(label: Label, t_start: float) -> Activity | None:
    """Return the label of the block that starts at `t_start` s; None when no label has the share MIN_LABEL_SHARE."""
    n = 20
    block_labels = [label(t_start + BLOCK_DURATION * (k + 0.5) / n) for k in range(n)]
    most_frequent = max(set(block_labels), key=block_labels.count)
    return most_frequent if block_labels.count(most_frequent) >= MIN_LABEL_SHARE * n else None


def hugadb(folder: Path, wearer: int) -> Iterator[Blocks]:
    """Yield the blocks of a wearer of hugadb, once for every entry of VARIANTS."""
    for one in recordings(folder):
        if one.subject != wearer or one.path.stem in MISLABELLED:
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
            yield blocks_of(variant, label, recipe, one.subject, course_spans=course_spans, fold=fold_of(one.subject))


def level_walks(data: Path) -> Iterator[Blocks]:
    """Yield the blocks of every second recording of LEVEL_WALKS."""
    for number, folder in enumerate(LEVEL_WALKS):
        for path in sorted((data / folder).glob("*.npz"))[::2]:
            samples = sorted(load_samples(path), key=attrgetter("t"))
            yield blocks_of(samples, lambda t: Activity.WALKING, recipes.DEFAULT, 1000 + number, only_strides=True)


def emulated_walk(seed: int) -> Iterator[Blocks]:
    """Yield the blocks of an emulated walk; every seed has another wearer."""
    walker = emulated.walker(seed, jogging=True)
    samples = _sample_walk(walker, DEVICES[seed % len(DEVICES)], seed)
    truth = walker.truth()
    yield blocks_of(samples, truth.activity, recipes.DEFAULT, EMULATED_WEARER, course_spans=truth.activities)
    yield blocks_of(samples, truth.activity, STRAPDOWN, EMULATED_WEARER)


def other_ways(seed: int) -> Iterator[Blocks]:
    """Yield the blocks of an emulated walk on ramps, backwards, sideways and on the spot, none of which are stairs."""
    walker = emulated.other_ways(seed)
    samples = _sample_walk(walker, DEVICES[seed % len(DEVICES)], seed)
    yield blocks_of(samples, walker.truth().activity, recipes.DEFAULT, EMULATED_WAY)


def emulated_patients(seed: int) -> Iterator[Blocks]:
    """Yield the blocks of emulated patients who walk slowly, shuffle, limp or use a stick."""
    for gait in slow_walkers.GAITS:
        one = slow_walkers.patient(gait, seed)
        begins = min([t for foot in Foot for t in one.true_times(foot, "toe_off")])
        ends = max([t for foot in Foot for t in one.true_times(foot, "heel_strike")])

        def label(t: float, begins: float = begins, ends: float = ends) -> Activity:
            return Activity.WALKING if begins <= t < ends else Activity.STANDING

        samples = slow_walkers.samples_of(gait, seed, PATIENT_RATES[seed % len(PATIENT_RATES)])
        yield blocks_of(samples, label, recipes.DEFAULT, EMULATED_PATIENT)


def other_motions_of(seed: int) -> Iterator[Blocks]:
    """Yield the blocks of emulated motions that are not walking."""
    for one in other_motions.MOTIONS:
        if one.name in OTHER_MOTIONS:
            samples = other_motions.samples_of(one, seed, PATIENT_RATES[seed % len(PATIENT_RATES)])
            yield blocks_of(samples, lambda t: Activity.UNKNOWN, recipes.DEFAULT, EMULATED_OTHER)


def rides(folder: Path) -> Iterator[Blocks]:
    """Yield the blocks of bicycles in hugadb_daily; one wearer rode, so each recording is in a fold."""
    for number, path in enumerate(sorted(folder.glob("bicycling_*.npz"))):
        truth = read_arrays(path, lambda key: key in ("t", "activity"))

        def label(
            t: float, times: Floats = truth["t"], codes: NDArray[np.int64] = truth["activity"]
        ) -> Activity | None:
            k = int(np.searchsorted(times, t))
            return Activity.UNKNOWN if k < len(codes) and int(codes[k]) in RIDES else None

        yield blocks_of(list(load_samples(path)), label, recipes.DEFAULT, RIDER, fold=number % len(FOLDS))


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


def _all(make: Callable[..., Iterable[Blocks]], *given: Any) -> list[Blocks]:
    return list(make(*given))


def sources(folder: Path) -> list[tuple[Callable[[], list[Blocks]], int | None]]:
    """Return functions that give the blocks of each source in the data directory, with its wearer in hugadb or None.

    They can be called in other processes."""
    wearers = [(partial(_all, hugadb, folder / "hugadb", one), one) for one in sorted(frozenset().union(*FOLDS))]
    made = [partial(_all, make, seed) for make in (emulated_walk, other_ways) for seed in EMULATED]
    made += [partial(_all, make, seed) for make in (emulated_patients, other_motions_of) for seed in PATIENTS]
    others = [partial(_all, level_walks, folder), *made, partial(_all, rides, folder / "hugadb_daily")]
    return [*wearers, *[(source, None) for source in others]]


def fit_model(given: Iterable[Blocks], note: str) -> MotionModel:
    """Return the model that is fitted to blocks of all sources; `note` states the training data."""
    used = [blocks for blocks in given if len(blocks.classes)]
    gyroscope, alone = fit_both(*joined(used))
    courses = [blocks.course for blocks in used if blocks.course is not None]
    model = MotionModel(note, gyroscope, alone, chances(courses), ())
    return attrs.evolve(model, shifts=shifts(courses, model))


def joined(used: Sequence[Blocks]) -> tuple[Floats, Floats, NDArray[np.int64], NDArray[np.int64]]:
    """Return features, force features, classes and wearers of the blocks of several sources."""
    return (
        np.concatenate([blocks.features for blocks in used]),
        np.concatenate([blocks.forces for blocks in used]),
        np.concatenate([blocks.classes for blocks in used]),
        np.concatenate([blocks.wearers for blocks in used]),
    )


EVIDENCE: dict[str, tuple[str, ...]] = {
    "everything": (),
    "no shares of forces": ("steady", "hard"),
    "no angular rates": ("turning", "turning_around", "fast"),
    "no velocities up and down": ("climb", "sink", "climb_now", "sink_now"),
    "no strides": STRIDE_FEATURES,
}
"""Features that are left out, by the name of what is left."""


def ablation(given: Iterable[Blocks]) -> str:
    """Return the table of the half seconds of one foot that are right without each kind of evidence.

    Each is judged with curves that were learnt in the other folds, of wearers or of recordings of bicycles."""
    used = [blocks for blocks in given if len(blocks.classes)]
    rows = []
    for title, left_out in EVIDENCE.items():
        names = [name for name in FEATURES if name not in left_out]
        columns = [FEATURES.index(name) for name in names]
        counts = np.zeros((len(motion.MOTIONS), len(motion.MOTIONS)))
        for fold in range(len(FOLDS)):
            features, _, classes, wearers = joined([blocks for blocks in used if blocks.fold != fold])
            known = ~np.isnan(features[:, 0])
            curves = fit(names, features[known][:, columns], classes[known], wearers[known])
            features, _, classes, _ = joined([blocks for blocks in used if blocks.fold == fold])
            judged = [np.argmax(log_probabilities(curves, tuple(row))) for row in features[:, columns].tolist()]
            np.add.at(counts, (classes, judged), 1.0)
        shares = [np.trace(counts) / counts.sum(), *(np.diag(counts) / counts.sum(1))]
        rows.append([title, *[percent(share) for share in shares]])
    return "\n".join(markdown.table(["right", "all", *[name.replace("_", " ") for name in motion.MOTIONS]], rows))


def run(options: Namespace) -> int:
    """Train the activity model on all training data, write it and print the table; return the exit status."""
    note = (
        f"all wearers of HuGaDB (without {' and '.join(MISLABELLED)}) as recorded and at 20 and 10 Hz; level "
        f"walks of {', '.join(LEVEL_WALKS)}; emulated wearers, also on ramps, seeds {EMULATED[0]} to {EMULATED[-1]}, "
        f"patients and other motions, seeds {PATIENTS[0]} to {PATIENTS[-1]}; and the bicycles of hugadb_daily"
    )
    jobs = [source for source, _ in sources(options.dir)]
    found = [blocks for of_source in run_jobs(call, jobs, processes=options.processes) for blocks in of_source]
    Path(motion.__file__).with_name("activities.json").write_text(to_json(fit_model(found, note)), encoding="utf-8")
    print(ablation(found))
    return 0
