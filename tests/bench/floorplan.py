"""Measures the tests of moves against a floor plan: `python tests/bench/floorplan.py`. Prints a table; asserts nothing.

Times are medians of five runs in one process on one core, with the garbage collector off. The last column is the time
as a share of that of testing a move against all walls of the level, one after the other.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin, tau
from random import Random

from measure import RUNS, machine, seconds

from solepath.emulate.routes.building import BUILDING
from solepath.floorplan.checks import find_warnings
from solepath.floorplan.doors import cut_doors
from solepath.floorplan.importers.geojson import format_floorplan
from solepath.floorplan.importers.reading import parse_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Door, FloorPlan, Level, Wall

STEP_LENGTH = 0.7
"""Length of a move of one step, m."""
PARTICLES = 1000

Move = tuple[float, float, float, float]
"""Start (x, y) and end (x, y) of a move, m."""


def office(walls: int) -> FloorPlan:
    """Return a plan of rooms of 3.5 m by 4.4 m, each with two doors, with at least `walls` walls.

    500 walls are 56 m by 44 m.
    """
    columns = round((walls / 4.0 * 63.0 / 56.0) ** 0.5)
    drawn: list[Wall] = []
    doors: list[Door] = []
    rooms = []
    row = 0
    while len(drawn) + len(doors) < walls:
        for column in range(columns):
            x, y = 3.5 * column, 4.4 * row
            drawn += [Wall((x, y), (x + 3.5, y)), Wall((x, y), (x, y + 4.4))]
            doors += [Door((x, y + 1.0), (x, y + 1.9)), Door((x + 1.0, y), (x + 1.9, y))]
            rooms.append(((x, y), (x + 3.5, y), (x + 3.5, y + 4.4), (x, y + 4.4)))
        row += 1
    wide, deep = 3.5 * columns, 4.4 * row
    drawn += [Wall((0.0, deep), (wide, deep)), Wall((wide, 0.0), (wide, deep))]
    level = cut_doors(Level("0", "", 0, 0.0, tuple(drawn), tuple(doors), tuple(rooms)))
    return FloorPlan("office", (level,))


def random_moves(plan: FloorPlan, count: int, length: float, random: Random) -> list[Move]:
    """Return `count` moves of `length` m in random directions from random points within the walls."""
    xs = [wall.end[0] for wall in plan.levels[0].walls]
    ys = [wall.end[1] for wall in plan.levels[0].walls]
    found = []
    for _ in range(count):
        x, y, heading = random.uniform(0.0, max(xs)), random.uniform(0.0, max(ys)), random.uniform(0.0, tau)
        found.append((x, y, x + length * cos(heading), y + length * sin(heading)))
    return found


def wall_by_wall(plan: FloorPlan) -> Callable[[float, float, float, float], bool]:
    """Return the function that tests a move against one wall after the other."""
    lines = [(*wall.start, *wall.end) for wall in plan.levels[0].walls]

    def crosses(x0: float, y0: float, x1: float, y1: float) -> bool:
        dx, dy = x1 - x0, y1 - y0
        for ax, ay, bx, by in lines:
            ex, ey = bx - ax, by - ay
            turn = dx * ey - dy * ex
            if turn != 0.0:
                s = ((ax - x0) * ey - (ay - y0) * ex) / turn
                t = ((ax - x0) * dy - (ay - y0) * dx) / turn
                if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
                    return True
        return False

    return crosses


def main() -> None:
    random = Random(1)
    rows: list[tuple[str, float, str, str]] = []
    for walls in (500, 10_000):
        plan = office(walls)
        index = IndexedPlan(plan)
        steps, strides = random_moves(plan, PARTICLES, STEP_LENGTH, random), random_moves(plan, PARTICLES, 4.0, random)
        plain_test, first_moves = wall_by_wall(plan), steps[: 50_000 // walls]
        plain_time = seconds(lambda f=plain_test, some=first_moves: [f(*move) for move in some]) / len(first_moves)  # type: ignore[misc]
        name, n = f"{len(plan.levels[0].walls)} walls: ", PARTICLES

        def add(what: str, duration: float, plain_time: float = plain_time, name: str = name) -> None:
            rows.append((name + what, duration * 1e6, "us", f"{duration / plain_time:.3f}"))

        add("every wall, plain formula", plain_time)
        add("a step of 0.7 m", seconds(lambda i=index, s=steps: [i.crosses(0, *move) for move in s]) / n)  # type: ignore[misc]
        free = [move for move in steps if not index.crosses(0, *move)]
        add("a step that is free", seconds(lambda i=index, s=free: [i.crosses(0, *move) for move in s]) / len(free))  # type: ignore[misc]
        add("a move of 4 m", seconds(lambda i=index, s=strides: [i.crosses(0, *move) for move in s]) / n)  # type: ignore[misc]
        index.inside(0, 1.0, 1.0)
        add("inside", seconds(lambda i=index, s=steps: [i.inside(0, *move[:2]) for move in s]) / n)  # type: ignore[misc]
        rows.append((name + "made ready", seconds(lambda p=plan: IndexedPlan(p)) * 1e3, "ms", ""))  # type: ignore[misc]

    plan = office(500)
    index, crowd = IndexedPlan(plan), random_moves(plan, PARTICLES, STEP_LENGTH, random)
    one_step = seconds(lambda: [index.crosses(0, x0, y0, x1, y1) for x0, y0, x1, y1 in crowd])
    rows.append((f"{PARTICLES} particles, {len(plan.levels[0].walls)} walls, one step", one_step * 1e3, "ms", ""))
    text = format_floorplan(BUILDING).encode()
    rows.append(("two floors of 56 m by 63 m: read", seconds(lambda: parse_floorplan(text)) * 1e3, "ms", ""))
    rows.append(("two floors of 56 m by 63 m: made ready", seconds(lambda: IndexedPlan(BUILDING)) * 1e3, "ms", ""))
    rows.append(("two floors of 56 m by 63 m: warnings", seconds(lambda: find_warnings(BUILDING)) * 1e3, "ms", ""))

    print(f"{machine()}, one used; medians of {RUNS}")
    width = max(len(what) for what, *_ in rows)
    print(f"{'':{width}}  {'time':>9}     {'of every wall':>13}")
    for what, value, unit, ratio in rows:
        print(f"{what:{width}}  {value:9.2f} {unit} {ratio:>14}")


if __name__ == "__main__":
    main()
