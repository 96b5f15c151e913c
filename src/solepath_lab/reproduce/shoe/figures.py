"""Curves of figures 3, 7 and 20 of Li et al. 2016: energies by window, the first attitude, and found stances."""

from __future__ import annotations

from collections.abc import Sequence
from math import asin, degrees, sqrt

import numpy as np
from attrs import evolve

from solepath.emulate.wearers.truth import Truth
from solepath.foot.stance.stance import Detector
from solepath.papers.shoe_sensing.posture import INITIAL_TIME, gravity_error
from solepath.papers.shoe_sensing.printed import GatedTilt
from solepath.papers.shoe_sensing.recipe import SHOE_SENSING_PRINTED
from solepath.papers.shoe_sensing.short_time_energy import EnergySettings, printed_energy
from solepath.session import Session
from solepath.types import Phase, Sample

from ..tables import DrawStyle, PictureTrack, Plot
from .scores import states_of
from .variants import FOOT, STATES, WINDOWS, AccelerationMagnitude

SHOWN = 2.5
"""Duration of what figures 3 and 20 show, s: two strides or three."""
STRIDE_SHOWN = 4
"""Number of the stride in its state with which figures 3 and 20 begin, from 0."""
LARGEST_ENERGY = 0.4
"""Largest energy that figures 3 and 20 show, g^2."""
LEVELS = {"energy": 1.0, "magnitude": 0.6, "true": 0.2}
"""Heights of the flags in figure 20, by row."""


def _shown(samples: Sequence[Sample], truth: Truth, state: str) -> tuple[float, list[Sample]]:
    """Return the start, s, of what is shown of a state, and the samples up to its end."""
    strides = [one for one, of in zip(truth.strides(FOOT), states_of(truth, FOOT), strict=True) if of == state]
    start = strides[min(STRIDE_SHOWN, len(strides) - 1)].t_start
    return start, [one for one in samples if one.t < start + SHOWN]


def _run(detector: Detector, samples: Sequence[Sample]) -> list[tuple[float, float, bool]]:
    """Return time, s, statistic and stance of each sample."""
    found, last = [], samples[0].t
    for one in samples:
        if one.acc is None or one.gyro is None:
            continue
        stance = detector.update(one.t, one.t - last, one.acc, one.gyro, None)
        last = one.t
        found.append((one.t, stance.statistic, stance.hint is Phase.STATIONARY))
    return found


def window_curves(samples: Sequence[Sample], truth: Truth) -> Plot:
    """Return figure 3: the short-time energy of a walk with windows of several lengths."""
    start, shown = _shown(samples, truth, "walking")
    curves = [
        PictureTrack(
            f"N {window:g} s",
            tuple([(t - start, min(energy, LARGEST_ENERGY)) for t, energy, _ in _run(printed_energy(window), shown)]),
        )
        for window in WINDOWS
    ]
    curves = [evolve(curve, points=tuple([point for point in curve.points if point[0] >= 0.0])) for curve in curves]
    threshold = EnergySettings().threshold
    curves.append(PictureTrack("threshold", ((0.0, threshold), (SHOWN, threshold)), DrawStyle.TRUTH))
    return Plot("energy by window (fig. 3)", curves, "s", "g^2", (0.0, LARGEST_ENERGY))


def posture_curves(samples: Sequence[Sample]) -> Plot:
    """Return figure 7: the tilt error over the samples in which the first attitude is found, degrees."""
    session, points = Session(SHOE_SENSING_PRINTED), []
    for one in samples:
        if one.t > 1.25 * INITIAL_TIME:
            break
        session.feed(one)
        corrector = session.feet[FOOT].corrector
        assert isinstance(corrector, GatedTilt)
        x, y, z = gravity_error(corrector.attitude, corrector.last_acc)
        points.append((one.t, degrees(asin(min(1.0, sqrt(x * x + y * y + z * z))))))
    return Plot("first attitude (fig. 7)", (PictureTrack("tilt error", points),), "s", "degrees")


def extraction_curves(samples: Sequence[Sample], truth: Truth) -> tuple[Plot, ...]:
    """Return figure 20: in which samples the foot stands by energy, by magnitude, and truly, in each state."""
    panels = []
    for state in STATES:
        start, shown = _shown(samples, truth, state)
        flags = {name: _run(detector, shown) for name, detector in _detectors().items()}
        phases = truth.feet[FOOT].phases(np.array([one.t for one in shown]))
        flags["true"] = [(one.t, 0.0, phase is Phase.STATIONARY) for one, phase in zip(shown, phases, strict=True)]
        curves = tuple(
            [
                PictureTrack(
                    name,
                    tuple([(t - start, LEVELS[name] - (0.0 if stands else 0.2)) for t, _, stands in of if t >= start]),
                    DrawStyle.TRUTH if name == "true" else DrawStyle.LINE,
                )
                for name, of in flags.items()
            ]
        )
        panels.append(Plot(f"{state}, stands (fig. 20)", curves, "s", "higher: stands", (-0.1, 1.4)))
    return tuple(panels)


def _detectors() -> dict[str, Detector]:
    return {"energy": printed_energy(), "magnitude": AccelerationMagnitude()}
