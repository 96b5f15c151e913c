"""Test harnesses for parts: a detector runs alone, a corrector or cues in a foot, a part of the body in a wearer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import hypot, inf, isfinite
from typing import Any

from attrs import define, evolve, field

from ..body.part import Part
from ..calibration import Calibration
from ..events import FootFlat, HeelOff, HeelStrike, LayoutKnown, ToeOff
from ..events.happening import BaseEvent
from ..foot.cues.cues import Cues
from ..foot.cues.gait_cues import GaitCues
from ..foot.navigate.corrector import Corrector
from ..foot.navigate.error_state import ErrorStateFilter
from ..foot.pressure.insole import InsoleLoads
from ..foot.stance.cycle import Cycle
from ..foot.stance.stance import Detector, Stance
from ..foot.tracker import FootTracker
from ..recipes import DEFAULT
from ..session.state import SessionSettings, SessionState
from ..types import SITE_OF_FOOT, Foot, Layout, Phase, Sample
from ..types.vector import IDENTITY, ZERO

LENGTH_TOLERANCE = 1e-6
"""Largest deviation of the length of a unit quaternion from 1; chosen by hand."""


@define
class DetectorHarness:
    """Runs a detector alone, with the loads of an insole."""

    part: Detector
    insole: InsoleLoads
    t: float | None = field(default=None, init=False)
    """Time of the newest sample, s."""

    def restart(self) -> None:
        part: Any = self.part
        self.part = evolve(part)

    def feed(self, sample: Sample) -> Any:
        t, last_t, self.t = sample.t, self.t, sample.t
        load = self.insole.update(t, sample.pressure) if sample.pressure else None
        acc, gyro = sample.acc or ZERO, sample.gyro or ZERO
        return self.part.update(t, 0.0 if last_t is None else t - last_t, acc, gyro, load, IDENTITY)

    def finish(self) -> list[Any]:
        return []

    def problems(self, stance: Any) -> Iterator[str]:
        """Yield a sentence for every value of a stance that a corrector cannot use."""
        if not isinstance(stance, Stance):
            yield f"update returns a Stance, not a {type(stance).__name__}"
            return
        if len(stance.v_ref) != 3 or not _all_finite(stance.v_ref):
            yield f"v_ref is three finite numbers, not {stance.v_ref}"
        if not 0.0 < stance.sigma <= inf:
            yield f"sigma is above 0, and infinite where there is nothing to say, not {stance.sigma}"
        if not isfinite(stance.statistic):
            yield f"the statistic is finite, not {stance.statistic}"
        if stance.hint is not None and not isinstance(stance.hint, Phase):
            yield f"the hint is a Phase or None, not {stance.hint!r}"


@define
class FootHarness:
    """Runs a corrector or cues within a foot, as a session does."""

    tracker: FootTracker
    name: str
    """Name of the attribute of FootTracker that holds the part."""

    @property
    def part(self) -> Any:
        """Part under test."""
        return getattr(self.tracker, self.name)

    @part.setter
    def part(self, part: Any) -> None:
        setattr(self.tracker, self.name, part)

    def restart(self) -> None:
        self.tracker.reset()

    def feed(self, sample: Sample) -> Any:
        tracker = self.tracker
        events = tracker.feed(sample)
        one = tracker.corrector
        state = (one.position, one.velocity, one.attitude, one.covariance(), one.error_index)
        seen = tracker.cues.sagittal, tracker.cues.impact_at
        return sample.t, events, state if tracker.levelled else None, seen

    def finish(self) -> list[Any]:
        return []

    def problems(self, output: Any) -> Iterator[str]:
        """Yield a sentence for every value that an event cannot have, and every cue that lies in the future."""
        t, events, state, seen = output
        yield from self._cue_problems(t, events, *seen) if self.name == "cues" else self._state_problems(state)

    def _cue_problems(self, t: float, events: Any, sagittal: float, impact_at: float | None) -> Iterator[str]:
        for event in events:
            if isinstance(event, HeelStrike | FootFlat | HeelOff | ToeOff) and not event.t <= t:
                yield f"a cue is of the past, not a {type(event).__name__} of {event.t:.3f} s in a sample of {t:.3f} s"
        if impact_at is not None and not impact_at <= t:
            yield f"impact_at is of the past, not {impact_at:.3f} s in a sample of {t:.3f} s"
        if not isfinite(sagittal):
            yield f"sagittal is finite, not {sagittal}"

    def _state_problems(self, state: Any) -> Iterator[str]:
        if state is None:
            return
        position, velocity, attitude, covariance, error_index = state
        for name, value in (("position", position), ("velocity", velocity)):
            if len(value) != 3 or not _all_finite(value):
                yield f"{name} is three finite numbers, not {value}"
        if not abs(hypot(*attitude) - 1.0) < LENGTH_TOLERANCE:
            yield f"attitude is a unit quaternion, not {attitude}"
        variances = [covariance[k] for k in (0, 3, 5, 6)] if len(covariance) == 7 else [-1.0]
        if not _all_finite(covariance) or min(variances) < 0.0:
            yield f"a covariance is seven finite numbers with variances of 0 or more, not {covariance}"
        if error_index is not None and not 0.0 <= error_index < inf:
            yield f"error_index is None, or finite and not below 0, not {error_index}"


@define
class WearerHarness:
    """Runs a part of the body, after the parts of the default recipe."""

    state: SessionState

    @property
    def part(self) -> Any:
        """Part under test, the last of the session's parts."""
        return self.state.parts[-1]

    @part.setter
    def part(self, part: Any) -> None:
        self.state.parts[-1] = part
        self.state.set_plan(None)

    def restart(self) -> None:
        for foot in self.state.feet:
            self.state.reset(SITE_OF_FOOT[foot])

    def feed(self, sample: Sample) -> Any:
        return self.state.feed_sample(sample)

    def finish(self) -> list[Any]:
        return [self.state.finish()]

    def problems(self, events: Any) -> Iterator[str]:
        """Yield a sentence for every output that is no event, or that has `t` after `known_at`."""
        for event in events:
            if not isinstance(event, BaseEvent):
                yield f"a part returns events, a Shift, a HeightShift or a Replacement, not a {type(event).__name__}"
            elif not (isfinite(event.t) and event.t <= event.known_at):
                yield f"an event was when it was known or earlier, not a {type(event).__name__} of {event.t} s"


