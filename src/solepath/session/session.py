"""The session that an app holds for one wearer: it takes packets or samples and returns events.

It opens no socket, reads no clock and starts no thread. It can be saved at any moment. The same input gives the same
events on every machine, however it is divided among calls."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from copy import deepcopy
from typing import TYPE_CHECKING, Any

from ..body.gait.means import GaitParameters
from ..body.part import Position, StartGiven
from ..calibration import Calibration
from ..events import Event, Placed
from ..foot.phase import SUPPORT
from ..link.health import LinkHealth
from ..link.kinds import DeviceKinds, is_address, make_kinds
from ..recipes import DEFAULT, Recipe, shared_copy
from ..types import SITE_OF_FOOT, Activity, Foot, Packet, Phase, Sample, Site, Support, Vec2
from ..types.plain import flag, text
from .arguments import ItemError, check_calibration, check_devices, check_now, check_start, index_floorplan, keep_events
from .state import SessionSettings, SessionState

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan, Start
    from ..foot.tracker import FootTracker
    from ..link.driver import Driver
    from ..saving.codec import Json


class Session:
    """The processing of one wearer's packets or samples into events.

    `recipe` holds the parts. `calibration` describes the wearer, shoes and insoles. `poses` also emits FootMoved, the
    live position at every sample, and WearerMoved after every stride. `pressures` emits FootPressed, the loads of an
    insole's cells. `losses` reports each short gap and each rejected packet or sample by itself; without it, those that
    repeat within 10 s are reported together. `impacts` also emits a HeelStrike that is not final as soon as the impact
    shows, on a foot without pressure cells. `devices` gives the address of the device at a site (`Packet.device`, in
    any case); a site without one is bound to the first device that sends. `profiles` are the app's own devices.
    `floorplan` can be an IndexedPlan that many sessions share. `start` is the wearer's first place on the plan. Raises
    ValueError for impossible values.

    `feed`, `advance` and `finish` return events in the order in which they became known. `feed` accepts any bytes: they
    give events, never an exception, unless the app's own reader or part raises one. It raises TypeError for an item
    that is neither packet nor sample, or has values of wrong types (numbers may be those of numpy), and ValueError
    after `finish`. When there are events before an error, or several items, it raises ItemError, which has them.

    Latency: zero velocity and live position are known with the sample; toe-off with the next one (before a first
    push-off, swing after 0.15 s); heel-strike with the next one where there are pressure cells, else after 50 ms (with
    `impacts` mostly 10 to 20 ms); foot-flat and the stride that it ends after 40 ms; heel-off after 40 to 140 ms, in
    slow walking up to 320 ms."""

    __slots__ = ("_kinds", "_plan", "_state")

    def __init__(
        self,
        recipe: Recipe = DEFAULT,
        *,
        calibration: Calibration | None = None,
        poses: bool = False,
        pressures: bool = False,
        losses: bool = False,
        impacts: bool = False,
        devices: Mapping[Site, str] | None = None,
        profiles: Iterable[Driver] = (),
        floorplan: FloorPlan | IndexedPlan | None = None,
        start: Start | None = None,
    ) -> None:
        self._kinds: DeviceKinds = make_kinds(profiles)
        own_calibration = Calibration() if calibration is None else check_calibration(calibration)
        self._plan = index_floorplan(floorplan)
        plan = None if self._plan is None else self._plan.fingerprint
        events = flag("poses", poses), flag("pressures", pressures), flag("losses", losses), flag("impacts", impacts)
        settings = SessionSettings(shared_copy(recipe), own_calibration, *events, plan)
        state = self._state = SessionState(settings)
        if start is not None:
            state.notify(StartGiven(check_start(start, self._plan)))
        state.set_plan(self._plan)
        for site, device in check_devices(devices).items():
            self.bind(site, device)

    def __repr__(self) -> str:
        return f"<Session {self._state.settings.recipe.name} at {self._state.now} s>"

    def feed(self, data: Packet | Sample | Iterable[Packet | Sample]) -> list[Event]:
        """Add packets (as they arrive) or samples (in the order of their time) and return the events."""
        state = self._state
        if state.finished:
            raise ValueError("this session is finished: make a new Session")
        if isinstance(data, (Packet, Sample)):
            return self._feed_item(data)
        if not isinstance(data, Iterable) or isinstance(data, str | bytes):
            raise TypeError(f"feed takes packets or samples, not {type(data).__name__}")
        events: list[Event] = []
        number = 0
        try:
            for item in data:
                events += self._feed_item(item)
                number += 1
        except Exception as error:
            failure = keep_events(events, error, number)
            raise failure from failure.reason
        return events

    def _feed_item(self, item: Packet | Sample) -> list[Event]:
        state = self._state
        if isinstance(item, Packet):
            return self._gather(item, state.feed_packet, item, self._kinds)
        if isinstance(item, Sample):
            return self._gather(item, state.feed_sample, item)
        raise TypeError(f"feed takes packets or samples, not {type(item).__name__}")

    def _gather(
        self, item: Packet | Sample | None, change: Callable[..., list[Event]], *given: Any, end: bool = False
    ) -> list[Event]:
        """Change the state and return what the app is told of it, also of what was known before an error."""
        state = self._state
        try:
            events = change(*given)
        except ItemError as error:
            error.events = state.gather(item, error.events)
            raise
        return state.gather(item, events, end) if events or state.repeats.kinds else events

    def advance(self, now: float) -> list[Event]:
        """Let time pass until `now`, s, packets' clock, and return the events; raise ValueError for NaN or infinity.

        A leap that packets contradict, as that of another clock, is taken back, with a Limitation; further ones, and
        leaps of more than an hour, count only once two seconds have passed since then without a packet."""
        state = self._state
        return [] if state.finished else self._gather(None, state.advance, check_now(now), self._kinds)

    def restart_clock(self, now: float) -> list[Event]:
        """Continue on a clock that restarted or was set, and is now at `now`, s; return a ClockReset of each site."""
        state = self._state
        return [] if state.finished else self._gather(None, state.restart_clock, check_now(now), end=True)

    def here(self, where: Vec2 | str | None = None, sigma: float = 1.0, *, level: str = "") -> list[Event]:
        """Report where the wearer is, to `sigma`, m: x and y, m, a place's name, or None for the start.

        With a `level`, x and y are the plan's, and a name is that of stairs, a lift, a room or a door. Returns
        PositionReported and what follows. Raises ValueError."""
        from .here import report_position

        state = self._state
        event, site = report_position(state, self._plan, where, sigma, level)
        return state.report(site, event)

    def finish(self) -> list[Event]:
        """Return the events that were held back; the session can still be read, but not fed."""
        state = self._state
        return [] if state.finished else self._gather(None, state.finish, end=True)

    def bind(self, site: Site, device: str) -> None:
        """Bind `site` to another device, "" for the next that sends, and forget the old layout, ranges and clock."""
        if not isinstance(site, Site) or not isinstance(device, str):
            raise TypeError("a Site is bound to the address of a device, a str")
        device = text(device)
        if not is_address(device):
            raise ValueError(f"{device!r:.80} is no address of a device")
        state = self._state
        decoder = state.decoders.get(site)
        if decoder is None or not decoder.is_bound_to(device):
            state.add_decoder(state.make_decoder(site, device))
            state.reset(site)

    @property
    def now(self) -> float | None:
        """Newest known time, s, packets' clock; None before the first."""
        return self._state.now

    @property
    def recipe(self) -> Recipe:
        """A copy of the recipe of this session."""
        return deepcopy(self._state.settings.recipe)

    @property
    def feet(self) -> dict[Foot, FootTracker]:
        """Read-only trackers of the feet that sent samples: position, velocity, attitude, covariance, phase."""
        return dict(self._state.feet)

    @property
    def links(self) -> dict[Site, LinkHealth]:
        """How good the link of each site is by the newest known time: last arrival, and what is missing and rejected.

        It is for a screen that asks once a second; no event tells it."""
        now, links = self._state.now, self._state.links
        return {} if now is None else {site: links[site].health(now) for site in Site if site in links}

    @property
    def position(self) -> Position | None:
        """Position of the wearer in the world frame, with its covariance; None before any sample."""
        return self._state.position

    @property
    def place(self) -> Placed | None:
        """Place of the wearer on the floor plan; None without a plan, and while unknown."""
        place: Placed | None = self._state.find_attribute("place")
        return place

    @property
    def activity(self) -> Activity:
        """Activity of the newest ActivityChanged; UNKNOWN before the first, and while every foot that sent is silent.

        A foot is silent from StreamStale to StreamResumed."""
        state = self._state
        activity: Activity | None = state.find_attribute("activity")
        links = [state.decoders.get(SITE_OF_FOOT[foot]) for foot in state.feet]
        is_silent = links and all([link is not None and link.stale for link in links])
        return Activity.UNKNOWN if activity is None or is_silent else activity

    @property
    def gait(self) -> GaitParameters | None:
        """Means over the steady gait cycles of walking or running, whichever came last; None before the first."""
        gait: GaitParameters | None = self._state.find_attribute("parameters")
        return gait

    @property
    def support(self) -> Support | None:
        """Feet on the ground; None until both feet have sent samples."""
        left, right = self.phase(Foot.LEFT), self.phase(Foot.RIGHT)
        return None if left is None or right is None else SUPPORT[left][right]

    def phase(self, foot: Foot) -> Phase | None:
        """Return the phase of the foot; None until it has sent samples. Raises TypeError for what is no Foot."""
        if not isinstance(foot, Foot):
            raise TypeError(f"phase takes a Foot, not {type(foot).__name__}")
        tracker = self._state.feet.get(foot)
        return None if tracker is None else tracker.phase

    def __deepcopy__(self, memo: dict[int, Any]) -> Session:
        memo.update({id(one): one for one in (self._plan, self._state.settings)})
        copied = type(self).__new__(type(self))
        copied._kinds, copied._plan, copied._state = self._kinds, self._plan, deepcopy(self._state, memo)
        if type(self) is not Session:
            vars(copied).update(deepcopy(vars(self), memo))
        return copied

    def __copy__(self) -> Session:
        return self.__deepcopy__({})

    def __reduce__(self) -> tuple[Any, ...]:
        from .snapshot import own_classes

        if type(self) is not Session:
            raise TypeError(f"how a {type(self).__name__} is pickled is for its own __reduce__ to say")
        if self._kinds.drivers:
            reason = "a session with devices of the app is not pickled"
            raise TypeError(f"{reason}: use snapshot(), and restore(profiles=...)")
        return _resume, (self.snapshot(), own_classes(self._state), self._plan)

    def snapshot(self) -> dict[str, Json]:
        """Return the whole state as plain data for JSON, in some milliseconds."""
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

        Give `profiles`, `floorplan` and `parts` (the classes of the app's own parts) again, with unchanged functions.
        Raises SnapshotError for a damaged snapshot, one of another version, and one taken with other devices, another
        floor plan or other parts."""
        from .snapshot import restore_state

        return cls._from_state(restore_state(saved, parts), profiles, floorplan)

    def pack(self) -> bytes:
        """Return the state, without its recipe, as 10 to 25 kB (protocol/snapshot.md)."""
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

        `recipe` must be the one with which the session was packed; the other arguments are those of `restore`. Only its
        name and the classes of its parts are compared; its settings are used from now on, so a tuned recipe can
        continue. Raises SnapshotError if name or class differs, for other bytes, and where `restore` raises it. The
        checksum finds accidents, not manipulation: trust a state as you trust code."""
        from .packed import unpack

        return cls._from_state(unpack(data, recipe, parts), profiles, floorplan)

    @classmethod
    def _from_state(
        cls, state: SessionState, profiles: Iterable[Driver], floorplan: FloorPlan | IndexedPlan | None
    ) -> Session:
        """Return a session of a state; raise SnapshotError when the floor plan or a driver of the state is missing."""
        from .snapshot import check_fit

        session = cls.__new__(cls)
        session._kinds = make_kinds(profiles)
        session._plan = index_floorplan(floorplan)
        session._state = state
        check_fit(state, session._kinds, session._plan)
        state.set_plan(session._plan)
        return session


def _resume(saved: Any, parts: tuple[type, ...], plan: IndexedPlan | None) -> Session:
    """Return the session that pickle or `copy` saved as a snapshot."""
    return Session.restore(saved, parts=parts, floorplan=plan)
