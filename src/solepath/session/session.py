"""The session, which an app holds: packets or samples in, events out.

It opens no socket, reads no clock, starts no thread, and is a plain record that can be saved at any moment. The same
input gives the same events on every machine, however it is cut into calls."""

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
from .arguments import as_float, check_calibration, check_start, index_floorplan
from .state import SessionState
from .wearer import WearerParts, WearerSettings, sort_by_key

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan, Start
    from ..link.driver import Driver
    from ..saving.codec import Json

A_NUMBER = (float, int)


class Session:
    """One wearer: packets or samples in, events out.

    `recipe` names the parts. `calibration` describes the wearer, shoes and insoles. `poses` also emits FootMoved, the
    live position at every sample, and WearerMoved after every stride; `pressures` emits FootPressed, the loads of an
    insole's cells. `devices` gives the address of the device at a site (`Packet.device`, in upper or lower case); a
    site without one is bound to the first device that sends. `profiles` are devices of the app's own. `floorplan` is
    indexed once (IndexedPlan) where many sessions share it; `start` is the first place on it. ValueError for impossible
    values of these.

    `feed`, `advance` and `finish` return the events that became known, in that order. `feed` is total: any bytes give
    events, never an exception, unless a reader or a part of the app's own is itself wrong. It raises TypeError for an
    item that is neither packet nor sample, after using the items before it, and ValueError after `finish`.

    Latency: zero velocity and live position with the sample. Heel-strike and toe-off one sample once a foot has pushed
    off the first time; a foot that does not push off is known to swing after 0.15 s (0.4 s right after a heel-strike).
    Foot-flat and the stride that it ends about 40 ms. Heel-off 40 to 140 ms, in slow walking up to 320 ms."""

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
        known = Calibration() if calibration is None else check_calibration(calibration)
        self._plan = index_floorplan(floorplan)
        plan = None if self._plan is None else self._plan.fingerprint
        wearer = WearerParts(WearerSettings(own(recipe), known, poses, pressures, plan))
        if start is not None:
            wearer.find_attribute("set_out")(check_start(start, self._plan))
        wearer.set_plan(self._plan)
        self._state = SessionState(wearer)
        for site, device in (devices or {}).items():
            self.bind(site, device)

    def __repr__(self) -> str:
        return f"<Session {self._state.wearer.settings.recipe.name} at {self._state.now} s>"

    def feed(self, data: Packet | Sample | Iterable[Packet | Sample]) -> list[Event]:
        """Add packets (as they arrive) or samples (in the order of their time) and return the events."""
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
        """Let time pass until `now` (s, packets' clock): silence may become an event. ValueError if not finite."""
        if not isfinite(as_float(now)):
            raise ValueError(f"now is {now}")
        state = self._state
        if state.finished:
            return []
        if state.now is None or now > state.now:
            state.now = now
        events: list[Event] = []
        for decoder in state.decoders.values():
            self._use_items(decoder.site, decoder.advance(now, self._kinds), events)
        return events

    def finish(self) -> list[Event]:
        """Return the events that were held back; the session can still be read, but no longer fed."""
        state, events = self._state, list[Event]()
        if not state.finished:
            for decoder in state.decoders.values():
                self._use_items(decoder.site, decoder.finish(), events)
            if state.now is not None:
                events += state.wearer.finish(state.now)
            state.finished = True
        return events

    def bind(self, site: Site, device: str) -> None:
        """Bind `site` to another device, "" for the next that sends; layout, ranges and clock before are forgotten."""
        if not isinstance(site, Site) or not isinstance(device, str):
            raise TypeError("a Site is bound to the address of a device, a str")
        state = self._state
        known = state.decoders.get(site)
        if known is None or not known.is_bound_to(device):
            state.decoders = sort_by_key({**state.decoders, site: Decoder(site, device)}, Site)
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
                # a rejected packet changes nothing, so time does not pass with it either
                if site not in state.decoders:
                    return [one for one in items if isinstance(one, PacketRejected)]
                self._use_items(site, items, events)
                return events
        if site not in state.decoders:
            state.decoders = sort_by_key({**state.decoders, site: decoder}, Site)
        for elsewhere, other in state.decoders.items():
            if elsewhere is not site and (late := other.advance(packet.t, self._kinds)):
                self._use_items(elsewhere, late, events)
        if state.now is None or packet.t > state.now:
            state.now = packet.t
        if decoder.link is not None:
            until = decoder.link.unsettled_until
            if until != state.wearer.unsettled.get(site):
                state.wearer.unsettle(site, until)
        self._use_items(site, items, events)
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

    def _use_items(self, site: Site, items: Iterable[Sample | Event], events: list[Event]) -> None:
        """Pass samples of a link to the wearer, and events where they matter there."""
        wearer = self._state.wearer
        for item in items:
            events += wearer.feed(item, True) if isinstance(item, Sample) else wearer.receive(site, item)

    @property
    def now(self) -> float | None:
        """Newest time that is known, s; None before any."""
        return self._state.now

    @property
    def recipe(self) -> Recipe:
        """The parts of this session."""
        return deepcopy(self._state.wearer.settings.recipe)

    @property
    def feet(self) -> dict[Foot, FootTracker]:
        """Trackers of the feet that sent samples: position, velocity, attitude, covariance, phase. Read only."""
        return dict(self._state.wearer.feet)

    @property
    def position(self) -> Position | None:
        """Position of the wearer, by the recipe's track, world frame, with its covariance; None before any sample."""
        return self._state.wearer.position

    @property
    def place(self) -> Placed | None:
        """Place of the wearer on the floor plan; None without a plan, and while unknown."""
        place: Placed | None = self._state.wearer.find_attribute("place")
        return place

    @property
    def activity(self) -> Activity:
        """Activity by the newest ActivityChanged; UNKNOWN before any."""
        activity: Activity | None = self._state.wearer.find_attribute("activity")
        return Activity.UNKNOWN if activity is None else activity

    @property
    def gait(self) -> GaitParameters | None:
        """Means of the steady gait cycles so far, of walking or of running as the newest was; None before any."""
        gait: GaitParameters | None = self._state.wearer.find_attribute("parameters")
        return gait

    @property
    def support(self) -> Support | None:
        """Feet on the ground; None until both feet have sent samples."""
        left, right = self.phase(Foot.LEFT), self.phase(Foot.RIGHT)
        return None if left is None or right is None else SUPPORT[left][right]

    def phase(self, foot: Foot) -> Phase | None:
        """Return the phase of the foot; None until it has sent samples."""
        tracker = self._state.wearer.feet.get(foot)
        return None if tracker is None else tracker.phase

    def snapshot(self) -> dict[str, Json]:
        """Return the whole state as plain data for JSON or any other encoder; takes some milliseconds."""
        from .snapshot import take_snapshot

        return take_snapshot(self._state)

    @classmethod
    def restore(
        cls,
        saved: Any,
        *,
        profiles: Iterable[Driver] = (),
        parts: Iterable[type] = (),
        floorplan: FloorPlan | IndexedPlan | None = None,
    ) -> Session:
        """Return a session that continues from the snapshot `saved`.

        A snapshot holds no functions and no floor plan: give `profiles`, `floorplan` and `parts`, the classes of the
        app's own parts, again; the app must keep their functions the same. Raises SnapshotError for no sound snapshot
        of this version, and for one taken with other devices, another floor plan or other parts."""
        from .snapshot import restore_state

        return cls._from_state(restore_state(saved, parts), profiles, floorplan)

    def pack(self) -> bytes:
        """Return the state in 10 to 20 kB, in about 0.3 ms (protocol/snapshot.md), without its recipe. Needs numpy."""
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
        """Return a session that continues from packed bytes.

        `recipe` must be the same as then; the other arguments are those of `restore`. Only the recipe's name and the
        kind of every part are compared; settings of `recipe` hold from here on, so a tuned recipe can continue. Raises
        SnapshotError if they differ, for other bytes, and where `restore` does. A checksum detects damage, not intent:
        trust a state like code."""
        from .packed import unpack

        return cls._from_state(unpack(data, recipe, parts), profiles, floorplan)

    @classmethod
    def _from_state(
        cls, state: SessionState, profiles: Iterable[Driver], floorplan: FloorPlan | IndexedPlan | None
    ) -> Session:
        """Return a session of a state; raise SnapshotError without the floor plan or the driver that it needs."""
        from .snapshot import check_fit

        session = cls.__new__(cls)
        session._kinds = make_kinds(profiles)
        session._plan = index_floorplan(floorplan)
        session._state = state
        check_fit(state, session._kinds, session._plan)
        state.wearer.set_plan(session._plan)
        return session
