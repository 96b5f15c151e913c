"""Correction of both tracks by a position that a person has reported."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, exp, hypot, sin, sqrt

from ...events import PositionRejected, PositionReported, TrackRevised
from ...types.attrs import evolve, frozen
from ..fuse.common_error import HEADING, CommonError, Move, X
from ..fuse.position_covariance import LEAST_WAY, POSITION_GATE, position_covariance
from .path_revision import estimate, note_place, revise_path, visit
from .walked_path import PlanStart, WalkedPath

AGREEMENT_GATE = 6.0
"""Largest squared difference of the way between two rejected positions from that of the track, divided by its variance,
if both are used: 95 % of right ones."""
LEAST_SIGMA = 0.05
"""Least standard deviation of a report, m: the middle between two feet is known no better."""
START_HEADING = 0.14
"""Standard deviation of the first heading on a floor plan, rad: up to 0.24 rad either way (place/arrivals.py)."""
REJECTED = ""
"""Name of the place where the newest rejected position was reported; no other place has an empty name."""
Pair = tuple[float, float]
"""A position or a displacement in the horizontal plane, m."""


@frozen
class ReportedPosition:
    """A report, and the tracks that it corrects.

    A place with a new name is noted. When the name comes again, the wearer is at the same position, so the errors of
    the track now and then differ by as much as the track does. Every other report is a position. It also corrects the
    heading, the drift and the bias, in so far as they have moved the wearer. The innovation gate is
    z' S^-1 z < POSITION_GATE, where S is the covariance of the way (position_covariance.py) with that of the report.

    A rejected position is noted as a place. If the next one is rejected too, but the way between them is that of the
    track, both are right, and the track was lost before the first: the variance of the track there and here grows by
    the square of the distance, and both positions are used."""

    event: PositionReported
    place: Callable[[], Pair]
    """Function that returns where the wearer is according to the track, m, common frame."""
    error: CommonError
    path: WalkedPath
    move_both: Callable[[Move], None]
    """Function that corrects both tracks."""

    def use(self) -> list[TrackRevised | PositionRejected]:
        """Correct the tracks and revise the path, or reject the position; a new place is noted without an event."""
        event, error, path, was = self.event, self.error, self.path, self.place()
        variance = max(event.sigma, LEAST_SIGMA) ** 2
        named = visit(path, event.place) if event.place else None
        if event.place and named is None:
            note_place(path, event.place, event.t, was, variance, error)
            return []
        target = (event.position or (0.0, 0.0)) if named is None else estimate(named, error)
        off, turn = _minus(target, was), 0.0
        square = self._square(off, variance, named)
        if square > POSITION_GATE:
            rejected = None if named is not None else visit(path, REJECTED)
            first = path.rejected
            if rejected is None or first is None or not self._confirms(first, target, variance, rejected):
                if named is None:
                    note_place(path, REJECTED, event.t, was, variance, error)
                    path.rejected = target
                return [self._rejection(hypot(*off), square)]
            self._raise_variance(off[0] * off[0] + off[1] * off[1])
            # the variance of the first report is in the rows of its place already
            turn += self._correct(first, rejected, None, LEAST_SIGMA * LEAST_SIGMA)
        heading = error.covariance[HEADING][HEADING]
        self._spread(named)
        turn += self._correct(target, X, named, variance)
        now = self.place()
        nodes = revise_path(path, event.t, was, now, (heading, variance), error, settles=named is None)
        by = _minus(now, was)
        return [TrackRevised(t=event.t, known_at=event.known_at, by=by, turn=turn, nodes=nodes)]

    def _covariance(self, since: int | None) -> tuple[float, float, float]:
        """Return the covariance of the way from the known position, or from the place whose rows begin at `since`."""
        start = self.path.known if since is None else estimate(since, self.error)
        return position_covariance(self.error, _minus(self.place(), start), since)

    def _square(self, off: Pair, variance: float, since: int | None) -> float:
        """Return the squared innovation `off`, m, divided by its variance."""
        (zx, zy), (xx, xy, yy) = off, self._covariance(since)
        sx, sy = xx + variance, yy + variance
        return (zx * zx * sy - 2.0 * zx * zy * xy + zy * zy * sx) / (sx * sy - xy * xy)

    def _spread(self, since: int | None) -> None:
        """Give the position the moments that it has with a heading error h of any size, and with lengths that are off.

        The way from the known position, or from the place whose rows begin at `since`, is off by b h + z, with
        b = P_eh / P_hh; beyond small errors by b sin h, and by as much as position_covariance.py has. With h normal,
        E (sin h) q = E h q exp(-P_hh / 2) for every q that is normal with it."""
        p, v = self.error.covariance, max(self.error.covariance[HEADING][HEADING], 1e-12)
        xx, xy, yy = self._covariance(since)
        less = (1.0 - exp(-0.5 * v)) / v
        heading, rows = list(p[HEADING]), []
        for axis in (0, 1):
            base = [0.0] * len(p) if since is None else list(p[since + axis])
            way = [one - of_place for one, of_place in zip(p[X + axis], base, strict=True)]
            arm = less * way[HEADING]
            rows.append((base, [one - arm * with_heading for one, with_heading in zip(way, heading, strict=True)]))
        own = ((xx, xy), (xy, yy))
        for axis, (base, way) in enumerate(rows):
            for j in range(HEADING, len(p)):
                p[X + axis][j] = p[j][X + axis] = base[j] + way[j]
        for i, j in ((0, 0), (0, 1), (1, 1)):
            value = own[i][j]
            if since is not None:  # e = place + way
                value += rows[i][1][since + j] + rows[j][1][since + i] + p[since + i][since + j]
            p[X + i][X + j] = p[X + j][X + i] = value

    def _confirms(self, first: Pair, target: Pair, variance: float, rejected: int) -> bool:
        """Return whether the way from the rejected position `first`, m, to this one is that of the track.

        `variance` is that of this report; that of the first is in the rows of its place, from `rejected` on."""
        way = _minus(self.place(), estimate(rejected, self.error))
        other = _minus(target, first)
        return hypot(*way) > LEAST_WAY and self._square(_minus(other, way), variance, rejected) < AGREEMENT_GATE

    def _raise_variance(self, variance: float) -> None:
        """Raise the variance of the wearer's position together with that of all places since the rejected position."""
        p, places = self.error.covariance, self.path.places
        since = places[REJECTED].node
        rows = [X, *[place.first for place in places.values() if place.node >= since]]
        for axis in (0, 1):
            for i in rows:
                for j in rows:
                    p[i + axis][j + axis] += variance

    def _correct(self, target: Pair, of: int, since: int | None, variance: float) -> float:
        """Correct all errors by a measured position and return the correction of the heading, rad.

        It is that of the wearer or of a place, whose rows begin at `of`, with this `variance`, m^2. With `since`, the
        wearer is at that place."""
        error, turn = self.error, 0.0
        for axis in (0, 1):
            terms = [(of + axis, 1.0), *([] if since is None else [(since + axis, -1.0)])]
            column = error.column(terms)
            is_at = self.place() if of == X else estimate(of, error)
            z = (target if since is None else estimate(since, error))[axis] - is_at[axis]
            move = error.correct(column, z, error.along(column, terms) + variance, 1.0)
            self.move_both(move)
            turn += move[HEADING]
        return turn

    def _rejection(self, distance: float, square: float) -> PositionRejected:
        event, off = self.event, distance / sqrt(square)
        where = f"where {event.place} was before" if event.place else "where the track is"
        other = ""
        if self.path.known_at is not None:
            other = f"The position reported {event.t - self.path.known_at:.0f} s before, which fits the track, "
            other += "contradicts it too. "
        what = (
            f"this is {distance:.1f} m from {where}, which is known to {off:.1f} m: the track stays as it is. {other}"
            f"If it is right, report another place {LEAST_WAY:.0f} m on: two that agree are believed"
        )
        if event.place:
            what = f"this is {distance:.1f} m from {where}, which is known to {off:.1f} m: the track stays as it is"
        return PositionRejected(t=event.t, known_at=event.known_at, distance=distance, sigma=off, what=what)


def in_world_frame(event: PositionReported, plan_start: PlanStart | None) -> PositionReported | None:
    """Return the report in the world frame; None if it is on the floor plan and the world's place there is not known.

    What the first place and the first heading on the plan may be off by counts as an error of the report."""
    if not event.level or event.position is None:
        return event
    if plan_start is None:
        return None
    x, y = _minus(event.position, plan_start.place)
    c, s = cos(plan_start.heading), sin(plan_start.heading)
    sigma = sqrt(event.sigma**2 + 0.5 * plan_start.spread**2 + START_HEADING**2 * (x * x + y * y))
    return evolve(event, position=(c * x + s * y, c * y - s * x), sigma=sigma)


def _minus(a: Pair, b: Pair) -> Pair:
    return (a[0] - b[0], a[1] - b[1])
