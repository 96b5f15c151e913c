"""The demonstration as it is played: a session hears an emulated walk, and is compared with the truth."""

from __future__ import annotations

from collections.abc import Iterator

from attrs import define, field

from ...emulate.demo import RADIO, ROUTE, WAY
from ...emulate.radio import Radio
from ...emulate.routes.building import BUILDING
from ...emulate.routes.route import Route
from ...emulate.routes.ways import BuildingWalk, wandering
from ...emulate.walk import EmulatedWalk, emulate
from ...events import Event, Placed, PlaceLost, TurnMade
from ...floorplan.index import IndexedPlan
from ...session import Session
from ...show.observer import Observer
from ...types import Foot, Packet, Sample
from ..evaluate.gathered import Gathering
from .compare import FootComparison, compare
from .place import PlaceScore, score


@define
class Demo:
    """A walk on its way through a session. `play` goes on packet by packet, so that whoever shows it sets the pace;
    `told` is for whoever feeds `session`, or one like it, himself."""

    walk: EmulatedWalk
    session: Session
    way: BuildingWalk | None = None
    """Through the emulated building; None where there is none."""
    plan: IndexedPlan | None = None
    """Of that building."""
    observer: Observer = field(factory=Observer)
    gathering: Gathering = field(factory=Gathering)
    _placed: list[Event] = field(factory=list)

    @property
    def duration(self) -> float:
        return self.walk.truth.duration

    def play(self) -> Iterator[Packet]:
        """Each packet after the session has taken it."""
        for packet in self.walk.packets:
            self.told(packet, self.session.feed(packet))
            yield packet
        self.told(None, self.session.finish())

    def told(self, packet: Packet | Sample | None, events: list[Event]) -> None:
        """What a session said of a packet; of none, at the end."""
        self.observer.take(packet, events)
        for event in events:
            self.gathering.add(event)
            if isinstance(event, Placed | PlaceLost | TurnMade):
                self._placed.append(event)

    def comparison(self) -> list[FootComparison]:
        """The session against the truth; once `play` is through."""
        return compare(self.walk.truth, {foot: self.gathering.foot(foot) for foot in Foot})

    def place(self) -> PlaceScore | None:
        """The same of the place on the floor plan; None without one."""
        return None if self.way is None else score(self.way, self.walk.walker, self.walk.truth, self._placed)


def make_demo(seed: int, route: Route = ROUTE, radio: Radio = RADIO, *, pressures: bool = False) -> Demo:
    """The walk of this seed, not yet played. `pressures`: its session emits FootPressed."""
    return Demo(emulate(route, radio=radio, seed=seed), Session(poses=True, pressures=pressures))


def make_indoors(seed: int, radio: Radio = RADIO, *, pressures: bool = False) -> Demo:
    """The same in the emulated building, whose plan the session has; nobody tells it where on it the wearer sets
    out."""
    way, plan = wandering(WAY), IndexedPlan(BUILDING)
    session = Session(poses=True, pressures=pressures, floorplan=plan)
    return Demo(emulate(way.route, radio=radio, seed=seed), session, way, plan)
