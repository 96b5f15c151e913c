"""Rows (hypotheses of the wearer's place), and the candidates that are derived from them.

Each row has the wearer's place, the rotation and scale of the track in the plan, and a weight. The numbers in a row
have few digits, because there are many rows and a snapshot must be small."""

from __future__ import annotations

from math import atan2, cos, fsum, hypot, sin, sqrt
from struct import Struct

from ...events import Candidate
from ...floorplan.plan import FloorPlan
from ...types.attrs import evolve

Row = tuple[float, float, float, float, float, int, int, int]
"""One hypothesis: x, y, a, b, weight, level, origin, landing.

x, y: place, m, plan frame minus `FloorPlan.origin`. a, b: rotation and stretch (scale); a move (dx, dy) of the track is
(a dx - b dy, b dx + a dy) in the plan. level: index of the level in the plan. origin of the hypothesis: 0
for the start, else the index of a connector plus one. landing: `Landing.index` of the landing at which the row may have
started to change level, 0 for none."""

_DIGITS = Struct("<eee")
"""Stored form of a, b and the weight of a row: float16."""
PLACES_PER_M = 128.0
"""Number of places of a row in a metre, 1/m: 8 mm apart, a quarter of `PLACE_ERROR` of a move, save 1 kB of a state."""

MAX_DISTANCE = 1e5
"""Largest distance of a row from the origin of the plan on each axis, m."""
CANDIDATE_RADIUS = 3.0
"""Largest distance of a row from the mean of its candidate, m, when the track's heading is nearly equal."""
NARROW_RADIUS = 1.5
"""Largest distance of a row from the mean of its candidate, m, for any heading of the track."""
MIN_TURN_COSINE = 0.87
"""Cosine of the largest angle between two headings of the track that count as nearly equal."""
ONE_CANDIDATE_SPREAD = 1.5
"""Largest rms deviation of the places of all rows at which they form one candidate, m."""
MAX_CANDIDATES = 16
"""Largest number of candidates; further rows are added to the nearest candidate."""
MIN_CANDIDATE_WEIGHT = 0.002
"""Least share of the weight of a candidate; lighter candidates are added to the heaviest."""
MIN_ROW_WEIGHT = 1e-5
"""Least weight of a row that is kept, as a share of the largest weight."""


def round_rows(rows: list[Row]) -> list[Row]:
    """Return the rows as stored, with the largest weight scaled to 1, without rows that are too far or too light.

    a, b and the weight keep three digits, because no track is more accurate than 0.0005 rad, and x and y 1/128 m."""
    most = max([row[4] for row in rows], default=0.0)
    if not most > 0.0:
        return []
    k, m, pack, unpack = 1.0 / most, PLACES_PER_M, _DIGITS.pack, _DIGITS.unpack
    return [
        (round(m * x) / m, round(m * y) / m, *unpack(pack(a, b, w * k)), level, origin, landing)
        for x, y, a, b, w, level, origin, landing in rows
        if -MAX_DISTANCE < x < MAX_DISTANCE and -MAX_DISTANCE < y < MAX_DISTANCE and w * k > MIN_ROW_WEIGHT
    ]


def resample_rows(rows: list[Row], count: int, offset: float) -> list[Row]:
    """Return `count` rows that represent all rows, by systematic resampling with `offset` from 0 to 1.

    Each row is drawn with a frequency proportional to the root of its weight, and gets that root as weight. The
    distribution stays the same, and more rows of low weight are kept."""
    roots = [sqrt(row[4]) for row in rows]
    step = fsum(roots) / count
    if not step > 0.0:
        return []
    threshold, cumulative = offset * step, 0.0
    drawn: list[Row] = []
    for root, (x, y, a, b, _, level, origin, landing) in zip(roots, rows, strict=True):
        cumulative += root
        while threshold < cumulative and len(drawn) < count:
            drawn.append((x, y, a, b, root, level, origin, landing))
            threshold += step
    return drawn


def effective_count(rows: list[Row]) -> float:
    """Return the effective number of rows, by the roots of their weights."""
    total = fsum([row[4] for row in rows])
    roots = fsum([sqrt(row[4]) for row in rows])
    return roots * roots / total if total > 0.0 else 0.0


def candidates_of(
    rows: list[Row],
    plan: FloorPlan,
    heights: dict[int, float],
    track_height: float | None,
    limit: float = ONE_CANDIDATE_SPREAD,
) -> tuple[tuple[Candidate, ...], float]:
    """Return the candidates, heaviest first, and the rms distance of all rows from the first candidate, m.

    `heights` has the height of rows that change level, m, plan frame, by landing of entry. `track_height` is the
    reported height when the plan has no heights, m, else None. All rows are one candidate when their rms deviation is
    below `limit`, m. There must be a row. Places are rounded to a millimetre, because they are saved."""
    origin = plan.origin
    groups = _group_rows(rows, limit)
    total = fsum([group[0] for group in groups])
    groups.sort(key=_weight, reverse=True)
    kept = [group for group in groups if group[0] >= MIN_CANDIDATE_WEIGHT * total] or groups[:1]
    rest = total - fsum([group[0] for group in kept])
    candidates = []
    for group in kept:
        weight, x, y, a, b, length, level, row_origin, landing = group
        share = (weight + (rest if group is kept[0] else 0.0)) / total if len(kept) > 1 else 1.0
        by_plan = heights.get(landing, 0.0) if landing else plan.levels[level].elevation
        height = by_plan if track_height is None else track_height
        position = (round(origin[0] + x / weight, 3), round(origin[1] + y / weight, 3), round(height, 3))
        heading = round(atan2(b, a), 4) if hypot(a, b) > 0.5 * length else None
        name = plan.connectors[row_origin - 1].name if row_origin else "start"
        candidates.append(Candidate(plan.levels[level].id, position, heading, round(share, 5), name))
    bx, by = kept[0][1] / kept[0][0], kept[0][2] / kept[0][0]
    squares = fsum([row[4] * ((row[0] - bx) ** 2 + (row[1] - by) ** 2) for row in rows])
    if len(candidates) > 1:
        candidates[0] = evolve(candidates[0], weight=1.0 - fsum([candidate.weight for candidate in candidates[1:]]))
    return tuple(candidates), sqrt(squares / total)


