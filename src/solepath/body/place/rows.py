"""Rows: many places at which the wearer may be, and the candidates that follow from them.

Each row is one hypothesis: the wearer's place, the placement of the track in the plan (turn and stretch), and a weight.
Its numbers have few digits, since there are many rows and a snapshot must be small."""

from __future__ import annotations

from math import atan2, hypot, sqrt
from struct import Struct

from ...events import Candidate
from ...floorplan.plan import FloorPlan
from ...types.attrs import evolve

Row = tuple[float, float, float, float, float, int, int, int]
"""One hypothesis: x, y, a, b, weight, level, origin, landing.

x, y: m, plan frame, less the `FloorPlan.origin`. a, b: a move (dx, dy) of the track is (a dx - b dy, b dx + a dy) in
the plan: a turn and a stretch. Level: its index in the plan. Origin: 0 for the start, else the index of a connector
plus one. Landing at which it may be changing level: `Landing.index`, 0 for none."""

_DIGITS = Struct("<ffeee")
"""Digits of a row: x, y are kept as float32, a, b and the weight as float16."""

FARTHEST = 1e5
"""Largest distance from the origin of a plan, m."""
SAME_PLACE = 3.0
"""Largest distance from the mean of a candidate's places, m, when the track lies nearly the same way."""
NEAR_PLACE = 1.5
"""Largest distance from the mean of a candidate's places, m, when the track lies another way."""
SAME_TURN = 0.87
"""Cosine of the largest angle between two placements of the track that count as the same way."""
ONE_CANDIDATE = 1.5
"""Largest deviation (rms) at which all places are one candidate, m."""
MOST_CANDIDATES = 16
"""Largest number of candidates; other rows count to the nearest."""
LEAST_WEIGHT = 0.002
"""Least weight of a candidate; a lighter one counts to the heaviest."""


def rounded(rows: list[Row]) -> list[Row]:
    """Return the rows as they are kept, the largest weight scaled to 1, without those that are too far or too light.

    a, b and the weight keep three digits: a turn by 0.0005 rad is finer than any track."""
    most = max([row[4] for row in rows], default=0.0)
    if not most > 0.0:
        return []
    k, pack, unpack = 1.0 / most, _DIGITS.pack, _DIGITS.unpack
    return [
        (*unpack(pack(x, y, a, b, w * k)), level, origin, held)
        for x, y, a, b, w, level, origin, held in rows
        if -FARTHEST < x < FARTHEST and -FARTHEST < y < FARTHEST and w * k > 1e-5
    ]


def resampled(rows: list[Row], count: int, offset: float) -> list[Row]:
    """Return `count` rows that stand for all (systematic resampling; `offset` in 0 to 1).

    Each row is drawn as often as the root of its weight says, with that root as weight: the distribution stays as it
    was, and rows of low weight stay among them."""
    roots = [sqrt(row[4]) for row in rows]
    step = sum(roots) / count
    if not step > 0.0:
        return []
    due, reached = offset * step, 0.0
    drawn: list[Row] = []
    for root, (x, y, a, b, _, level, origin, held) in zip(roots, rows, strict=True):
        reached += root
        while due < reached and len(drawn) < count:
            drawn.append((x, y, a, b, root, level, origin, held))
            due += step
    return drawn


def effective(rows: list[Row]) -> float:
    """Return the effective number of rows, by the roots of their weights."""
    total = sum([row[4] for row in rows])
    roots = sum([sqrt(row[4]) for row in rows])
    return roots * roots / total if total > 0.0 else 0.0


