"""Correction of both tracks by a position that a person has reported."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

from ...events import PositionRejected, PositionReported, TrackRevised
from ..fuse.common_error import HEADING, CommonError, Move, X, Y
from ..fuse.position_covariance import position_covariance
from .walked_path import WalkedPath

POSITION_GATE = 11.8
"""Largest squared distance of a reported position from the track, divided by its variance: 99.7 % of right ones (chi
square, two degrees of freedom)."""
LEAST_SIGMA = 0.05
"""Least standard deviation of a report, m: the middle between two feet is known no better."""
Pair = tuple[float, float]
"""A position or a displacement in the horizontal plane, m."""


def use_position(
    event: PositionReported,
    place: Callable[[], Pair],
    error: CommonError,
    path: WalkedPath,
    move_both: Callable[[Move], None],
) -> TrackRevised | PositionRejected:
    """Correct both tracks with `move_both` by a reported position, and revise the path; or reject the position.

    `place` returns where the wearer is according to the track, m, common frame. The innovation gate is
    z' S^-1 z < POSITION_GATE, where S is the covariance of the position (position_covariance.py) with that of the
    report. A report also corrects the heading, the drift and the bias, in so far as they have moved the wearer."""
    (x, y), was = event.position or (0.0, 0.0), place()
    sigma = max(event.sigma, LEAST_SIGMA)
    zx, zy, r, p = x - was[0], y - was[1], sigma * sigma, error.covariance
    xx, xy, yy = position_covariance(error, was)
    sx, sy = xx + r, yy + r
    determinant = sx * sy - xy * xy
    square = (zx * zx * sy - 2.0 * zx * zy * xy + zy * zy * sx) / determinant
    distance = sqrt(zx * zx + zy * zy)
    if square > POSITION_GATE:
        off = distance / sqrt(square)
        what = (
            f"this is {distance:.0f} m from where the track is, which is known to {off:.1f} m there: the track stays "
            "as it is. If the place is right, the track is wrong; start a new session there"
        )
        return PositionRejected(t=event.t, known_at=event.known_at, distance=distance, sigma=off, what=what)
    # what the linear covariance lacks, because of large headings and of lengths, counts as an error of the report
    more_x, more_y = max(0.0, xx - p[X][X]), max(0.0, yy - p[Y][Y])
    first = error.correct(list(p[X]), zx, p[X][X] + more_x + r, 1.0)
    move_both(first)
    second = error.correct(list(p[Y]), y - place()[1], p[Y][Y] + more_y + r, 1.0)
    move_both(second)
    turn, now = first[HEADING] + second[HEADING], place()
    by = (now[0] - was[0], now[1] - was[1])
    nodes = path.revise(event.t, was, now, turn)
    return TrackRevised(t=event.t, known_at=event.known_at, by=by, turn=turn, nodes=nodes)
