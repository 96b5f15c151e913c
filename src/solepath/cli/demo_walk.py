"""The walk of `solepath demo`: a session receives an emulated walk and is compared with the truth."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median

from attrs import define, field

from ..emulate.demo import BUILDING_WALK_SEED, RADIO, ROUTE
from ..emulate.radio import Radio
from ..emulate.routes.building import BUILDING
from ..emulate.routes.route import Route
from ..emulate.routes.ways import BuildingWalk, wandering
from ..emulate.walk import EmulatedWalk, emulate
from ..events import Event, Placed, PlaceLost, TurnMade
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
    _place_events: list[Event] = field(factory=list)

    @property
    def duration(self) -> float:
        """Duration of the walk, s."""
        return self.walk.truth.duration

    def play(self) -> Iterator[Packet]:
        """Yield each packet after the session has processed it."""
        for packet in self.walk.packets:
            self.add_events(packet, self.session.feed(packet))
            yield packet
        self.add_events(None, self.session.finish())

    def add_events(self, packet: Packet | Sample | None, events: list[Event]) -> None:
        """Add the events that a session returned for a packet; `packet` is None at the end."""
        self.found.take(packet, events)
        for event in events:
            if isinstance(event, Placed | PlaceLost | TurnMade):
                self._place_events.append(event)

    def comparison(self) -> list[FootComparison]:
        """Return the comparison of both feet with the truth. Call it after `play` has finished."""
        return compare(self.walk.truth, {foot: FootRun.of(self.found, foot) for foot in Foot})

    def place(self) -> PlaceScore | None:
        """Return the score of the position on the floor plan; None without a plan."""
        return None if self.way is None else score(self.way, self.walk.walker, self.walk.truth, self._place_events)


def make_demo(seed: int, route: Route = ROUTE, radio: Radio = RADIO, *, pressures: bool = False) -> Demo:
    """Return the walk of this seed, not yet played. With `pressures` the session emits FootPressed."""
    return Demo(emulate(route, radio=radio, seed=seed), Session(poses=True, pressures=pressures))


def make_indoors(seed: int, radio: Radio = RADIO, *, pressures: bool = False) -> Demo:
    """Return the walk of this seed in the emulated building, not yet played.

    The session has the floor plan, but not the position from which the wearer starts. With `pressures` it emits
    FootPressed."""
    way, plan = wandering(BUILDING_WALK_SEED), IndexedPlan(BUILDING)
    session = Session(poses=True, pressures=pressures, floorplan=plan)
    return Demo(emulate(way.route, radio=radio, seed=seed), session, way, plan)


COMPARED_EVENTS = {"heel_strike": "heel-strike", "foot_flat": "foot-flat", "heel_off": "heel-off", "toe_off": "toe-off"}


def comparison_table(comparisons: Sequence[FootComparison]) -> str:
    """Return the table that compares the strides and events of both feet with the truth."""
    rows = [
        ["strides walked", *(str(c.strides_true) for c in comparisons)],
        ["strides found", *(str(c.strides_found) for c in comparisons)],
        ["strides invented", *(str(c.strides_invented) for c in comparisons)],
        ["stride length, mean error %", *(percent(c.length_errors.mean) for c in comparisons)],
        ["end position, error m", *(number(c.end_error) for c in comparisons)],
    ]
    for kind, name in COMPARED_EVENTS.items():
        matchings = [c.events[kind] for c in comparisons]
        rows.append([f"{name}s found", *(f"{len(m.offsets)} of {m.n_true}" for m in matchings)])
        rows.append([f"{name}, median offset ms", *(milliseconds(m.bias) for m in matchings)])
    return table(["against the truth", *(c.foot.value for c in comparisons)], rows)


def place_table(score: PlaceScore) -> str:
    """Return the table of the score of positions on the floor plan."""
    rows = [
        ["strides placed", str(score.strides)],
        ["one candidate, the true one, after strides", "-" if score.decided is None else str(score.decided)],
        ["strides with one candidate, a wrong one", str(score.wrong)],
        ["strides without the true candidate", str(score.dropped)],
        ["from the second turn on, median error m", number(median(score.off)) if score.off else "-"],
    ]
    return table(["place against the truth", "wearer"], rows)
