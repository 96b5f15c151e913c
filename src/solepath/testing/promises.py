"""Tests whether a part meets the contract of a session: call `broken` in a test of your own part.

It is meant for authors of a stance detector, a corrector, cues or a part of the body. It runs the part on the given
samples: a detector alone, the others where a session has them, within the default recipe. It does not find what samples
cannot show: whether each sample costs the same time, and whether the results are any good."""

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
from ..types.vector import IDENTITY
from .harness import harness_for

GROWTH = 1.5
"""A state grows without bounds when the second half of the samples makes it this many times larger than the first."""


def broken(
    part: Detector | Corrector | Cues | Part, samples: Iterable[Sample], layout: Layout | None = None
) -> list[str]:
    """Return a sentence for every rule that `part` breaks; an empty list is good. `part` itself is never fed.

    `samples` are of one foot in the order of their time, ten seconds of walking or more; those without acc or gyro are
    skipped. `layout` has the positions of the cells. A detector receives the attitude of a level sensor throughout; a
    part of the body may be tested on samples of both feet. TypeError is raised when `part` extends none of the four
    kinds, is no attrs class, or has a field of a kind that cannot be saved. Exceptions of its methods are not caught.
    """
    whole = [sample for sample in samples if sample.acc is not None and sample.gyro is not None]
    fresh = save(part)
    harness = harness_for(deepcopy(part), whole[0].site.foot or Foot.LEFT if whole else Foot.LEFT, layout)
    walked = harness.with_gaps(whole)
    half = len(walked) // 2
    found = []
    one = deepcopy(harness)
    try:
        outputs, early = _run_measured(one, walked[:half])
        other = deepcopy(one)
        restored = load(type(part), json.loads(json.dumps(save(one.part))))
        altered = list(_changed_fields(one.part, restored))
        other.part = restored
        after, late = _run_measured(one, walked[half:])
    except SnapshotError as error:
        return [f"its state cannot be saved and restored: {error}"]
    outputs += after
    if save(part) != fresh:
        found.append("two copies of it share something: feeding one changes the other")
    if repr(_run(deepcopy(harness), walked)) != repr(outputs):
        found.append("the same samples do not say the same twice")
    found += [f"saved and restored, {what}" for what in altered]
    if not altered and repr(_run(other, walked[half:])) != repr(after):
        found.append("saved and restored, it does not go on as before: it remembers what is in no field")
    changed = _changed_settings(part, one.part)
    found += [f"its setting {name} changes: what does is state, a field with init=False" for name in changed]
    if late > GROWTH * early:
        found.append("it remembers more and more")
    outputs += _run(one, _extreme_samples(walked))
    outputs += _run(one, one.pressure_only(walked))
    one.restart()
    outputs += _run(one, walked)
    outputs += one.finish()
    problems: dict[str, str] = {}
    for what in outputs:
        for sentence in harness.problems(what):
            problems.setdefault(sentence.partition(",")[0], sentence)  # the first of its kind
    return [*found, *problems.values()]


def _changed_settings(before: Any, after: Any) -> list[str]:
    """Return the names of the settings that have changed. A packed session would lose such a change."""
    cls = type(before)
    settings = record_of(cls, made=True).defaults if has_state(cls) else {}
    return [name for name in settings if getattr(before, name) != getattr(after, name)]


def _run(harness: Any, samples: Iterable[Sample]) -> list[Any]:
    return [harness.feed(sample) for sample in samples]


def _changed_fields(part: Any, restored: Any) -> Iterator[str]:
    """Yield a sentence for every field that restores differently; its type annotation decides how it is restored."""
    for name in attrs.fields_dict(type(part)):
        was, comes = getattr(part, name), getattr(restored, name)
        if type(was) is not type(comes) and not isinstance(was, int | float):
            yield f"its field {name} comes back as a {type(comes).__name__} and was a {type(was).__name__}"
        elif save(was) != save(comes) if attrs.has(type(was)) else was != comes:
            yield f"its field {name} comes back as {comes!r:.60} and was {was!r:.60}"


def _run_measured(harness: Any, samples: Sequence[Sample]) -> tuple[list[Any], int]:
    """Return the outputs, and the largest number of values in the state, measured about a hundred times."""
    outputs, most, every = [], 1, max(1, len(samples) // 100)
    for k, sample in enumerate(samples):
        outputs.append(harness.feed(sample))
        if k % every == 0:
            most = max(most, _values(save(harness.part)))
    return outputs, most


def _values(saved: Json) -> int:
    if isinstance(saved, dict):
        return sum(map(_values, saved.values()))
    return sum(map(_values, saved)) if isinstance(saved, list) else 1


def _extreme_samples(samples: Sequence[Sample]) -> Iterator[Sample]:
    """Yield samples that follow `samples` and are no walk: very large readings, free fall, very short and long gaps."""
    t, site = (samples[-1].t, samples[-1].site) if samples else (0.0, Site.LEFT_FOOT)
    for dt in (1e-6, 0.01, 0.1, 1.0, 1e5, 0.01):
        for size in (0.0, 1.0, -1.0, 1e-9):
            t += dt
            acc, gyro = 0.999 * size * ABSURD_ACC, 0.999 * size * ABSURD_GYRO
            quat = IDENTITY if size > 0.0 else None
            yield Sample(t, site, (acc, -acc, acc), (gyro, gyro, -gyro), quat=quat)
