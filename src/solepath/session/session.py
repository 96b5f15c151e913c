"""The session: what an app holds. Packets or samples in, events out.

    session = Session(recipes.DEFAULT)
    for event in session.feed(packet):
        ...

A session opens no socket, reads no clock, starts no thread. It is a plain record, so it can be saved at any moment and
go on elsewhere; the same input gives the same events on every machine, however it is cut.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import deepcopy
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from ..body.gait.means import GaitParameters
from ..body.part import Position
from ..calibration import Calibration, CalibrationError
from ..events import Event, PacketRejected, Placed, SampleRejected
from ..foot.phase import SUPPORT
from ..foot.tracker import FootTracker
from ..link.decoder import Decoder
from ..link.known import Kinds, kinds
from ..recipes import DEFAULT, Recipe, own
from ..types import Activity, Foot, Packet, Phase, Sample, Site, Support
from ..types.attrs import evolve
from .state import SessionState
from .wearer import WearerParts, in_order

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan, Start
    from ..link.driver import Driver
    from ..saving.codec import Json

A_NUMBER = (float, int)


class Session:
    """One wearer. `recipe`: which parts to use. `calibration`: what is known of wearer, shoes and insoles. `poses`:
    also emit FootMoved, the live position at every sample, and WearerMoved after every step; `pressures`: FootPressed,
    what an insole's cells show, at every sample that has any. `devices`: the address of the device at a site
    (`Packet.device`, in upper or lower case); packets of other devices are rejected there. A site that is not named is
    bound to the first device that it hears. `profiles`: devices of the app's own (link/driver.py), beside those that
    are known. `floorplan`: of the building, from a file (read_floorplan) or made by a program, and made ready once
    (IndexedPlan) where many sessions share it; `start`: where on it the wearer sets out, None when nobody knows.
    CalibrationError, a ValueError, for a calibration of what cannot be (protocol/calibration.md), FloorPlanError, a
    ValueError, for such a floor plan or start (protocol/floorplan.md).

    `feed`, `advance` and `finish` return the events that became known, in the order in which they did. `feed` is
    total: any bytes give events, never an exception, unless a reader or a detector of the app's own is itself wrong.
    TypeError for what is neither a packet nor a sample, ValueError for a time that is not finite in `advance` and for
    feeding after `finish`.

    Latency: zero velocity and live position with the sample. Heel-strike and toe-off one sample once a foot has pushed
    off the first time; a foot that leaves the ground without pushing off is known to swing after 0.15 s (0.4 s right
    after a heel-strike). Foot-flat and the step that it ends about 40 ms. Heel-off 40 to 140 ms, in slow walking up to
    320 ms, since a heel comes off slowly and is dated back.
    """

    __slots__ = ("_kinds", "_plan", "_state")

    def __init__(
        self,
        recipe: Recipe = DEFAULT,
        *,
        calibration: Calibration | None = None,
        poses: bool = False,
        pressures: bool = False,
        devices: Mapping[Site, str] | None = None,
        profiles: Iterable[Driver] = (),
        floorplan: FloorPlan | IndexedPlan | None = None,
        start: Start | None = None,
    ) -> None:
        if not isinstance(recipe, Recipe):
            raise TypeError(f"recipe must be a Recipe, not {type(recipe).__name__}")
        self._kinds: Kinds = kinds(profiles)
        known = Calibration() if calibration is None else _sound(calibration)
        self._plan = _indexed(floorplan)
        wearer = WearerParts(own(recipe), deepcopy(known), poses, pressures, self._plan is not None)
        if start is not None:
            wearer.ask("set_out")(_checked(start, self._plan))
        wearer.walks_on(self._plan)
        self._state = SessionState(wearer, None if self._plan is None else self._plan.fingerprint)
        for site, device in ({} if devices is None else devices).items():
            self.bind(site, device)

    # --- in ---

    def feed(self, data: Packet | Sample | Iterable[Packet | Sample]) -> list[Event]:
        """Take packets (as they arrive) or samples (in the order of their time).

        TypeError for an item that is neither; what came before it in `data` has been used by then.
        """
        state = self._state
        if state.finished:
            raise ValueError("this session is finished")
        if isinstance(data, Sample):
            return self._sample(state, data)
        if isinstance(data, Packet):
            return self._packet(data)
        if not isinstance(data, Iterable) or isinstance(data, str | bytes):
            raise TypeError(f"feed takes packets or samples, not {type(data).__name__}")
        events: list[Event] = []
        for item in data:
            if isinstance(item, Packet):
                events += self._packet(item)
            elif isinstance(item, Sample):
                events += self._sample(state, item)
            else:
                raise TypeError(f"feed takes packets or samples, not {type(item).__name__}")
        return events

    def advance(self, now: float) -> list[Event]:
        """Nothing arrived, but it is `now` (s, the clock of the packets): silence may have become an event. After
        `finish` nothing can."""
        if not isfinite(_number(now)):
            raise ValueError(f"now is {now}")
        state = self._state
        if state.finished:
            return []
        if state.now is None or now > state.now:
            state.now = now
        events: list[Event] = []
        for decoder in state.decoders.values():
            self._take(decoder.site, decoder.advance(now, self._kinds), events)
        return events

    def finish(self) -> list[Event]:
        """No more will come: whatever was held back comes out. The session can still be read, but no longer fed."""
        events: list[Event] = []
        if not self._state.finished:
            for decoder in self._state.decoders.values():
                self._take(decoder.site, decoder.finish(), events)
            if self._state.now is not None:
                events += self._state.wearer.finish(self._state.now)
            self._state.finished = True
        return events

    def bind(self, site: Site, device: str) -> None:
        """From now on `site` is the device with this address and no other, as when a broken one was replaced; "" for
        the next one that is heard. What the site was told by another device (layout, ranges, clock) is forgotten."""
        if not isinstance(site, Site) or not isinstance(device, str):
            raise TypeError("a Site is bound to the address of a device, a str")
        known = self._state.decoders.get(site)
        if known is not None and known.is_bound_to(device):
            return
        self._state.decoders = in_order({**self._state.decoders, site: Decoder(site, device)}, Site)
        self._state.wearer.reset(site)

    def _packet(self, packet: Packet) -> list[Event]:
        state, events = self._state, list[Event]()
        if (
            not isinstance(packet.data, bytes | bytearray | memoryview)
            or not isinstance(packet.site, Site)
            or not isinstance(packet.channel, str)
            or not isinstance(packet.t, float | int)
            or not isinstance(packet.device, str)
        ):
            raise TypeError("a packet holds a time, a Site, a channel's name, bytes and a device's address")
        if isinstance(packet.t, int):
            packet = evolve(packet, t=_number(packet.t))
        decoder = state.decoders.get(packet.site)
        if decoder is None:
            decoder = Decoder(packet.site)
        items = decoder.feed(packet, self._kinds)
        for item in items:
            if isinstance(item, PacketRejected):
                # it changes nothing, so it is not a sign of time passing either
                if packet.site not in state.decoders:
                    return [one for one in items if isinstance(one, PacketRejected)]
                self._take(packet.site, items, events)
                return events
        if packet.site not in state.decoders:
            state.decoders = in_order({**state.decoders, packet.site: decoder}, Site)
        for site, other in state.decoders.items():
            if site is not packet.site and (late := other.advance(packet.t, self._kinds)):
                self._take(site, late, events)
        if state.now is None or packet.t > state.now:
            state.now = packet.t
        if decoder.link is not None:
            until = decoder.link.doubt
            if until != state.wearer.unsettled.get(packet.site):
                state.wearer.unsettle(packet.site, until)
        self._take(packet.site, items, events)
        return events

    def _sample(self, state: SessionState, sample: Sample) -> list[Event]:
        t, site = sample.t, sample.site
        if not isinstance(site, Site) or not isinstance(t, A_NUMBER):
            raise TypeError("a sample holds a time and a Site")
        events = state.wearer.feed(sample, site in state.decoders)
        if events and any([isinstance(event, SampleRejected) for event in events]):
            return events
        if state.now is None or t > state.now:
            state.now = t
        return events

    def _take(self, site: Site, items: Iterable[Sample | Event], events: list[Event]) -> None:
        """Hand samples to the wearer, and events where they matter there."""
        wearer = self._state.wearer
        linked = site in self._state.decoders
        for item in items:
            if isinstance(item, Sample):
                events += wearer.feed(item, linked)
            else:
                events += wearer.receive(site, item)

    # --- out ---

    @property
    def now(self) -> float | None:
        """The latest moment that anything is known of, s; None before any."""
        return self._state.now

    @property
    def recipe(self) -> Recipe:
        """The parts that this session is made of."""
        return deepcopy(self._state.wearer.recipe)

    @property
    def feet(self) -> dict[Foot, FootTracker]:
        """The trackers of the feet heard of so far: live position, velocity, attitude, covariance, phase. Read only."""
        return dict(self._state.wearer.feet)

    @property
    def position(self) -> Position | None:
        """Where the wearer is, as the recipe's body has it; the mean of the feet, each in the world frame of its own
        first heading, in most. None before any sample."""
        return self._state.wearer.position

    @property
    def place(self) -> Placed | None:
        """Where the wearer is on the floor plan, as last told; None without one, and while the place is not known."""
        place: Placed | None = self._state.wearer.ask("place")
        return place

    @property
    def activity(self) -> Activity:
        """What the wearer does, as last told; UNKNOWN before anything was."""
        activity: Activity | None = self._state.wearer.ask("activity")
        return Activity.UNKNOWN if activity is None else activity

    @property
    def gait(self) -> GaitParameters | None:
        """Gait parameters as means of the steady strides so far, of walking or of running as the newest of them was;
        None before any. Each stride's own are events (GaitCycleMeasured)."""
        gait: GaitParameters | None = self._state.wearer.ask("parameters")
        return gait

    @property
    def support(self) -> Support | None:
        """Which feet carry the body; None until both were heard of."""
        left, right = self._state.wearer.feet.get(Foot.LEFT), self._state.wearer.feet.get(Foot.RIGHT)
        if left is None or right is None:
            return None
        return SUPPORT[left.phase][right.phase]

    def phase(self, foot: Foot) -> Phase | None:
        """What the foot is doing; None until it was heard of."""
        tracker = self._state.wearer.feet.get(foot)
        return None if tracker is None else tracker.phase

    # --- elsewhere ---

    def snapshot(self) -> dict[str, Json]:
        """Everything the session remembers, as plain data for JSON or any other encoder. Costs some milliseconds."""
        from .snapshot import taken

        return taken(self._state)

    @classmethod
    def restore(
        cls,
        saved: Any,
        *,
        profiles: Iterable[Driver] = (),
        parts: Iterable[type] = (),
        floorplan: FloorPlan | IndexedPlan | None = None,
    ) -> Session:
        """A session that goes on where `saved` was taken. A snapshot holds no functions and no floor plan: `profiles`
        and `floorplan` are to be given again, and `parts`, the classes of stance detectors of the app's own.
        SnapshotError when it is not a snapshot of this version, was damaged, was taken with another floor plan, or is
        of a device that is not among the profiles, or is there with other counters, rates or ranges, or stands in the
        place of a device of ours then and not now, or of a detector that is not among the parts. Whether its functions
        are the same cannot be seen: that is for the app to keep. TypeError and ValueError for profiles and parts that
        are none, or two of one name."""
        from .snapshot import restored

        return cls._of(restored(saved, parts), profiles, floorplan)

    def pack(self) -> bytes:
        """Everything the session remembers, in 10 to 20 kB and some 0.3 ms: for where many are saved often
        (protocol/snapshot.md). Its recipe is not in it. Needs numpy. TypeError and SnapshotError as `snapshot`."""
        from .packed import pack

        return pack(self._state)

    @classmethod
    def unpack(
        cls,
        data: bytes,
        recipe: Recipe = DEFAULT,
        *,
        profiles: Iterable[Driver] = (),
        parts: Iterable[type] = (),
        floorplan: FloorPlan | IndexedPlan | None = None,
    ) -> Session:
        """A session that goes on where it was packed. `recipe`: the same as then; the rest as in `restore`.

        What is looked at is the recipe's name, the kind of every part, and whether it has an `altitude`. Settings are
        believed: those of `recipe` hold from here on, so that one that was tuned goes on. What is not to go on gets
        another name. SnapshotError when it was another by that, for any bytes that are no packed session, and where
        `restore` has one. A checksum tells damage, not intent: a state is believed, as code is."""
        from .packed import unpack

        return cls._of(unpack(data, recipe, parts), profiles, floorplan)

    @classmethod
    def _of(cls, state: SessionState, profiles: Iterable[Driver], floorplan: FloorPlan | IndexedPlan | None) -> Session:
        """What goes on from a state. SnapshotError where that needs a floor plan or a driver that is not there."""
        from .snapshot import must_fit

        session = cls.__new__(cls)
        session._kinds = kinds(profiles)
        session._plan = _indexed(floorplan)
        session._state = state
        must_fit(state, session._kinds, session._plan)
        state.wearer.walks_on(session._plan)
        return session


