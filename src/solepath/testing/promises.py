"""Does a stance detector keep what a session needs of one (stance.Detector)? For whoever writes one: call it in a test.

It tries the detector on the samples that it is given. What samples cannot show (that each costs the same, that the
evidence is any good) it does not find.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from copy import deepcopy
from math import inf, isfinite
from typing import Any

import attrs
from attrs import evolve

from ..foot.pressure.insole import InsoleLoads
from ..foot.rejection import ABSURD_ACC, ABSURD_GYRO
from ..foot.stance.stance import Detector, Load, Stance
from ..saving.codec import Json, SnapshotError, load, save
from ..saving.schema import record_of, remembers
from ..types import Layout, Phase, Quat, Sample, Vec3
from ..types.vector import IDENTITY

Moment = tuple[float, float, Vec3, Vec3, Load | None, Quat]
"""The arguments of one update."""

GROWTH = 1.5
"""A state that has so many times more values in the second half of the samples than in the first has no bounds."""


def broken(detector: Detector, samples: Iterable[Sample], layout: Layout | None = None) -> list[str]:
    """A sentence for every promise that `detector`, which was never fed and is not fed here, breaks; none is good.

    `samples`: of one foot in the order of their time, ten seconds of walking or more; those without acc or gyro are
    passed over. `layout`: where the cells are. The attitude is that of a level sensor throughout. TypeError when
    `detector` is no attrs class or has a field of a kind that cannot be saved; what its `update` raises is not caught.
    """
    moments = list(_moments(samples, layout))
    fresh, half = save(detector), len(moments) // 2
    worn = deepcopy(detector)
    if layout is not None and hasattr(worn, "wear"):
        worn.wear(layout)
    found = []
    one = deepcopy(worn)
    try:
        said, early = _sized(one, moments[:half])
        restored: Any = load(type(worn), json.loads(json.dumps(save(one))))
        altered = list(_altered(one, restored))
        after, late = _sized(one, moments[half:])
    except SnapshotError as error:
        return [f"its state cannot be saved and restored: {error}"]
    said += after
    if save(detector) != fresh:
        found.append("two copies of it share something: feeding one changes the other")
    if _said(deepcopy(worn), moments) != said:
        found.append("the same samples do not say the same twice")
    found += [f"saved and restored, {what}" for what in altered]
    if not altered and _said(restored, moments[half:]) != after:
        found.append("saved and restored, it does not go on as before: it remembers what is in no field")
    found += [
        f"its setting {name} changes: what does is state, a field with init=False" for name in _unsettled(worn, one)
    ]
    if late > GROWTH * early:
        found.append("it remembers more and more")
    kept: Any = one
    for stance in (*said, *_said(one, _absurd(moments)), *_said(evolve(kept), moments)):
        found += [what for what in _unsound(stance) if what not in found]
    return found


def _unsettled(before: Any, after: Any) -> list[str]:
    """Settings that are not what they were: a packed session would lose that."""
    cls = type(before)
    settings = record_of(cls, made=True).defaults if remembers(cls) else {}
    return [name for name in settings if getattr(before, name) != getattr(after, name)]


def _moments(samples: Iterable[Sample], layout: Layout | None) -> Iterator[Moment]:
    insole, last = InsoleLoads(), None
    if layout is not None:
        insole.wear(layout)
    for sample in samples:
        if sample.acc is None or sample.gyro is None:
            continue
        pressed = insole.update(sample.t, sample.pressure) if sample.pressure else None
        yield sample.t, 0.0 if last is None else sample.t - last, sample.acc, sample.gyro, pressed, IDENTITY
        last = sample.t


def _said(detector: Detector, moments: Iterable[Moment]) -> list[Stance]:
    return [detector.update(*moment) for moment in moments]


def _altered(detector: Any, restored: Any) -> Iterator[str]:
    """The fields that are not what they were: what restores them is their type annotation."""
    for name in attrs.fields_dict(type(detector)):
        was, comes = getattr(detector, name), getattr(restored, name)
        if type(was) is not type(comes) and not isinstance(was, int | float):
            yield f"its field {name} comes back as a {type(comes).__name__} and was a {type(was).__name__}"
        elif save(was) != save(comes) if attrs.has(type(was)) else was != comes:
            yield f"its field {name} comes back as {comes!r:.60} and was {was!r:.60}"


def _sized(detector: Detector, moments: Sequence[Moment]) -> tuple[list[Stance], int]:
    """What it says, and how many values its state had at the most, looked at some hundred times."""
    said, most, every = [], 1, max(1, len(moments) // 100)
    for k, moment in enumerate(moments):
        said.append(detector.update(*moment))
        if k % every == 0:
            most = max(most, _values(save(detector)))
    return said, most


def _values(saved: Json) -> int:
    if isinstance(saved, dict):
        return sum(map(_values, saved.values()))
    return sum(map(_values, saved)) if isinstance(saved, list) else 1


def _absurd(moments: Sequence[Moment]) -> Iterator[Moment]:
    """What follows them and is no walk: the largest readings, free fall, samples that crowd and that are rare."""
    t = moments[-1][0] if moments else 0.0
    for dt in (1e-6, 0.01, 0.1, 1.0, 1e5, 0.01):
        for size in (0.0, 1.0, -1.0, 1e-9):
            t += dt
            acc, gyro = 0.999 * size * ABSURD_ACC, 0.999 * size * ABSURD_GYRO
            yield t, dt, (acc, -acc, acc), (gyro, gyro, -gyro), None, IDENTITY


def _unsound(stance: Stance) -> Iterator[str]:
    """What a corrector could make nothing of."""
    if not isinstance(stance, Stance):
        yield f"update returns a Stance, not a {type(stance).__name__}"
        return
    if len(stance.v_ref) != 3 or not all([isfinite(v) for v in stance.v_ref]):
        yield f"v_ref is three finite numbers, not {stance.v_ref}"
    if not 0.0 < stance.sigma <= inf:
        yield f"sigma is above 0, and infinite where there is nothing to say, not {stance.sigma}"
    if not isfinite(stance.statistic):
        yield f"the statistic is finite, not {stance.statistic}"
    if stance.hint is not None and not isinstance(stance.hint, Phase):
        yield f"the hint is a Phase or None, not {stance.hint!r}"
