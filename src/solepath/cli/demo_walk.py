"""The walk of `solepath demo`: a session receives an emulated walk and is compared with the truth."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from statistics import median

from attrs import define, field

from ..emulate.demo import BUILDING_WALK_SEED, ROUTE, straight
from ..emulate.radio import Radio
from ..emulate.routes.building import BUILDING
from ..emulate.routes.ways import BuildingWalk, wandering
from ..emulate.walk import EmulatedWalk, emulate
from ..events import Event
from ..floorplan.index import IndexedPlan
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
        if self.way is not None:
            events = [*self.found.placed, *self.found.made_turns]
            tables.append(place_table(score(self.way, self.walk.walker, self.walk.truth, events)))
        return tables


def make_demo(options: Namespace, radio: Radio, *, pressures: bool) -> Demo:
    """Return the walk that the options describe, not yet played. With `pressures` the session emits FootPressed.

    In the emulated building the session has the floor plan, but not the position from which the wearer starts."""
    route, way, plan = ROUTE if options.distance is None else straight(options.distance), None, None
    if options.building:
        way, plan = wandering(BUILDING_WALK_SEED), IndexedPlan(BUILDING)
        route = way.route
    session = Session(poses=True, pressures=pressures, floorplan=plan)
    return Demo(emulate(route, radio=radio, seed=options.seed), session, way, plan)


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
