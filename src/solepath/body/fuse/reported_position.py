"""Correction of both tracks by a position that a person has reported, and what becomes of the path walked so far."""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable, Sequence
from itertools import accumulate, pairwise
from math import exp, fsum, hypot, sqrt

from ...events import PositionRejected, PositionReported, TrackNode, TrackRevised
from ...foot.world import Covariance2
from ...types import Vec2
from ...types.attrs import evolve, frozen
from ...types.vector import pair
from .common_error import HEADING, LEAST_WAY, LENGTH_ERROR, POSITION_GATE, CommonError, Move, X
from .position import PlanStart
from .walked_path import FIRST_SPACING, NotedPlace, WalkedPath

AGREEMENT_GATE = 6.0
"""Largest squared difference of the way between two rejected positions from that of the track, divided by its variance,
if both are used: 95 % of right ones."""
LEAST_SIGMA = 0.05
"""Least standard deviation of a report, m: the middle between two feet is known no better."""
START_HEADING = 0.14
"""Standard deviation of the first heading on a floor plan, rad: up to 0.24 rad either way (place/arrivals.py)."""
REJECTED = ""
"""Name of the place where the newest rejected position was reported; no other place has an empty name."""
MOST_PLACES = 8
"""Largest number of places with a name, each of which has two rows of the common errors."""
WALKING_NOISE = 0.02
"""Random walk of the position by the strides themselves, m/sqrt(m): 2 cm for a stride of 1 m (assumed)."""
ROUNDS = 4
"""Number of times that the headings of a path are estimated, each from those before."""


