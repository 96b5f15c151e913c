"""Does a part of a foot keep what a session needs of it? For whoever writes a stance detector, a corrector or cues:
call `broken` in a test.

It tries the part on the samples that it is given: a detector by itself, a corrector or cues in a foot whose other parts
are those of the default recipe. What samples cannot show (that each costs the same, that what is said is any good) it
does not find.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from copy import deepcopy
from math import inf, isfinite
from typing import Any

import attrs
from attrs import define, evolve, field

from ..events import FootFlat, HeelOff, HeelStrike, ToeOff
from ..foot.cues.cues import Cues
from ..foot.navigate.corrector import Corrector
from ..foot.navigate.error_state import ErrorStateFilter
from ..foot.pressure.insole import InsoleLoads
from ..foot.rejection import ABSURD_ACC, ABSURD_GYRO
from ..foot.stance.cycle import Cycle
from ..foot.stance.stance import Detector, Stance
from ..foot.tracker import FootTracker
from ..saving.codec import Json, SnapshotError, load, save
from ..saving.schema import record_of, remembers
from ..types import Foot, Layout, Phase, Sample, Site
from ..types.vector import IDENTITY, ZERO

GROWTH = 1.5
"""A state that has so many times more values in the second half of the samples than in the first has no bounds."""
GAPS = ((2.5, 2.6), (5.0, 5.4))
"""What is left out of every `EVERY` seconds for a corrector or cues, s: gaps to bridge, and gaps to leap over."""
EVERY = 6.0
UNIT = 1e-6
"""The length of a unit quaternion differs by no more from 1."""


def broken(part: Detector | Corrector | Cues, samples: Iterable[Sample], layout: Layout | None = None) -> list[str]:
    """A sentence for every promise that `part`, which was never fed and is not fed here, breaks; none is good.

    `samples`: of one foot in the order of their time, ten seconds of walking or more; those without acc or gyro are
    passed over. `layout`: where the cells are. The attitude that a detector is told is that of a level sensor
    throughout. TypeError when `part` extends neither Detector nor Corrector nor Cues, is no attrs class, or has a field
    of a kind that cannot be saved; what its methods raise is not caught.
    """
    whole = [sample for sample in samples if sample.acc is not None and sample.gyro is not None]
    fresh = save(part)
    place = _placed(deepcopy(part), whole[0].site.foot or Foot.LEFT if whole else Foot.LEFT, layout)
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
    unsound: dict[str, str] = {}
    for what in said:
        for sentence in place.unsound(what):
            unsound.setdefault(sentence.partition(",")[0], sentence)  # the first of its kind
    return [*found, *unsound.values()]


def _unsettled(before: Any, after: Any) -> list[str]:
    """Settings that are not what they were: a packed session would lose that."""
    cls = type(before)
    settings = record_of(cls, made=True).defaults if remembers(cls) else {}
    return [name for name in settings if getattr(before, name) != getattr(after, name)]


# --- where a part is tried --------------------------------------------------------------------------------------------


@define
class _ByItself:
    """A detector, and what it is told."""

    part: Detector
    insole: InsoleLoads
    t: float | None = field(default=None, init=False)

    def with_gaps(self, samples: list[Sample]) -> list[Sample]:
        return samples

    def cells_alone(self, samples: list[Sample]) -> list[Sample]:
        return []

    def restart(self) -> None:
        kept: Any = self.part
        self.part = evolve(kept)

    def feed(self, sample: Sample) -> Any:
        t, last, self.t = sample.t, self.t, sample.t
        pressed = self.insole.update(t, sample.pressure) if sample.pressure else None
        acc, gyro = sample.acc or ZERO, sample.gyro or ZERO
        return self.part.update(t, 0.0 if last is None else t - last, acc, gyro, pressed, IDENTITY)

    def unsound(self, stance: Any) -> Iterator[str]:
        """What a corrector could make nothing of."""
        if not isinstance(stance, Stance):
            yield f"update returns a Stance, not a {type(stance).__name__}"
            return
        if len(stance.v_ref) != 3 or not _finite(stance.v_ref):
            yield f"v_ref is three finite numbers, not {stance.v_ref}"
        if not 0.0 < stance.sigma <= inf:
            yield f"sigma is above 0, and infinite where there is nothing to say, not {stance.sigma}"
        if not isfinite(stance.statistic):
            yield f"the statistic is finite, not {stance.statistic}"
        if stance.hint is not None and not isinstance(stance.hint, Phase):
            yield f"the hint is a Phase or None, not {stance.hint!r}"


@define
class _InFoot:
    """A corrector or cues in the place that a session has for it."""

    tracker: FootTracker
    name: str
    """Of that place."""

    @property
    def part(self) -> Any:
        return getattr(self.tracker, self.name)

    @part.setter
    def part(self, part: Any) -> None:
        setattr(self.tracker, self.name, part)

    def with_gaps(self, samples: list[Sample]) -> list[Sample]:
        began = samples[0].t if samples else 0.0
        return [s for s in samples if not any([a < (s.t - began) % EVERY < b for a, b in GAPS])]

    def cells_alone(self, samples: list[Sample]) -> list[Sample]:
        t = self.tracker.t or 0.0
        return [Sample(t + 1.0 + s.t - samples[0].t, s.site, pressure=s.pressure) for s in samples if s.pressure]

    def restart(self) -> None:
        self.tracker.interrupt()

    def feed(self, sample: Sample) -> Any:
        tracker = self.tracker
        events = tracker.feed(sample)
        one = tracker.corrector
        found = (one.position, one.velocity, one.attitude, one.covariance(), one.error_index)
        return sample.t, events, found if tracker.levelled else None, tracker.cues.sagittal


@define
class _Corrects(_InFoot):
    """A corrector."""

    def unsound(self, said: Any) -> Iterator[str]:
        """What no event may be made of."""
        _, _, found, _ = said
        if found is None:
            return
        position, velocity, (w, x, y, z), spread, error_index = found
        for name, value in (("position", position), ("velocity", velocity)):
            if len(value) != 3 or not _finite(value):
                yield f"{name} is three finite numbers, not {value}"
        if not abs(w * w + x * x + y * y + z * z - 1.0) < 2.0 * UNIT:
            yield f"attitude is a unit quaternion, not {(w, x, y, z)}"
        if len(spread) != 7 or not _finite(spread) or min(spread[0], spread[3], spread[5], spread[6]) < 0.0:
            yield f"a covariance is seven finite numbers with variances of 0 or more, not {spread}"
        if error_index is not None and not 0.0 <= error_index < inf:
            yield f"error_index is None, or finite and not below 0, not {error_index}"


@define
class _Sees(_InFoot):
    """Cues."""

    def unsound(self, said: Any) -> Iterator[str]:
        """What cannot have been seen."""
        t, events, _, sagittal = said
        for event in events:
            if isinstance(event, HeelStrike | FootFlat | HeelOff | ToeOff) and not event.t <= t:
                yield f"a cue is of the past, not a {type(event).__name__} of {event.t:.3f} s in a sample of {t:.3f} s"
        if not isfinite(sagittal):
            yield f"sagittal is finite, not {sagittal}"


def _placed(part: Any, foot: Foot, layout: Layout | None) -> _ByItself | _Corrects | _Sees:
    kinds = type(part).__mro__
    if Detector in kinds:
        insole = InsoleLoads()
        if layout is not None:
            insole.wear(layout)
            part.wear(layout)
        return _ByItself(part, insole)
    place: _Corrects | _Sees
    if Corrector in kinds:
        place = _Corrects(FootTracker(foot, Cycle(), part), "corrector")
    elif Cues in kinds:
        place = _Sees(FootTracker(foot, Cycle(), ErrorStateFilter(), cues=part), "cues")
    else:
        raise TypeError(f"{type(part).__name__} extends neither Detector nor Corrector nor Cues")
    if layout is not None:
        place.tracker.wear(layout)
    return place


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


def _finite(values: Iterable[float]) -> bool:
    return all([isfinite(value) for value in values])
