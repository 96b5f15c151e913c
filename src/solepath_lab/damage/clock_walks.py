"""Walks for the table of separate clocks: the events of both feet of a recording, and the times between them."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf
from pathlib import Path
from statistics import median

import numpy as np
import numpy.typing as npt
from attrs import frozen

from solepath.body.checks.foot_clocks import EVEN_SWINGS
from solepath.calibration import Calibration
from solepath.emulate.walk import sampled
from solepath.events import Defect, DefectFound, Event, FootFlat, HeelOff, HeelStrike, SampleGap, StrideTaken, ToeOff
from solepath.recording import RecordingError
from solepath.recording.samples import load_samples
from solepath.session import Session
from solepath.types import OTHER, Foot, Sample

from ..descriptions import KNOWN
from ..emulated.heading import LENGTHS
from ..emulated.heading_walks import heading_route, insoles_of, wearer_of
from ..evaluate.insoles import force_sensors, switches

PAUSE = 2.5
"""Time between two contacts of a foot above which the wearer did not walk, s."""
KNOWN_APART: dict[str, str] = KNOWN["clocks_apart"]
"""Data sets and recordings whose feet have separate clocks, and the reason."""
CALIBRATIONS = {"marpino_heel_toe": switches, "gaitpdb_vgrf": force_sensors}
"""Functions that return the calibration of a data set's insoles."""


Times = npt.NDArray[np.float64]
FootEvent = HeelStrike | ToeOff | FootFlat | HeelOff | StrideTaken | SampleGap | DefectFound


@frozen
class ClockJob:
    """A recording of both feet, or an emulated walk."""

    data_set: str
    name: str
    path: Path | None = None
    """The recording; None for an emulated walk, whose seed is its name."""


@frozen
class ClockWalk:
    """The events of both feet in a walk."""

    job: ClockJob
    events: tuple[FootEvent, ...]
    spans: dict[Foot, tuple[float, float]]
    """Times of the first and the last sample of each foot with both inertial sensors, s."""
    end: float
    """Time of the last sample, s."""

    @property
    def name(self) -> str:
        """Names of data set and recording."""
        return f"{self.job.data_set}/{self.job.name}"

    @property
    def is_known_apart(self) -> bool:
        """True if the feet have separate clocks already."""
        return self.job.data_set in KNOWN_APART or self.job.name in KNOWN_APART


def read_walk(job: ClockJob) -> ClockWalk | str:
    """Return the events of a walk, or the reason why the recording cannot be used."""
    calibration = CALIBRATIONS.get(job.data_set, Calibration)()
    session, events = Session(calibration=calibration, losses=True), list[Event]()
    spans: dict[Foot, tuple[float, float]] = {}
    samples: Iterable[Sample]
    if job.path is None:
        seed = int(job.name)
        route = heading_route("right_angles", seed, LENGTHS["500m"]).walk(300.0)
        samples = sampled(route, wearer=wearer_of(seed), insoles=insoles_of(seed), seed=seed).samples
    else:
        try:
            recording = load_samples(job.path)
        except RecordingError as error:
            return str(error)
        if len(recording.tables) < 2:
            return "one foot"
        samples = recording
    for sample in samples:
        events += session.feed(sample)
        foot = sample.site.foot
        if foot is not None and sample.acc is not None and sample.gyro is not None:
            spans[foot] = (spans.get(foot, (sample.t, 0.0))[0], sample.t)
    of_feet = tuple([event for event in events if isinstance(event, FootEvent) and not is_clocks(event)])
    return ClockWalk(job, of_feet, spans, session.now or 0.0)


def is_clocks(event: FootEvent) -> bool:
    """Return whether an event is a report of separate clocks, which is searched for again."""
    return isinstance(event, DefectFound) and event.defect is Defect.CLOCKS


def foot_of(event: FootEvent) -> Foot | None:
    """Return the foot of an event."""
    return event.site.foot if isinstance(event, SampleGap | DefectFound) else event.foot


def error_between(walk: ClockWalk, shift: float) -> float | None:
    """Return by how much the times between the feet change when the right foot is shifted by `shift`, s.

    The result is None for a walker whose mean swings differ by `EVEN_SWINGS` or more."""
    contacts, toe_offs = (
        {foot: np.array([e.t for e in walk.events if isinstance(e, kind) and e.foot is foot]) for foot in Foot}
        for kind in (HeelStrike, ToeOff)
    )
    if min(len(times) for times in (*contacts.values(), *toe_offs.values())) < 2:
        return None
    swings = [median(_until_next(toe_offs[foot], contacts[foot])) for foot in Foot]
    if abs(swings[1] - swings[0]) >= EVEN_SWINGS:
        return None
    true = _times_between(contacts, toe_offs)
    shifted = [{Foot.LEFT: times[Foot.LEFT], Foot.RIGHT: times[Foot.RIGHT] + shift} for times in (contacts, toe_offs)]
    return max([abs(one - other) for one, other in zip(true, _times_between(*shifted), strict=True)])


def _times_between(contacts: dict[Foot, Times], toe_offs: dict[Foot, Times]) -> list[float]:
    """Return the median step time and the median double support of each foot, s."""
    medians = []
    for foot in Foot:
        own, other = contacts[foot], OTHER[foot]
        medians.append(median(_until_next(contacts[other], own)))
        leaving = [toe_offs[other][np.argmin(np.abs(toe_offs[other] - t))] - t for t in own]
        medians.append(median([float(time) for time in leaving]))
    return medians


def _until_next(times: Times, others: Times) -> list[float]:
    """Return the time from each of `times` to the next of `others`, s, where it is not a pause."""
    nexts = np.searchsorted(others, times, side="right")
    found = [float(others[k] - t) for k, t in zip(nexts, times, strict=True) if k < len(others)]
    return [time for time in found if time < PAUSE] or [inf]
