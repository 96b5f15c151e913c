"""Many places at which the wearer may be, and what they come to together.

Each is one reading of the track: where the wearer is now, how the track lies in the plan (turned and stretched), and
how much it is believed. Its numbers have few digits, since there are many of them and a snapshot must be small.
"""

from __future__ import annotations

from math import atan2, hypot, sqrt
from struct import Struct

from ...events import Candidate
from ...floorplan.plan import FloorPlan
from ...types.attrs import evolve

Row = tuple[float, float, float, float, float, int, int, int]
"""x, y: m, plan frame, less the `FloorPlan.origin`. a, b: a move (dx, dy) of the track is (a dx - b dy, b dx + a dy)
of the plan: a turn and a stretch. Weight. Level, as an index into the plan's. Where it came from: 0 the start, else one
more than the index of a connector. Where it may be changing level: 0 nowhere, else Landing.index."""

_DIGITS = Struct("<ffeee")
"""x, y are kept as float32, a, b and the weight as float16."""

FAR = 1e5
"""Nothing is so far from the origin of a plan, m."""
SAME = 3.0
"""Places within this of each other's mean are one candidate, m, when the track lies there in nearly the same way ..."""
NEAR = 1.5
"""... and within this when it does not."""
ALIKE = 0.87
"""Cosine of the angle between two ways in which the track lies."""
AGREED = 1.5
"""All places together are one candidate when they differ by no more (rms), m."""
CANDIDATES = 16
"""No more are told; others count to the nearest."""
FAINT = 0.002
"""A candidate of less weight counts to the heaviest."""


def rounded(rows: list[Row]) -> list[Row]:
    """The rows, the weights so that the largest is 1; those that are too far or too light to keep are left out. a, b
    and the weight keep three digits: a turn by 0.0005 rad is less than any track is good for."""
    most = max([row[4] for row in rows], default=0.0)
    if not most > 0.0:
        return []
    k, pack, unpack = 1.0 / most, _DIGITS.pack, _DIGITS.unpack
    return [
        (*unpack(pack(x, y, a, b, w * k)), level, origin, held)
        for x, y, a, b, w, level, origin, held in rows
        if -FAR < x < FAR and -FAR < y < FAR and w * k > 1e-5
    ]


def resampled(rows: list[Row], count: int, offset: float) -> list[Row]:
    """`count` rows that stand for all, each drawn as often as the root of its weight says (systematic resampling;
    `offset` in 0 to 1) and weighing as much, so that belief is as it was: what is little believed stays among them."""
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
    """How many rows of equal roots of weights would be as good."""
    total = sum([row[4] for row in rows])
    roots = sum([sqrt(row[4]) for row in rows])
    return roots * roots / total if total > 0.0 else 0.0


def believed(
    rows: list[Row], plan: FloorPlan, heights: dict[int, float], track: float | None, agreed: float = AGREED
) -> tuple[tuple[Candidate, ...], float]:
    """The candidates, heaviest first, and the rms distance of all from the first one's place, m. `heights`: of those
    who change level, by where they entered, m, plan frame. `track`: m, the height to be told where the plan knows none,
    else None. `agreed`: all are one candidate when they differ by no more (rms), m. At least one row. Places are
    rounded to a millimetre: they are kept."""
    origin = plan.origin
    groups = _grouped(rows, agreed)
    total = sum([group[0] for group in groups])
    groups.sort(key=_weight, reverse=True)
    kept = [group for group in groups if group[0] >= FAINT * total] or groups[:1]
    rest = total - sum([group[0] for group in kept])
    told = []
    for group in kept:
        weight, x, y, a, b, length, level, came, held = group
        share = (weight + (rest if group is kept[0] else 0.0)) / total if len(kept) > 1 else 1.0
        floor = track if track is not None else heights.get(held, 0.0) if held else plan.levels[level].elevation
        position = (round(origin[0] + x / weight, 3), round(origin[1] + y / weight, 3), round(floor, 3))
        heading = round(atan2(b, a), 4) if hypot(a, b) > 0.5 * length else None
        name = plan.connectors[came - 1].name if came else "start"
        told.append(Candidate(plan.levels[level].id, position, heading, round(share, 5), name))
    bx, by = kept[0][1] / kept[0][0], kept[0][2] / kept[0][0]
    squares = sum([row[4] * ((row[0] - bx) ** 2 + (row[1] - by) ** 2) for row in rows])
    if len(told) > 1:
        told[0] = evolve(told[0], weight=1.0 - sum([one.weight for one in told[1:]]))
    return tuple(told), sqrt(squares / total)


_Group = tuple[float, float, float, float, float, float, int, int, int]
"""Sums over weight, weighted x, y, a, b and length of (a, b); level, where the first one came from, whether held."""


def _weight(group: _Group) -> float:
    return group[0]


def _grouped(rows: list[Row], agreed: float) -> list[_Group]:
    """All as one where they agree, else by nearness."""
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
    if one and square / sw - (sx * sx + sy * sy) / (sw * sw) < agreed * agreed:
        # the length of (a, b) is near 1 for all
        whole = (sw, sx, sy, sa, sb, sw, level, came, held)
        return [whole]
    groups: list[_Group] = []
    for x, y, a, b, w, at, came, held in sorted(rows, key=_row_weight, reverse=True):
        best, nearest = -1, SAME * SAME
        full = len(groups) >= CANDIDATES
        if full:
            nearest = 5.0 * FAR * FAR
        long = w * sqrt(a * a + b * b)
        for k, (gw, gx, gy, ga, gb, gl, level, _, _) in enumerate(groups):
            if level == at or full:
                away = (gx / gw - x) ** 2 + (gy / gw - y) ** 2 + (0.0 if level == at else FAR * FAR)
                if away < nearest and (full or away < NEAR * NEAR or w * (ga * a + gb * b) > ALIKE * gl * long):
                    best, nearest = k, away
        if best < 0:
            if full:
                best = 0
            else:
                groups.append((w, w * x, w * y, w * a, w * b, long, at, came, held))
                continue
        gw, gx, gy, ga, gb, gl, level, origin, still = groups[best]
        if level != at:  # there is no room for it: its weight counts, its place does not
            more = (gw + w) / gw
            groups[best] = (gw * more, gx * more, gy * more, ga * more, gb * more, gl * more, level, origin, still)
        else:
            groups[best] = (gw + w, gx + w * x, gy + w * y, ga + w * a, gb + w * b, gl + long, level, origin, still)
    return groups


def _row_weight(row: Row) -> float:
    return row[4]