def harness_for(part: Any, foot: Foot, layout: Layout | None) -> DetectorHarness | FootHarness | WearerHarness:
    """Return the harness for a part of this kind; raise TypeError when it extends none of the four kinds."""
    kinds = type(part).__mro__
    if Detector in kinds:
        insole = InsoleLoads()
        if layout is not None:
            insole.set_layout(layout)
            part.set_layout(layout)
        return DetectorHarness(part, insole)
    if Part in kinds:
        state = SessionState(SessionSettings(evolve(DEFAULT, parts=(*DEFAULT.parts, part)), Calibration()))
        state.set_plan(None)
        if layout is not None:
            site = SITE_OF_FOOT[foot]
            state.report(site, LayoutKnown(t=0.0, known_at=0.0, site=site, layout=layout))
        return WearerHarness(state)
    if Corrector in kinds:
        tracker, name = FootTracker(foot, Cycle(), part, GaitCues()), "corrector"
    elif Cues in kinds:
        tracker, name = FootTracker(foot, Cycle(), ErrorStateFilter(), part), "cues"
    else:
        raise TypeError(f"{type(part).__name__} extends neither Detector nor Corrector nor Cues nor Part")
    if layout is not None:
        tracker.set_layout(layout)
    return FootHarness(tracker, name)


def _all_finite(values: Iterable[float]) -> bool:
    return all([isfinite(value) for value in values])
