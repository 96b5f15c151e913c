"""Aligns a track with the truth and measures the distance between them.

The heading and origin of a track are arbitrary, so the track is turned about the vertical and shifted to fit the truth
before an error is measured. It is never scaled or mirrored."""

from __future__ import annotations

from math import atan2, cos, sin, sqrt
from typing import Any

import numpy as np
from attrs import frozen
from numpy.typing import NDArray

Floats = NDArray[np.float64]
ALIGNMENT_LENGTH = 2.0
"""Length of path over which a track is aligned with the truth, m; design: "after aligning the first two metres"."""


@frozen
class Alignment:
    """A turn by `yaw` rad about z (counter-clockwise seen from above), then a shift by `x`, `y` m."""

    yaw: float
    x: float
    y: float

    def apply(self, track: NDArray[Any]) -> Floats:
        """Return `track` (n,2) or (n,3) turned and shifted; heights stay as they are."""
        moved = np.array(track, dtype=np.float64)
        c, s = cos(self.yaw), sin(self.yaw)
        moved[:, 0] = c * track[:, 0] - s * track[:, 1] + self.x
        moved[:, 1] = s * track[:, 0] + c * track[:, 1] + self.y
        return moved


def align(track: NDArray[Any], truth: NDArray[Any]) -> Alignment:
    """Return the turn and shift that bring the horizontal points of `track` nearest to `truth` by least squares.

    Both are (n,2) or (n,3), m; equal rows are the same instant. With both centred on their means, the sum of squared
    distances is smallest at yaw = atan2(sum of cross products, sum of dot products)."""
    ours, theirs = np.asarray(track, np.float64)[:, :2], np.asarray(truth, np.float64)[:, :2]
    our_mean, their_mean = ours.mean(axis=0), theirs.mean(axis=0)
    a, b = ours - our_mean, theirs - their_mean
    yaw = atan2(float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])), float(np.sum(a * b)))
    turned = Alignment(yaw, 0.0, 0.0).apply(our_mean[None, :])[0]
    return Alignment(yaw, float(their_mean[0] - turned[0]), float(their_mean[1] - turned[1]))


def rms_distance(track: NDArray[Any], truth: NDArray[Any]) -> float:
    """Return the root mean square of the Euclidean distance between rows, m."""
    return sqrt(float(np.mean(np.sum((np.asarray(track, np.float64) - truth) ** 2, axis=1))))


def path_length(points: NDArray[Any]) -> float:
    """Return the length of the polyline through the points, m."""
    return float(np.sum(np.linalg.norm(np.diff(np.asarray(points, np.float64), axis=0), axis=1)))


def distances(points: NDArray[Any]) -> Floats:
    """Return the horizontal distance from the first of `points` to each, along the polyline through them, m."""
    lengths = np.linalg.norm(np.diff(np.asarray(points, np.float64)[:, :2], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(lengths)])


def aligned_at_start(track: NDArray[Any], truth: NDArray[Any], over: float) -> Floats:
    """Return `track` turned and shifted so that it fits `truth` best over the first `over` m along the truth."""
    first = max(2, int(np.searchsorted(distances(truth), over)) + 1)
    return align(track[:first], truth[:first]).apply(track)


@frozen
class TrackError:
    """Distance of a whole track from the truth after the best turn and shift, m."""

    rms_2d: float
    """Root mean square of the horizontal Euclidean distance, m."""
    rms_3d: float
    """Root mean square of the 3D distance, m, after the mean height difference is removed."""
    rms_z: float
    """Root mean square of the height error, m, after the mean height difference is removed."""

    @property
    def armse_2d(self) -> float:
        """Horizontal error as pyshoe defines it, m: RMS over the samples of both axes, which is `rms_2d` / sqrt 2."""
        return self.rms_2d / sqrt(2.0)


def track_error(track: NDArray[Any], truth: NDArray[Any]) -> TrackError:
    """Return the error of `track` (n,3) against `truth` (n,3), m; equal rows are the same instant."""
    moved = align(track, truth).apply(track)
    moved[:, 2] += float(np.mean(truth[:, 2] - moved[:, 2]))
    return TrackError(
        rms_2d=rms_distance(moved[:, :2], truth[:, :2]),
        rms_3d=rms_distance(moved, truth),
        rms_z=rms_distance(moved[:, 2:], truth[:, 2:]),
    )


def at_times(t: Floats, positions: Floats, times: NDArray[Any]) -> Floats:
    """Return positions at `times`, s: linear between `positions` (n,k) at `t` (n,), s; constant before and after."""
    return np.column_stack([np.interp(times, t, positions[:, axis]) for axis in range(positions.shape[1])])


def position_errors(times: NDArray[Any], places: NDArray[Any], track_t: Floats, track: Floats) -> Floats:
    """Return the horizontal distance (n+1,), m, from each surveyed place to the live track at the place's time.

    The track is first turned and shifted to fit the surveyed places of the first two metres of path best."""
    truth = np.asarray(places, np.float64)[:, :2]
    moved = aligned_at_start(at_times(track_t, track[:, :2], times), truth, ALIGNMENT_LENGTH)
    return np.asarray(np.linalg.norm(moved - truth, axis=1), dtype=np.float64)
