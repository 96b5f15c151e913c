"""Samples of both feet at another rate, so that activities are learnt for slower sensors too."""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter

import attrs
import numpy as np

from solepath.types import Foot, Sample
from solepath.types.vector import ZERO


def resampled(samples: Sequence[Sample], rate: float) -> list[Sample]:
    """Return the samples at another rate, Hz, interpolated linearly between samples.

    They are first averaged over half an interval of the new rate, as a sensor at a low rate does, unless that is
    shorter than an old interval."""
    found: list[Sample] = []
    for foot in Foot:
        foot_samples = [one for one in samples if one.site.foot is foot and one.acc is not None]
        if len(foot_samples) < 2:
            continue
        t = np.array([one.t for one in foot_samples])
        width = max(1, round(0.5 / rate / float(np.median(np.diff(t)))))
        new_times = np.arange(t[0], t[-1], 1.0 / rate)

        has_gyro = all([one.gyro is not None for one in foot_samples])
        values = np.array([(*(one.acc or ZERO), *((one.gyro or ZERO) if has_gyro else ())) for one in foot_samples])
        smooth = [np.convolve(channel, np.ones(width) / width, "same") for channel in values.T]
        rows = np.column_stack([np.interp(new_times, t, channel) for channel in smooth]).tolist()
        for time, (x, y, z, *turn) in zip(new_times.tolist(), rows, strict=True):
            gyro = (turn[0], turn[1], turn[2]) if has_gyro else None
            found.append(attrs.evolve(foot_samples[0], t=time, acc=(x, y, z), gyro=gyro))
    return sorted(found, key=attrgetter("t"))
