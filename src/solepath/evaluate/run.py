"""One recording through one session, and what the scores need of what came out.

Only what samples.py reads (t, acc, gyro, pressure) reaches the session; the truth in the same file never does.
"""

from __future__ import annotations

from pathlib import Path
from time import perf_counter

import attrs
import numpy as np
from attrs import field, frozen

from .. import recipes
from ..events import FootFlat, FootMoved, HeelOff, HeelStrike, SampleRejected, StepTaken, ToeOff
from ..recording import warn
from ..samples import load_samples
from ..session import Session
from ..types import Foot
from .alignment import Floats


@frozen(eq=False)
class FootRun:
    """What a session said about one foot: the live track `positions` (n,3) in m at `t` (n,), steps and event times."""

    t: Floats
    positions: Floats
    steps: tuple[StepTaken, ...] = ()
    heel_strikes: tuple[float, ...] = ()
    foot_flats: tuple[float, ...] = ()
    heel_offs: tuple[float, ...] = ()
    toe_offs: tuple[float, ...] = ()

    @property
    def step_lengths(self) -> list[tuple[float, float]]:
        """(t_end, stride_length) of each step."""
        return [(step.t_end, step.stride_length) for step in self.steps]


@frozen(eq=False)
class Run:
    feet: dict[Foot, FootRun]
    samples: int
    rejected: int
    seconds: float
    """Wall time that the session took."""


@frozen(eq=False)
class _Gathered:
    t: list[float] = field(factory=list)
    positions: list[tuple[float, float, float]] = field(factory=list)
    steps: list[StepTaken] = field(factory=list)
    times: dict[type, list[float]] = field(factory=dict)


def run(path: Path, recipe: str, *, foot: Foot | None = None, without_pressure: bool = False) -> Run:
    """The recording at `path` through a session of the named recipe, sample by sample.

    `without_pressure`: leave the pressure out, because the truth was made of it.
    """
    session = Session(recipes.BY_NAME[recipe], poses=True)
    recording = load_samples(path, foot, report=warn)
    gathered = {table.foot: _Gathered() for table in recording.tables}
    rejected = 0
    began = perf_counter()
    outputs = []
    for sample in recording:
        outputs.append(session.feed(attrs.evolve(sample, pressure=None) if without_pressure else sample))
    outputs.append(session.finish())
    seconds = perf_counter() - began
    for events in outputs:
        for event in events:
            match event:
                case FootMoved():
                    gathered[event.foot].t.append(event.t)
                    gathered[event.foot].positions.append(event.position)
                case StepTaken(final=True):
                    gathered[event.foot].steps.append(event)
                case HeelStrike() | FootFlat() | HeelOff() | ToeOff():
                    gathered[event.foot].times.setdefault(type(event), []).append(event.t)
                case SampleRejected():
                    rejected += 1
    feet = {foot: _foot_run(one) for foot, one in gathered.items()}
    return Run(feet=feet, samples=len(recording), rejected=rejected, seconds=seconds)


def _foot_run(one: _Gathered) -> FootRun:
    return FootRun(
        t=np.array(one.t, dtype=np.float64),
        positions=np.array(one.positions, dtype=np.float64).reshape(len(one.t), 3),
        steps=tuple(one.steps),
        heel_strikes=tuple(one.times.get(HeelStrike, ())),
        foot_flats=tuple(one.times.get(FootFlat, ())),
        heel_offs=tuple(one.times.get(HeelOff, ())),
        toe_offs=tuple(one.times.get(ToeOff, ())),
    )