_Group = tuple[float, float, float, float, float, float, int, int, int]
"""Sums over rows of weight, weighted x, y, a, b and length of (a, b); level, origin and landing of the first row."""


def _weight(group: _Group) -> float:
    return group[0]


def _group_rows(rows: list[Row], limit: float) -> list[_Group]:
    """Return all rows as one group when their rms deviation is below `limit`, m; else grouped by distance."""
    _, _, _, _, _, level, row_origin, landing = rows[0]
    square, is_one_level = 0.0, True
    sw = sx = sy = sa = sb = 0.0
    for x, y, a, b, w, row_level, _, _ in rows:
        if row_level != level:
            is_one_level = False
            break
        sw += w
        sx += w * x
        sy += w * y
        sa += w * a
        sb += w * b
        square += w * (x * x + y * y)
    if is_one_level and square / sw - (sx * sx + sy * sy) / (sw * sw) < limit * limit:
        # the length of (a, b) is about 1 for all rows
        return [(sw, sx, sy, sa, sb, sw, level, row_origin, landing)]
    groups: list[_Group] = []
    centres: list[tuple[float, float, int]] = []
    for x, y, a, b, w, level, row_origin, landing in sorted(rows, key=_row_weight, reverse=True):
        length = w * sqrt(a * a + b * b)
        if len(groups) >= MAX_CANDIDATES:
            best = _nearest_centre(centres, x, y, level)
        else:
            best, nearest = -1, CANDIDATE_RADIUS * CANDIDATE_RADIUS
            for k, (cx, cy, centre_level) in enumerate(centres):
                if centre_level == level:
                    ex, ey = cx - x, cy - y
                    distance2 = ex * ex + ey * ey
                    if distance2 < nearest and (
                        distance2 < NARROW_RADIUS * NARROW_RADIUS or _has_heading(groups[k], w * a, w * b, length)
                    ):
                        best, nearest = k, distance2
            if best < 0:
                groups.append((w, w * x, w * y, w * a, w * b, length, level, row_origin, landing))
                centres.append((w * x / w, w * y / w, level))
                continue
        gw, gx, gy, ga, gb, gl, group_level, origin, entry = groups[best]
        if group_level == level:
            gw, gx, gy, ga, gb, gl = gw + w, gx + w * x, gy + w * y, ga + w * a, gb + w * b, gl + length
        else:  # the list is full: add the weight of the row, not its place
            ratio = (gw + w) / gw
            gw, gx, gy, ga, gb, gl = gw * ratio, gx * ratio, gy * ratio, ga * ratio, gb * ratio, gl * ratio
        groups[best] = (gw, gx, gy, ga, gb, gl, group_level, origin, entry)
        centres[best] = (gx / gw, gy / gw, group_level)
    return groups


def _has_heading(group: _Group, a: float, b: float, length: float) -> bool:
    """Return whether a heading (a, b) of this length is nearly equal to that of the group."""
    _, _, _, group_a, group_b, group_length, _, _, _ = group
    return group_a * a + group_b * b > MIN_TURN_COSINE * group_length * length


def _nearest_centre(centres: list[tuple[float, float, int]], x: float, y: float, level: int) -> int:
    """Return the index of the centre (x, y, level) nearest to a place; those of its level are nearer than others."""
    far = MAX_DISTANCE * MAX_DISTANCE
    distances2 = [(cx - x) ** 2 + (cy - y) ** 2 + (0.0 if on == level else far) for cx, cy, on in centres]
    return distances2.index(min(distances2))


def _row_weight(row: Row) -> float:
    return row[4]


def turn_rows(rows: list[Row], yaw: float) -> list[Row]:
    """Return the rows for a track that was turned by `yaw`, rad: their moves in the plan stay as they are."""
    c, s = cos(yaw), sin(yaw)
    return [(x, y, c * a + s * b, c * b - s * a, w, level, origin, at) for x, y, a, b, w, level, origin, at in rows]


def have_not_moved(rows: list[Row], previous: list[Row]) -> bool:
    """Return whether every row has the place of a previous row; checking the first one first is fast."""
    if rows:
        x, y = rows[0][:2]
        if not any([row[0] == x and row[1] == y for row in previous]):
            return False
    places = {row[:2] for row in previous}
    return all([row[:2] in places for row in rows])
