"""Does a part keep what a session needs of it? For whoever writes a stance detector, a corrector, cues or a part of the
body: call `broken` in a test.

It tries the part on the samples that it is given: a detector by itself, the others where a session has them, with the
default recipe around. What samples cannot show (that each costs the same, that what is said is any good) it does not
find.
"""

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
from .places import placed

GROWTH = 1.5
"""A state that has so many times more values in the second half of the samples than in the first has no bounds."""


def broken(
    part: Detector | Corrector | Cues | Part, samples: Iterable[Sample], layout: Layout | None = None
) -> list[str]:
    """A sentence for every promise that `part`, which was never fed and is not fed here, breaks; none is good.

    `samples`: of one foot in the order of their time, ten seconds of walking or more; those without acc or gyro are
    passed over. `layout`: where the cells are. The attitude that a detector is told is that of a level sensor
    throughout; a part of the body may be tried on samples of both feet. TypeError when `part` extends none of the four
    kinds, is no attrs class, or has a field of a kind that cannot be saved; what its methods raise is not caught.
    """
    whole = [sample for sample in samples if sample.acc is not None and sample.gyro is not None]
    fresh = save(part)
    place = placed(deepcopy(part), whole[0].site.foot or Foot.LEFT if whole else Foot.LEFT, layout)
    walked = place.with_gaps(whole)
    half = len(walked) // 2
    found = []
    one = deepcopy(place)
    try:
        said, early = _sized(one, walked[:half])
        other = deepcopy(one)
        restored = load(type(part), json.loads(json.dumps(save(one.part))))
        altered = list(_altered(one.part, restored))
        other.part = restored
        after, late = _sized(one, walked[half:])
    except SnapshotError as error:
        return [f"its state cannot be saved and restored: {error}"]
    said += after
    if save(part) != fresh:
        found.append("two copies of it share something: feeding one changes the other")
    if repr(_said(deepcopy(place), walked)) != repr(said):
        found.append("the same samples do not say the same twice")
    found += [f"saved and restored, {what}" for what in altered]
    if not altered and repr(_said(other, walked[half:])) != repr(after):
        found.append("saved and restored, it does not go on as before: it remembers what is in no field")
    changed = _unsettled(part, one.part)
    found += [f"its setting {name} changes: what does is state, a field with init=False" for name in changed]
    if late > GROWTH * early:
        found.append("it remembers more and more")
    said += _said(one, _absurd(walked))
    said += _said(one, one.cells_alone(walked))
    one.restart()
    said += _said(one, walked)
    said += one.finish()
    unsound: dict[str, str] = {}
    for what in said:
        for sentence in place.unsound(what):
            unsound.setdefault(sentence.partition(",")[0], sentence)  # the first of its kind
    return [*found, *unsound.values()]


def _unsettled(before: Any, after: Any) -> list[str]:
    """Settings that are not what they were: a packed session would lose that."""
    cls = type(before)
    settings = record_of(cls, made=True).defaults if has_state(cls) else {}
    return [name for name in settings if getattr(before, name) != getattr(after, name)]


def _said(place: Any, samples: Iterable[Sample]) -> list[Any]:
    return [place.feed(sample) for sample in samples]


def _altered(part: Any, restored: Any) -> Iterator[str]:
    """The fields that are not what they were: what restores them is their type annotation."""
    for name in attrs.fields_dict(type(part)):
        was, comes = getattr(part, name), getattr(restored, name)
        if type(was) is not type(comes) and not isinstance(was, int | float):
            yield f"its field {name} comes back as a {type(comes).__name__} and was a {type(was).__name__}"
        elif save(was) != save(comes) if attrs.has(type(was)) else was != comes:
            yield f"its field {name} comes back as {comes!r:.60} and was {was!r:.60}"


def _sized(place: Any, samples: Sequence[Sample]) -> tuple[list[Any], int]:
    """What it says, and how many values its state had at the most, looked at some hundred times."""
    said, most, every = [], 1, max(1, len(samples) // 100)
    for k, sample in enumerate(samples):
        said.append(place.feed(sample))
        if k % every == 0:
            most = max(most, _values(save(place.part)))
    return said, most


def _values(saved: Json) -> int:
    if isinstance(saved, dict):
        return sum(map(_values, saved.values()))
    return sum(map(_values, saved)) if isinstance(saved, list) else 1


def _absurd(samples: Sequence[Sample]) -> Iterator[Sample]:
    """What follows them and is no walk: the largest readings, free fall, samples that crowd and that are rare."""
    t, site = (samples[-1].t, samples[-1].site) if samples else (0.0, Site.LEFT_FOOT)
    for dt in (1e-6, 0.01, 0.1, 1.0, 1e5, 0.01):
        for size in (0.0, 1.0, -1.0, 1e-9):
            t += dt
            acc, gyro = 0.999 * size * ABSURD_ACC, 0.999 * size * ABSURD_GYRO
            quat = IDENTITY if size > 0.0 else None
            yield Sample(t, site, (acc, -acc, acc), (gyro, gyro, -gyro), quat=quat)
