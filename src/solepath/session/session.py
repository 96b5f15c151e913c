"""The session: what an app holds. Packets or samples in, events out.

A session opens no socket, reads no clock, starts no thread. It is a plain record, so it can be saved at any moment and
go on elsewhere; the same input gives the same events on every machine, however it is cut.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import deepcopy
from math import isfinite
from typing import TYPE_CHECKING, Any

from ..body.gait.means import GaitParameters
from ..body.part import Position
from ..calibration import Calibration
from ..events import Event, PacketRejected, Placed, SampleRejected
from ..foot.phase import SUPPORT
from ..foot.tracker import FootTracker
from ..link.decoder import Decoder
from ..link.kinds import DeviceKinds, make_kinds
from ..recipes import DEFAULT, Recipe, own
from ..types import Activity, Foot, Packet, Phase, Sample, Site, Support
from ..types.attrs import evolve
from .checked import as_float, beginning, indexed, sound
from .state import SessionState
from .wearer import WearerParts, WearerSettings, in_order

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan, Start
    from ..link.driver import Driver
    from ..saving.codec import Json

A_NUMBER = (float, int)


class Session:
    """One wearer: packets or samples in, events out.

    `recipe`: which parts to use. `calibration`: what is known of wearer, shoes and insoles. `poses`: also emit
    FootMoved, the live position at every sample, and WearerMoved after every stride; `pressures`: FootPressed, what an
    insole's cells show. `devices`: the address of the device at a site (`Packet.device`, in upper or lower case); one
    that is not named is bound to the first device that it hears. `profiles`: devices of the app's own. `floorplan`: of
    the building, made ready once (IndexedPlan) where many sessions share it; `start`: where on it the wearer sets out.
    ValueError for a calibration, floor plan or start of what cannot be.

    `feed`, `advance` and `finish` return the events that became known, in that order. `feed` is total: any bytes give
    events, never an exception, unless a reader or a part of the app's own is itself wrong.

    Latency: zero velocity and live position with the sample. Heel-strike and toe-off one sample once a foot has pushed
    off the first time; a foot that does not push off is known to swing after 0.15 s (0.4 s right after a heel-strike).
    Foot-flat and the stride that it ends about 40 ms. Heel-off 40 to 140 ms, in slow walking up to 320 ms.
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
        self._kinds: DeviceKinds = make_kinds(profiles)
        known = Calibration() if calibration is None else sound(calibration)
        self._plan = indexed(floorplan)
        plan = None if self._plan is None else self._plan.fingerprint
        wearer = WearerParts(WearerSettings(own(recipe), known, poses, pressures, plan))
        if start is not None:
            wearer.ask("set_out")(beginning(start, self._plan))
        wearer.walks_on(self._plan)
        self._state = SessionState(wearer)
        for site, device in (devices or {}).items():
            self.bind(site, device)

    def __repr__(self) -> str:
        return f"<Session {self._state.wearer.settings.recipe.name} at {self._state.now} s>"

    def feed(self, data: Packet | Sample | Iterable[Packet | Sample]) -> list[Event]:
        """Take packets (as they arrive) or samples (in the order of their time). TypeError for an item that is neither
        (what came before it has been used by then), ValueError after `finish`."""
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
            if not isinstance(item, (Packet, Sample)):
                raise TypeError(f"feed takes packets or samples, not {type(item).__name__}")
            events += self.feed(item)
        return events

    def advance(self, now: float) -> list[Event]:
        """Nothing arrived, but it is `now` (s, the clock of the packets): silence may have become an event. ValueError
        for a time that is not finite."""
        if not isfinite(as_float(now)):
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
        state, events = self._state, list[Event]()
        if not state.finished:
            for decoder in state.decoders.values():
                self._take(decoder.site, decoder.finish(), events)
            if state.now is not None:
                events += state.wearer.finish(state.now)
            state.finished = True
        return events

    def bind(self, site: Site, device: str) -> None:
        """From now on `site` is the device with this address, as when a broken one was replaced; "" for the next one
        that is heard. What is known of the device before (layout, ranges, clock) is forgotten."""
        if not isinstance(site, Site) or not isinstance(device, str):
            raise TypeError("a Site is bound to the address of a device, a str")
        state = self._state
        known = state.decoders.get(site)
        if known is None or not known.is_bound_to(device):
            state.decoders = in_order({**state.decoders, site: Decoder(site, device)}, Site)
            state.wearer.reset(site)

    def _packet(self, packet: Packet) -> list[Event]:
        state, events = self._state, list[Event]()
        site, channel, data, device = packet.site, packet.channel, packet.data, packet.device
        timed = isinstance(packet.t, A_NUMBER) and isinstance(site, Site) and isinstance(channel, str)
        if not (timed and isinstance(data, bytes | bytearray | memoryview) and isinstance(device, str)):
            raise TypeError("a packet holds a time, a Site, a channel's name, bytes and a device's address")
        if isinstance(packet.t, int):
            packet = evolve(packet, t=as_float(packet.t))
        decoder = state.decoders.get(site) or Decoder(site)
        items = decoder.feed(packet, self._kinds)
        for item in items:
            if isinstance(item, PacketRejected):
                # it changes nothing, so it is not a sign of time passing either
                if site not in state.decoders:
                    return [one for one in items if isinstance(one, PacketRejected)]
                self._take(site, items, events)
                return events
        if site not in state.decoders:
            state.decoders = in_order({**state.decoders, site: decoder}, Site)
        for elsewhere, other in state.decoders.items():
            if elsewhere is not site and (late := other.advance(packet.t, self._kinds)):
                self._take(elsewhere, late, events)
        if state.now is None or packet.t > state.now:
            state.now = packet.t
        if decoder.link is not None:
            until = decoder.link.unsettled_until
            if until != state.wearer.unsettled.get(site):
                state.wearer.unsettle(site, until)
        self._take(site, items, events)
        return events

    def _sample(self, state: SessionState, sample: Sample) -> list[Event]:
        t, site = sample.t, sample.site
        if not isinstance(site, Site) or not isinstance(t, A_NUMBER):
            raise TypeError("a sample holds a time and a Site")
        events = state.wearer.feed(sample, site in state.decoders)
        rejected = events and any([isinstance(event, SampleRejected) for event in events])
        if not rejected and (state.now is None or t > state.now):
            state.now = t
        return events

    def _take(self, site: Site, items: Iterable[Sample | Event], events: list[Event]) -> None:
        """Hand samples of a link to the wearer, and events where they matter there."""
        wearer = self._state.wearer
        for item in items:
            events += wearer.feed(item, True) if isinstance(item, Sample) else wearer.receive(site, item)

    @property
    def now(self) -> float | None:
        """The latest moment that anything is known of, s; None before any."""
        return self._state.now

    @property
    def recipe(self) -> Recipe:
        """The parts that this session is made of."""
        return deepcopy(self._state.wearer.settings.recipe)

    @property
    def feet(self) -> dict[Foot, FootTracker]:
        """The trackers of the feet heard of so far: live position, velocity, attitude, covariance, phase. Read only."""
        return dict(self._state.wearer.feet)

    @property
    def position(self) -> Position | None:
        """Where the wearer is, by the recipe's track, world frame, with its covariance; None before any sample."""
        return self._state.wearer.position

    @property
    def place(self) -> Placed | None:
        """Where the wearer is on the floor plan; None without one, and while that is not known."""
        place: Placed | None = self._state.wearer.ask("place")
        return place

    @property
    def activity(self) -> Activity:
        """What the wearer does, by the newest ActivityChanged; UNKNOWN before any."""
        activity: Activity | None = self._state.wearer.ask("activity")
        return Activity.UNKNOWN if activity is None else activity

    @property
    def gait(self) -> GaitParameters | None:
        """Means of the steady gait cycles so far, of walking or of running as the newest was; None before any."""
        gait: GaitParameters | None = self._state.wearer.ask("parameters")
        return gait

    @property
    def support(self) -> Support | None:
        """Which feet carry the body; None until both were heard of."""
        left, right = self.phase(Foot.LEFT), self.phase(Foot.RIGHT)
        return None if left is None or right is None else SUPPORT[left][right]

    def phase(self, foot: Foot) -> Phase | None:
        """What the foot is doing; None until it was heard of."""
        tracker = self._state.wearer.feet.get(foot)
        return None if tracker is None else tracker.phase

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
        """A session that goes on where `saved` was taken. A snapshot holds no functions and no floor plan: `profiles`,
        `floorplan` and `parts`, the classes of the app's own parts, are to be given again, and whether their functions
        are the same is for the app to keep. SnapshotError for what is no sound snapshot of this version, and where it
        was taken with other devices, another floor plan or other parts than are given."""
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
        """A session that goes on where it was packed. `recipe`: the same as then; the rest as in `restore`. What is
        looked at is the recipe's name and the kind of every part; settings of `recipe` hold from here on, so that one
        that was tuned goes on. SnapshotError where that differs, for other bytes, and where `restore` has one. A
        checksum tells damage, not intent: a state is believed, as code is."""
        from .packed import unpack

        return cls._of(unpack(data, recipe, parts), profiles, floorplan)

    @classmethod
    def _of(cls, state: SessionState, profiles: Iterable[Driver], floorplan: FloorPlan | IndexedPlan | None) -> Session:
        """What goes on from a state. SnapshotError where that needs a floor plan or a driver that is not there."""
        from .snapshot import must_fit

        session = cls.__new__(cls)
        session._kinds = make_kinds(profiles)
        session._plan = indexed(floorplan)
        session._state = state
        must_fit(state, session._kinds, session._plan)
        state.wearer.walks_on(session._plan)
        return session