@frozen
class ReportedPosition:
    """A report, and the tracks that it corrects.

    A place with a new name is noted. When the name comes again, the wearer is at the same position, so the errors of
    the track now and then differ by as much as the track does. Every other report is a position. It also corrects the
    heading, the drift and the bias, in so far as they have moved the wearer. The innovation gate is
    z' S^-1 z < POSITION_GATE, where S is the covariance of the way (`position_covariance`) with that of the report.

    A rejected position is noted as a place. If the next one is rejected too, but the way between them is that of the
    track, both are right, and the track was lost before the first: the variance of the track there and here grows by
    the square of the distance, and both positions are used."""

    event: PositionReported
    place: Callable[[], complex]
    """Function that returns where the wearer is according to the track, m, common frame."""
    error: CommonError
    path: WalkedPath
    move_both: Callable[[Move], None]
    """Function that corrects both tracks."""

    def use(self) -> list[TrackRevised | PositionRejected]:
        """Correct the tracks and revise the path, or reject the position; a new place is noted without an event."""
        event, error, path, was = self.event, self.error, self.path, self.place()
        variance = max(event.sigma, LEAST_SIGMA) ** 2
        named = path.visit(event.place) if event.place else None
        if event.place and named is None:
            self._note_place(event.place, was, variance)
            return []
        target = complex(*(event.position or (0.0, 0.0))) if named is None else error.aid(named)
        off, turn = target - was, 0.0
        square = self._square(off, variance, named)
        if square > POSITION_GATE:
            rejected = None if named is not None else path.visit(REJECTED)
            first = None if path.rejected is None else complex(*path.rejected)
            if rejected is None or first is None or not self._confirms(first, target, variance, rejected):
                if named is None:
                    self._note_place(REJECTED, was, variance)
                    path.rejected = pair(target)
                return [self._rejection(hypot(off.real, off.imag), square)]
            self._raise_variance((off * off.conjugate()).real)
            # the variance of the first report is in the rows of its place already
            turn += self._correct(first, rejected, None, LEAST_SIGMA * LEAST_SIGMA)
        heading = error.covariance[HEADING][HEADING]
        self._spread(named)
        turn += self._correct(target, X, named, variance)
        now = self.place()
        nodes = self._revise_path(was, now, (heading, variance), settles=named is None)
        return [TrackRevised(t=event.t, known_at=event.known_at, by=pair(now - was), turn=turn, nodes=nodes)]

    def _note_place(self, name: str, position: complex, variance: float) -> None:
        """Note that the wearer is at the place `name`, whose estimate is `position`, m, common frame.

        `variance` is that of the report, m^2. The errors of the place are from now on those that the track has now."""
        path, error, p = self.path, self.error, self.error.covariance
        old = path.places.pop(name, None)
        names = [one for one in path.places if one]
        if old is None and name and len(names) >= MOST_PLACES:
            old = path.places.pop(names[0])
        first = error.add_aids((0.0, 0.0), (0.0, 0.0)) if old is None else old.first
        error.renew_aid(first, position, 0.0)
        for axis, row in enumerate((first, first + 1)):
            now = list(p[X + axis])
            now[first : first + 2] = now[X : X + 2]
            for j, value in enumerate(now):
                p[row][j] = p[j][row] = value
            p[row][row] += variance
        path.add_node(TrackNode(self.event.t, position.real, position.imag))
        path.places[name] = NotedPlace(first, len(path.nodes) - 1)

    def _covariance(self, since: int | None) -> Covariance2:
        """Return the covariance of the way from the known position, or from the place whose rows begin at `since`."""
        start = complex(*self.path.known) if since is None else self.error.aid(since)
        return self.error.position_covariance(self.place() - start, since)

    def _square(self, off: complex, variance: float, since: int | None) -> float:
        """Return the squared innovation `off`, m, divided by its variance."""
        zx, zy, (xx, xy, yy) = off.real, off.imag, self._covariance(since)
        sx, sy = xx + variance, yy + variance
        return (zx * zx * sy - 2.0 * zx * zy * xy + zy * zy * sx) / (sx * sy - xy * xy)

    def _spread(self, since: int | None) -> None:
        """Give the position the moments that it has with a heading error h of any size, and with lengths that are off.

        The way from the known position, or from the place whose rows begin at `since`, is off by b h + z, with
        b = P_eh / P_hh; beyond small errors by b sin h, and by as much as `position_covariance` has. With h normal,
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

    def _confirms(self, first: complex, target: complex, variance: float, rejected: int) -> bool:
        """Return whether the way from the rejected position `first`, m, to this one is that of the track.

        `variance` is that of this report; that of the first is in the rows of its place, from `rejected` on."""
        way = self.place() - self.error.aid(rejected)
        other = target - first - way
        return hypot(way.real, way.imag) > LEAST_WAY and self._square(other, variance, rejected) < AGREEMENT_GATE

    def _raise_variance(self, variance: float) -> None:
        """Raise the variance of the wearer's position together with that of all places since the rejected position."""
        p, places = self.error.covariance, self.path.places
        since = places[REJECTED].node
        rows = [X, *[place.first for place in places.values() if place.node >= since]]
        for axis in (0, 1):
            for i in rows:
                for j in rows:
                    p[i + axis][j + axis] += variance

    def _correct(self, target: complex, of: int, since: int | None, variance: float) -> float:
        """Correct all errors by a measured position and return the correction of the heading, rad.

        It is that of the wearer or of a place, whose rows begin at `of`, with this `variance`, m^2. With `since`, the
        wearer is at that place."""
        error, turn = self.error, 0.0
        for axis in (0, 1):
            terms = [(of + axis, 1.0), *([] if since is None else [(since + axis, -1.0)])]
            is_at = self.place() if of == X else error.aid(of)
            z = (target if since is None else error.aid(since)) - is_at
            move = error.correct_by(terms, z.imag if axis else z.real, variance)
            self.move_both(move)
            turn += move[HEADING]
        return turn

    def _rejection(self, distance: float, square: float) -> PositionRejected:
        event, off, known_at = self.event, distance / sqrt(square), self.path.known_at
        where = f"where {event.place} was before" if event.place else "where the track is"
        what = f"this is {distance:.1f} m from {where}, which is known to {off:.1f} m: the track stays as it is"
        if not event.place:
            if known_at is not None:
                what += f". The position reported {event.t - known_at:.0f} s before, which fits the track, "
                what += "contradicts it too"
            what += f". If it is right, report another place {LEAST_WAY:.0f} m on: two that agree are believed"
        return PositionRejected(t=event.t, known_at=event.known_at, distance=distance, sigma=off, what=what)

    def _revise_path(self, was: complex, now: complex, variances: Vec2, settles: bool) -> tuple[TrackNode, ...]:
        """Revise the nodes since the newest known position, because the wearer is at `now`, m, instead of at `was`.

        The path is turned piece by piece, so that it leads there (`_turned`); what is left of the correction is
        distributed along it, and it leads through the places whose estimates have moved. `variances` are that of the
        heading at the wearer before the correction, rad^2, and that of the report, m^2. Returns the revised nodes, the
        last of which is the one at the time of the report. If the position `settles` the path, it stays as it is up to
        there."""
        path, t, (heading, variance) = self.path, self.event.t, variances
        old = [*[complex(node.x, node.y) for node in path.nodes], was]
        pieces = [b - a for a, b in pairwise(old)]
        distances = [0.0, *accumulate([hypot(piece.real, piece.imag) for piece in pieces])]
        turned = _turned(pieces, distances, now - old[0], (path.heading_variance, heading), variance)
        bent = [old[0] + one for one in accumulate(turned, initial=0j)]
        ends = {0: bent[0], len(old) - 1: now}
        for place in path.places.values():
            if 0 < place.node < len(old) - 1:
                ends[place.node] = self.error.aid(place.first)
        times = [*[node.t for node in path.nodes], t]
        revised = zip(times, _distributed(bent, distances, ends), strict=True)
        nodes = [TrackNode(then, position.real, position.imag) for then, position in revised]
        if settles:
            path.nodes, path.walked, path.spacing, path.rejected = [nodes[-1]], 0.0, FIRST_SPACING, None
            path.places = {name: evolve(one, node=0) for name, one in path.places.items()}
            path.known, path.known_at = pair(now), t
            path.heading_variance = max(0.0, self.error.covariance[HEADING][HEADING])
        else:
            path.nodes = nodes[:-1]
            path.add_node(nodes[-1])
        return tuple(nodes)


