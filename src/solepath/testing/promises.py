"""Tests whether a part meets the contract of a session: call `violations` in a test of your own part.

It is meant for authors of a stance detector, a corrector, cues or a part of the body. It runs the part on the given
samples: a detector alone, any other part within the default recipe. It tests neither the time that a sample takes nor
the accuracy of the results."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from copy import deepcopy
from typing import Any

import attrs

from ..body.part import Part
from ..foot.cues.cues import Cues
from ..foot.navigate.corrector import Corrector
from ..foot.rejection import ABSURD_ACC, ABSURD_GYRO
from ..foot.stance.stance import Detector
from ..saving.codec import Json, SnapshotError, load, save
from ..saving.schema import has_state, record_of
from ..types import Foot, Layout, Sample, Site
from ..types.attrs import NOT_SAVED
from ..types.vector import IDENTITY
from .harness import harness_for

LARGEST_STATE_GROWTH = 1.5
"""Ratio of the second half's largest state to the first half's above which it may grow forever; chosen by hand."""
REPEATS = 8
"""Number of times that the samples are repeated for such a state, at most: one that grows each time is taken to grow
forever, as a window would that is longer than all of them."""
GAP_SPANS = ((2.5, 2.6), (5.0, 5.4))
"""Start and end of a short and of a long gap, s, that are cut from every `GAP_PERIOD` of the samples."""
GAP_PERIOD = 6.0
"""Period with which the gaps repeat, s."""


def violations(
    part: Detector | Corrector | Cues | Part, samples: Iterable[Sample], layout: Layout | None = None
) -> list[str]:
    """Return a sentence for every rule that `part` breaks; the list is empty if it breaks none.

    Copies of `part` are tested. `samples` are at least ten seconds of walking of one foot, in the order of time; for a
    part of the body they may be of both feet. Samples without acc or gyro are skipped. `layout` has the positions of
    the cells. A detector always receives the attitude of a level sensor. Raises TypeError when `part` extends none of
    the four kinds, is no attrs class, or has a field of a kind that cannot be saved. Exceptions of the part's methods
    are not caught."""
    inertial_samples = [sample for sample in samples if sample.acc is not None and sample.gyro is not None]
    saved_part = save(part)
    harness = harness_for(
        deepcopy(part), inertial_samples[0].site.foot or Foot.LEFT if inertial_samples else Foot.LEFT, layout
    )
    is_detector = Detector in type(part).__mro__  # it is tested without gaps, and needs inertial values
    tested_samples = inertial_samples if is_detector else list(_with_gaps(inertial_samples))
    middle = len(tested_samples) // 2
    sentences = []
    copy = deepcopy(harness)
    try:
        outputs, size_before = _run_measured(copy, tested_samples[:middle])
        restored_harness = deepcopy(copy)
        restored = load(type(part), json.loads(json.dumps(save(copy.part))))
        altered_fields = list(_changed_fields(copy.part, restored))
        restored_harness.part = restored
        late_outputs, size_after = _run_measured(copy, tested_samples[middle:])
        may_grow = size_after > LARGEST_STATE_GROWTH * size_before
        grows = may_grow and _grows(deepcopy(copy), tested_samples, size_after)
    except SnapshotError as error:
        return [f"its state cannot be saved and restored: {error}"]
    outputs += late_outputs
    if save(part) != saved_part:
        sentences.append("two copies of it share something: feeding one changes the other")
    if repr(_run(deepcopy(harness), tested_samples)) != repr(outputs):
        sentences.append("a second run gives different output")
    sentences += [f"saved and restored, {what}" for what in altered_fields]
    if not altered_fields and repr(_run(restored_harness, tested_samples[middle:])) != repr(late_outputs):
        sentences.append("saved and restored, it does not go on as before: some state is not in a field")
    changed_names = _changed_settings(part, copy.part)
    sentences += [f"its setting {name} changes: what does is state, a field with init=False" for name in changed_names]
    if grows:
        sentences.append("its state grows without bound")
    extreme_samples = list(_extreme_samples(tested_samples))
    outputs += _run(copy, extreme_samples)
    if not is_detector:
        outputs += _run(copy, _pressures(tested_samples, extreme_samples[-1].t + 1.0))
    copy.restart()
    outputs += _run(copy, tested_samples)
    outputs += copy.finish()
    problems: dict[str, str] = {}
    for what in outputs:
        for sentence in harness.problems(what):
            problems.setdefault(sentence.partition(",")[0], sentence)  # only the first sentence of each kind
    return [*sentences, *problems.values()]


def _changed_settings(before: Any, after: Any) -> list[str]:
    """Return the names of the settings that have changed, which a packed session would lose."""
    cls: Any = type(before)
    settings = record_of(cls, made=True).defaults if has_state(cls) else {}
    return [name for name in settings if getattr(before, name) != getattr(after, name)]


def _run(harness: Any, samples: Iterable[Sample]) -> list[Any]:
    return [harness.feed(sample) for sample in samples]


def _changed_fields(part: Any, restored: Any) -> Iterator[str]:
    """Yield a sentence for every field whose restored value differs; the type annotation decides how it is restored."""
    for name, field in attrs.fields_dict(type(part)).items():
        if field.metadata == NOT_SAVED:
            continue
        old, new = getattr(part, name), getattr(restored, name)
        if type(old) is not type(new) and not isinstance(old, int | float):
            yield f"its field {name} comes back as a {type(new).__name__} and was a {type(old).__name__}"
        elif save(old) != save(new) if attrs.has(type(old)) else old != new:
            yield f"its field {name} comes back as {new!r:.60} and was {old!r:.60}"


def _run_measured(harness: Any, samples: Sequence[Sample]) -> tuple[list[Any], int]:
    """Return the outputs, and the largest number of values in the state, counted at about a hundred samples."""
    outputs, largest_size, interval = [], 1, max(1, len(samples) // 100)
    for k, sample in enumerate(samples):
        outputs.append(harness.feed(sample))
        if k % interval == 0:
            largest_size = max(largest_size, _value_count(save(harness.part)))
    return outputs, largest_size


def _grows(harness: Any, samples: Sequence[Sample], size: int) -> bool:
    """Return whether a state, whose largest size so far is `size`, grows with each of REPEATS of the samples.

    A window of the last strides is full after some of them."""
    duration = samples[-1].t - samples[0].t + 0.01
    for k in range(1, REPEATS + 1):
        repeated = [attrs.evolve(one, t=one.t + k * duration, known_at=one.known_at + k * duration) for one in samples]
        _, larger_size = _run_measured(harness, repeated)
        if larger_size <= size:
            return False
        size = larger_size
    return True


def _value_count(saved: Json) -> int:
    if isinstance(saved, dict):
        return sum(map(_value_count, saved.values()))
    return sum(map(_value_count, saved)) if isinstance(saved, list) else 1


def _with_gaps(samples: Sequence[Sample]) -> Iterator[Sample]:
    """Yield the samples without those in a gap (`GAP_SPANS`)."""
    for sample in samples:
        if not any([a < (sample.t - samples[0].t) % GAP_PERIOD < b for a, b in GAP_SPANS]):
            yield sample


def _pressures(samples: Sequence[Sample], t: float) -> Iterator[Sample]:
    """Yield the pressures of `samples` as samples without inertial values, from `t`, s, on."""
    for sample in samples:
        if sample.pressure:
            yield Sample(t + sample.t - samples[0].t, sample.site, pressure=sample.pressure)


def _extreme_samples(samples: Sequence[Sample]) -> Iterator[Sample]:
    """Yield extreme samples to follow `samples`: very large readings, free fall, very short and very long intervals."""
    t, site = (samples[-1].t, samples[-1].site) if samples else (0.0, Site.LEFT_FOOT)
    for dt in (1e-6, 0.01, 0.1, 1.0, 1e5, 0.01):
        for size in (0.0, 1.0, -1.0, 1e-9):
            t += dt
            acc, gyro = 0.999 * size * ABSURD_ACC, 0.999 * size * ABSURD_GYRO
            quat = IDENTITY if size > 0.0 else None
            yield Sample(t, site, (acc, -acc, acc), (gyro, gyro, -gyro), quat=quat)