def _sound(calibration: Calibration) -> Calibration:
    from ..calibration.limits import unusable

    if not isinstance(calibration, Calibration):
        raise TypeError(f"calibration must be a Calibration, not {type(calibration).__name__}")
    why_not = unusable(calibration)
    if why_not is not None:
        raise CalibrationError(f"calibration: {why_not}")
    return calibration


def _indexed(floorplan: FloorPlan | IndexedPlan | None) -> IndexedPlan | None:
    if floorplan is None:
        return None
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan

    if isinstance(floorplan, IndexedPlan):
        return floorplan
    if not isinstance(floorplan, FloorPlan):
        raise TypeError(f"floorplan must be a FloorPlan, not {type(floorplan).__name__}")
    return IndexedPlan(floorplan)


def _checked(start: Start, plan: IndexedPlan | None) -> Start:
    from ..floorplan import plan as plans
    from ..floorplan.records import no_start

    if not isinstance(start, plans.Start) or plan is None:
        raise TypeError("start must be a Start, on a floor plan")
    why_not = no_start(start)
    if why_not is not None:
        raise plans.FloorPlanError(f"start: {why_not}")
    return deepcopy(start)


def _number(value: float) -> float:
    """An int may be too large for a float; then it is as good as infinite."""
    try:
        return float(value)
    except OverflowError:
        return inf