def _turned(
    pieces: list[complex], distances: list[float], way: complex, headings: Vec2, variance: float
) -> list[complex]:
    """Return the pieces of a path, each turned by its most probable error of the heading, if the path leads to `way`.

    All are in m. The error at the distance u, as a share of the whole, is a normal process: it has the first of the
    variances `headings`, rad^2, at the beginning, and grows to the second, half of it by a drift and half by a random
    walk. Its covariance is k(u, v) = first + (second - first) (u v + min(u, v)) / 2. `variance` is that of the end,
    m^2. With G, how the end moves with each heading (`across`), the headings are K G' (G K G' + R)^-1 z for what the
    end is off by, z. G is that of the newest headings, so this is repeated (Gauss-Newton). For very large errors it may
    not converge; what is left is distributed along the path afterwards."""
    whole = max(distances[-1], 1e-9)
    shares = [0.5 * (a + b) / whole for a, b in pairwise(distances)]
    first, growth = headings[0], 0.5 * max(0.0, headings[1] - headings[0])
    noise = variance + WALKING_NOISE * WALKING_NOISE * whole
    angles, turned, square = [0.0] * len(pieces), pieces, LENGTH_ERROR**2
    for _ in range(ROUNDS):
        # spread is K G': the sums over min(u, v) are those up to u, and u times those beyond
        across = [1j * piece for piece in turned]
        moments = [u * one for u, one in zip(shares, across, strict=True)]
        total, moment, before, before_moment = _sum(across), _sum(moments), 0j, 0j
        spread: list[complex] = []
        for one, its_moment, u in zip(across, moments, shares, strict=True):
            before, before_moment = before + one, before_moment + its_moment
            spread.append(first * total + growth * (u * moment + before_moment + u * (total - before)))
        gx = _sum([one.real * moved for one, moved in zip(across, spread, strict=True)])
        gy = _sum([one.imag * moved for one, moved in zip(across, spread, strict=True)])
        xx, yy = noise + square * way.real**2 + gx.real, noise + square * way.imag**2 + gy.imag
        xy = square * way.real * way.imag + gx.imag
        z = way - _sum(turned) + _sum([angle * one for angle, one in zip(angles, across, strict=True)])
        determinant = xx * yy - xy * xy
        gain_x = (yy * z.real - xy * z.imag) / determinant
        gain_y = (xx * z.imag - xy * z.real) / determinant
        angles = [one.real * gain_x + one.imag * gain_y for one in spread]
        turned = [piece * rect(1.0, angle) for piece, angle in zip(pieces, angles, strict=True)]
    return turned


def _sum(vectors: Sequence[complex]) -> complex:
    return complex(fsum([one.real for one in vectors]), fsum([one.imag for one in vectors]))


def _distributed(path: list[complex], distances: list[float], ends: dict[int, complex]) -> list[complex]:
    """Return the path through the positions in `ends` by the numbers of their nodes, moved linearly in between.

    `distances` are those from the first node along the path, m."""
    moved = [path[0]]
    for a, b in pairwise(sorted(ends)):
        at_a, at_b = ends[a] - path[a], ends[b] - path[b]
        length = max(distances[b] - distances[a], 1e-9)
        for k in range(a + 1, b):
            share = (distances[k] - distances[a]) / length
            moved.append(path[k] + at_a + share * (at_b - at_a))
        moved.append(ends[b])
    return moved


def in_world_frame(event: PositionReported, plan_start: PlanStart | None) -> PositionReported | None:
    """Return the report in the world frame; None if it is on the floor plan and the world's place there is not known.

    What the first place and the first heading on the plan may be off by counts as an error of the report."""
    if not event.level or event.position is None:
        return event
    if plan_start is None:
        return None
    off = complex(*event.position) - complex(*plan_start.place)
    sigma = sqrt(event.sigma**2 + 0.5 * plan_start.spread**2 + START_HEADING**2 * (off * off.conjugate()).real)
    return evolve(event, position=pair(off * rect(1.0, -plan_start.heading)), sigma=sigma)
