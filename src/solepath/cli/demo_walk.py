"""The walk of `solepath demo`: a session receives an emulated walk and is compared with the truth."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from math import dist
from statistics import median

from attrs import define, field

from ..calibration import Calibration
from ..emulate.demo import BUILDING_WALK_SEED, ROUTE, straight, worn
from ..emulate.radio import Radio
from ..emulate.routes.building import BUILDING
from ..emulate.routes.ways import BuildingWalk, wandering
from ..emulate.walk import EmulatedWalk, emulate
from ..emulate.wearers.gait import Wearer
from ..events import Event
from ..floorplan.index import IndexedPlan
from ..recipes import by_name
from ..session import Session
from ..show.tables.table import milliseconds, number, percent, table
from ..types import Foot, Packet, Sample
from ..validate.comparison import FootComparison, compare
from ..validate.foot_run import FootRun
from ..validate.place import PlaceScore, score
from ..walk.walk import Walk


@define
class Demo:
    """An emulated walk and the session that receives it.

    `play` yields after each packet, so that the caller sets the pace. A caller who feeds `session` without `play`
    passes the events to `add_events`."""

    walk: EmulatedWalk
    session: Session
    sensors: str = "an insole in each shoe"
    """What the wearer wears, in words."""
    way: BuildingWalk | None = None
    """Walk through the emulated building; None when the walk is not in the building."""
    plan: IndexedPlan | None = None
    """Floor plan of that building; None when the walk is not in the building."""
    found: Walk = field(factory=lambda: Walk(limit=None, keeps_all=True))
    """What the session found."""

    def play(self) -> Iterator[Packet]:
        """Yield each packet after the session has processed it."""
        for packet in self.walk.packets:
            self.add_events(packet, self.session.feed(packet))
            yield packet
        self.add_events(None, self.session.finish())

    def add_events(self, packet: Packet | Sample | None, events: list[Event]) -> None:
        """Add the events that a session returned for a packet; `packet` is None at the end."""
        self.found.take(packet, events)

    def tables(self) -> list[str]:
        """Return the comparison with the truth, and the score on a floor plan. Call it after `play` has finished."""
        compared = compare(self.walk.truth, {foot: FootRun.of(self.found, foot) for foot in Foot})
        rows = list(zip(COMPARED, *map(_column, compared), strict=True))
        tables = [table(["against the truth", *[one.foot.value for one in compared]], rows)]
        if (reported := paper_of(self.session.recipe.name)) is not None:
            tables.append(self._beside_the_paper(*reported))
        if self.way is not None:
            events = [*self.found.placed, *self.found.made_turns]
            tables.append(place_table(score(self.way, self.walk.walker, self.walk.truth, events)))
        return tables

    def _beside_the_paper(self, figure: str, paper: str) -> str:
        """Return where the wearer's track ends, beside a figure of the recipe's paper."""
        route, here = self.walk.walker.route, self.session.position
        off = None if here is None else dist(here.position[:2], (route.end.x, route.end.y))
        share = "" if off is None else f" m, {percent(off / route.length)} % of the way"
        rows = [["end of the wearer's track, error", f"{number(off)}{share}", figure]]
        return table([self.session.recipe.name, "emulated", paper], rows)


PAPERS = {
    "kupt": ("20.08 +- 0.51 m for 20 m, both feet", "Chen et al. 2019, table I"),
    "zupt": ("20.97 +- 1.84 m for 20 m, left foot", "Chen et al. 2019, table I"),
    "pressure-contour": ("4.30 +- 3.15 m, 0.4 % of a loop", "Bebek et al. 2010, table I"),
    "gyroscope": ("4.87 +- 2.75 m, 0.4 % of a loop", "Bebek et al. 2010, table I"),
    "walking-modes": ("0.03 m, 0.2 % of a rectangle", "Gong et al. 2023, table 4, A by IV"),
    "touchdown": ("0.16 to 0.19 m, 1.3 % of a rectangle", "Gong et al. 2023, table 4, A by I to III"),
    "footstep-tracker": ("2.64 m, 4.2 % of a corridor", "Liu et al. 2015, section V.D"),
    "shoe-sensing": ("1.9 m, 10 % of 19.2 m", "Li et al. 2016, section 4.2.3"),
}
"""What papers report of the end of a walk, and where, by the first words of their recipes."""


def paper_of(recipe: str) -> tuple[str, str] | None:
    """Return what the paper of a recipe reports, and where; None for a recipe without a paper."""
    return next((row for name, row in PAPERS.items() if recipe.startswith(name)), None)


def make_demo(options: Namespace, radio: Radio, *, pressures: bool) -> Demo:
    """Return the walk that the options describe, not yet played. With `pressures` the session emits FootPressed.

    In the emulated building the session has the floor plan, but not the position from which the wearer starts."""
    route, way, plan = ROUTE if options.distance is None else straight(options.distance), None, None
    if options.building:
        way, plan = wandering(BUILDING_WALK_SEED), IndexedPlan(BUILDING)
        route = way.route
    limbs = Wearer().limbs
    sensors, devices = worn(options.recipe, limbs, options.seed)
    session = Session(
        by_name(options.recipe),
        calibration=Calibration(limbs=limbs),
        poses=True,
        pressures=pressures,
        losses=True,
        floorplan=plan,
    )
    return Demo(emulate(route, devices=devices, radio=radio, seed=options.seed), session, sensors, way, plan)


COMPARED_EVENTS = {"heel_strike": "heel-strike", "foot_flat": "foot-flat", "heel_off": "heel-off", "toe_off": "toe-off"}
COMPARED = (
    "strides walked", "strides found", "strides invented", "stride length, mean error %", "end position, error m",
    *[label for name in COMPARED_EVENTS.values() for label in (f"{name}s found", f"{name}, median offset ms")],
)  # fmt: skip
"""Labels of the table that compares the strides and events of both feet with the truth."""


def _column(foot: FootComparison) -> list[str]:
    """Return the figures of a foot, in the order of COMPARED."""
    cells = [str(count) for count in (foot.strides_true, foot.strides_found, foot.strides_invented)]
    cells += [percent(foot.length_errors.mean), number(foot.end_error)]
    for kind in COMPARED_EVENTS:
        matching = foot.events[kind]
        cells += [f"{len(matching.offsets)} of {matching.n_true}", milliseconds(matching.bias)]
    return cells


def place_table(score: PlaceScore) -> str:
    """Return the table of the score of positions on the floor plan."""
    rows = [
        ["strides placed", str(score.strides)],
        ["decided, at the true place, after strides", "-" if score.decided is None else str(score.decided)],
        ["strides decided, at a wrong place", str(score.wrong)],
        ["strides without the true candidate", str(score.dropped)],
        ["from the second turn on, median error m", number(median(score.off)) if score.off else "-"],
    ]
    return table(["place against the truth", "wearer"], rows)