def candidates_of(
    rows: list[Row], plan: FloorPlan, heights: dict[int, float], track: float | None, limit: float = ONE_CANDIDATE
) -> tuple[tuple[Candidate, ...], float]:
    """Return the candidates, heaviest first, and the rms distance of all rows from the first one's place, m.

    `heights`: height of the rows that change level, m, plan frame, by their landing of entry. `track`: height to be
    reported where the plan has none, m, else None. `limit`: all rows are one candidate when they deviate by no more
    (rms), m. There must be a row. Places are rounded to a millimetre, since they are kept."""
    origin = plan.origin
    groups = _grouped(rows, limit)
    total = sum([group[0] for group in groups])
    groups.sort(key=_weight, reverse=True)
    kept = [group for group in groups if group[0] >= LEAST_WEIGHT * total] or groups[:1]
    rest = total - sum([group[0] for group in kept])
    candidates = []
    for group in kept:
        weight, x, y, a, b, length, level, came, held = group
        share = (weight + (rest if group is kept[0] else 0.0)) / total if len(kept) > 1 else 1.0
        floor = track if track is not None else heights.get(held, 0.0) if held else plan.levels[level].elevation
        position = (round(origin[0] + x / weight, 3), round(origin[1] + y / weight, 3), round(floor, 3))
        heading = round(atan2(b, a), 4) if hypot(a, b) > 0.5 * length else None
        name = plan.connectors[came - 1].name if came else "start"
        candidates.append(Candidate(plan.levels[level].id, position, heading, round(share, 5), name))
    bx, by = kept[0][1] / kept[0][0], kept[0][2] / kept[0][0]
    squares = sum([row[4] * ((row[0] - bx) ** 2 + (row[1] - by) ** 2) for row in rows])
    if len(candidates) > 1:
        candidates[0] = evolve(candidates[0], weight=1.0 - sum([one.weight for one in candidates[1:]]))
    return tuple(candidates), sqrt(squares / total)


_Group = tuple[float, float, float, float, float, float, int, int, int]
"""Sums over weight, weighted x, y, a, b and length of (a, b); level, origin and landing of the first row."""


def _weight(group: _Group) -> float:
    return group[0]


def _grouped(rows: list[Row], limit: float) -> list[_Group]:
    """Return all rows as one group where they agree, else grouped by distance."""
    _, _, _, _, _, level, came, held = rows[0]
    whole = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, level, came, held)
    square, one = 0.0, True
    sw = sx = sy = sa = sb = 0.0
    for x, y, a, b, w, at, _, _ in rows:
        if at != level:
            one = False
            break
        sw += w
        sx += w * x
        sy += w * y
        sa += w * a
        sb += w * b
        square += w * (x * x + y * y)
    if one and square / sw - (sx * sx + sy * sy) / (sw * sw) < limit * limit:
        # the length of (a, b) is near 1 for all
        whole = (sw, sx, sy, sa, sb, sw, level, came, held)
        return [whole]
    groups: list[_Group] = []
    for x, y, a, b, w, at, came, held in sorted(rows, key=_row_weight, reverse=True):
        best, nearest = -1, SAME_PLACE * SAME_PLACE
        full = len(groups) >= MOST_CANDIDATES
        if full:
            nearest = 5.0 * FARTHEST * FARTHEST
        long = w * sqrt(a * a + b * b)
        for k, (gw, gx, gy, ga, gb, gl, level, _, _) in enumerate(groups):
            if level == at or full:
                away = (gx / gw - x) ** 2 + (gy / gw - y) ** 2 + (0.0 if level == at else FARTHEST * FARTHEST)
                if away < nearest and (
                    full or away < NEAR_PLACE * NEAR_PLACE or w * (ga * a + gb * b) > SAME_TURN * gl * long
                ):
                    best, nearest = k, away
        if best < 0:
            if full:
                best = 0
            else:
                groups.append((w, w * x, w * y, w * a, w * b, long, at, came, held))
                continue
        gw, gx, gy, ga, gb, gl, level, origin, still = groups[best]
        if level != at:  # the list is full: its weight counts, its place does not
            more = (gw + w) / gw
            groups[best] = (gw * more, gx * more, gy * more, ga * more, gb * more, gl * more, level, origin, still)
        else:
            groups[best] = (gw + w, gx + w * x, gy + w * y, ga + w * a, gb + w * b, gl + long, level, origin, still)
    return groups


def _row_weight(row: Row) -> float:
    return row[4]
