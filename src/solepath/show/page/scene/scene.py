"""Events in, what a page shows out: a scene for who begins to watch, and then what has changed since.

protocol/page.md says what the messages hold. Nothing here knows a clock, a thread or a network.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

from attrs import define, field, frozen

from ....events import (
    ClockReset,
    Event,
    FootFlat,
    FootMoved,
    FootPressed,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    LayoutKnown,
    Placed,
    PlaceLost,
    StrideTaken,
    ToeOff,
    WearerMoved,
)
from ....floorplan.plan import FloorPlan
from ....foot.phase import EVENT_OF_PHASE, SUPPORT
from ....types import SITE_OF_FOOT, Foot, Packet, Phase, Sample, Site
from ...observer import REJECTED, FootCounts, Observer
from ..messages import Written, shown
from ..player.playback import Playback
from .feet import FootScene
from .gait import SceneMeasures, ScenePace, activity_frame
from .links import link_frame, unheard_since
from .lists import WalkedTrack
from .log import SceneLog
from .plan_drawing import drawn
from .scales import Scales
from .whereabouts import Whereabouts

VERSION = 1


@frozen
class Cursor:
    """What a watcher has been shown. `drawn`: layouts and the like when the scene was sent whole. `numbers`: of each
    list, how many items it ever had. `values`: of each other key, what was sent last."""

    drawn: int
    numbers: dict[str, int]
    values: dict[str, Any]


@define
class Scene:
    """One session, which is to be made with `poses=True` and `pressures=True`. Times in s on the session's clock;
    lengths in m, world frame, or the plan's for what is on `plan`. `source`: "live", "demo" or "recording".
    `newtons`: the feet whose calibration turns counts into N. `playback`: the player writes it. `observer`: what it is
    a picture of; the scene feeds it.

    `take` is cheap: it is called for every packet. `since` costs some 0.1 ms, and is for 30 times a second at the most.
    Memory is bounded, whatever is walked. Not to be used by two threads at once.
    """

    title: str
    recipe: str
    source: str = "live"
    plan: FloorPlan | None = None
    playback: Playback | None = None
    newtons: tuple[Foot, ...] = ()
    observer: Observer = field(factory=Observer)
    feet: dict[Foot, FootScene] = field(factory=lambda: {foot: FootScene(foot) for foot in Foot}, init=False)
    whereabouts: Whereabouts = field(factory=Whereabouts, init=False)
    measured: SceneMeasures = field(factory=SceneMeasures, init=False)
    pace: ScenePace = field(factory=ScenePace, init=False)
    scales: Scales = field(factory=Scales, init=False)
    log: SceneLog = field(factory=SceneLog, init=False)
    layouts: int = field(default=0, init=False)
    """How often one became known: a page that drew others needs the scene anew."""
    drawing: Written | None = field(init=False)
    """Of the plan: made once, however many watch and wherever the player goes."""

    def __attrs_post_init__(self) -> None:
        self.drawing = None if self.plan is None else drawn(self.plan)

    def take(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """What the session was fed, and what it said of that. None: nothing came, time passed or the session ended."""
        for event in events:
            if not isinstance(event, REJECTED):
                self.tick(event.known_at)  # who was silent until now is drawn so before what ends the silence
        self.observer.fed(item, events)
        for event in events:
            if isfinite(event.known_at) and isfinite(event.t):
                self._show(event)
        if not events:
            self._hush()

    def tick(self, t: float) -> None:
        """It is `t` s, on the clock of the packets, whether or not anything was heard."""
        if t > self.now:
            self.observer.advance(t)
            self._hush()

    @property
    def now(self) -> float:
        """The latest moment that anything is known of, s."""
        return self.observer.now

    def _show(self, event: Event) -> None:
        self.log.tell(event, self.observer)
        self.observer.add(event)
        take = TAKEN.get(type(event))
        if take is not None:
            take(self, event)
        if getattr(event, "site", None) is not None:
            self._hush()

    def _hush(self) -> None:
        """What a foot does that is not heard is not known. What it has begun since then shows that it is heard again,
        though the sample that does comes after it."""
        for foot, one in self.feet.items():
            link = self.observer.links.get(SITE_OF_FOOT[foot])
            if one.phase is None or link is None or link.state(self.now) == "ok":
                continue
            if not one.began_after(link.silent_from):
                one.fall_silent(min(self.now, link.silent_from))

    def _connected(self, foot: Foot) -> bool:
        """Whether what comes of a foot is no straggler of a connection that is gone."""
        return self.observer.link(SITE_OF_FOOT[foot]).broken_at is None

    def _moved(self, event: FootMoved) -> None:
        if self._connected(event.foot):
            self.feet[event.foot].moved(event)

    def _pressed(self, event: FootPressed) -> None:
        if self._connected(event.foot):
            self.feet[event.foot].pressed(event)
            self.scales.press(event.foot, event.values)

    def _began(self, event: HeelStrike | FootFlat | HeelOff | ToeOff) -> None:
        if self._connected(event.foot):
            self.feet[event.foot].begin(event.t, PHASES[type(event)])

    def _stepped(self, event: StrideTaken) -> None:
        self.feet[event.foot].stepped(event)

    def _laid_out(self, event: LayoutKnown) -> None:
        foot = event.site.foot
        if foot is not None and self.feet[foot].wear(event.layout):
            self.layouts += 1
            self.scales.wear(foot, event.layout, foot in self.newtons or event.layout.scale is not None)

    def _reset(self, event: ClockReset) -> None:
        if event.site.foot is not None:
            self.pace.reset(event.site.foot)

    def _placed(self, event: Placed) -> None:
        level = self.whereabouts.found(event)
        if level is not None:
            self.log.add(event.t, "place", f"on {self._level(level)}")

    def _level(self, level: str) -> str:
        names = [] if self.plan is None else [one.name for one in self.plan.levels if one.id == level]
        return names[0] if names and names[0] else f"level {level}"

    def whole(self) -> tuple[dict[str, Any], Cursor]:
        """Everything: the message "scene", and what `since` goes on from."""
        values = self._values()
        message = {
            "type": "scene",
            "v": VERSION,
            "title": self.title,
            "recipe": self.recipe,
            "source": self.source,
            "control": False,
            "plan": self.drawing,
            "layouts": {foot.value: one.layout_message(foot in self.newtons) for foot, one in self.feet.items()},
            "tracks": {name: list(track.points) for name, track in self._tracks().items()},
            "places": list(self.whereabouts.places.points),
            "phases": {foot.value: list(one.phases.items) for foot, one in self.feet.items()},
            "log": list(self.log.lines.items),
            "frame": {
                "type": "frame",
                "t": self._t(),
                **values,
                "phases": {"left": [], "right": []},
                "tracks": {"left": [], "right": [], "wearer": []},
                "places": [],
                "log": [],
            },
        }
        return message, Cursor(self.layouts, self._numbers(), values)

    def since(self, cursor: Cursor) -> tuple[dict[str, Any] | None, Cursor]:
        """What has changed since `cursor`, the message "frame", or None when nothing has; the message "scene" where a
        watcher is too far behind or has to draw anew."""
        if cursor.drawn != self.layouts:
            return self.whole()
        values, numbers, known = self._values(), self._numbers(), cursor.numbers
        message = {key: value for key, value in values.items() if value != cursor.values[key]}
        if numbers != known:
            tracks = {name: track.since(known[name]) for name, track in self._tracks().items()}
            places = self.whereabouts.places.since(known["places"])
            if places is None or None in tracks.values():
                return self.whole()
            phases = {foot.value: one.phases.since(known[f"phases {foot}"]) for foot, one in self.feet.items()}
            message |= _filled("tracks", {name: points for name, points in tracks.items() if points})
            message |= _filled("phases", {name: begun for name, begun in phases.items() if begun})
            message |= _filled("places", places)
            message |= _filled("log", self.log.lines.since(known["log"]))
        if not message:
            return None, cursor
        return {"type": "frame", "t": self._t(), **message}, Cursor(self.layouts, numbers, values)

    def heartbeat(self) -> dict[str, Any]:
        """A frame in which nothing has changed but the time."""
        return {"type": "frame", "t": self._t()}

    def _t(self) -> float:
        return shown(self.now) or 0.0

    def _tracks(self) -> dict[str, WalkedTrack]:
        return {**{foot.value: one.track for foot, one in self.feet.items()}, "wearer": self.whereabouts.track}

    def _numbers(self) -> dict[str, int]:
        numbers = {name: track.count for name, track in self._tracks().items()}
        numbers |= {f"phases {foot}": one.phases.count for foot, one in self.feet.items()}
        return numbers | {"places": self.whereabouts.places.count, "log": self.log.lines.count}

    def _values(self) -> dict[str, Any]:
        now, seen = self.now, self.observer
        links = {site: link_frame(seen.links[site], now) for site in Site if site in seen.links}
        feet: dict[str, Any] = {}
        for foot, one in self.feet.items():
            link = links.get(SITE_OF_FOOT[foot])
            feet[foot.value] = one.frame(0.0 if link is None else link["rate"], seen.feet.get(foot, NOTHING))
        unheard, (since, activity) = unheard_since(seen.links, now), seen.timeline.last
        return {
            "feet": feet,
            "wearer": self.whereabouts.wearer_frame(),
            "place": self.whereabouts.place_frame(seen.places.last),
            "activity": activity_frame(since, activity, unheard),
            "pace": None if unheard is not None else self.pace.frame(now, activity, since),
            "support": self._support(),
            "scales": self.scales.frame(),
            "gait": self.measured.frame(seen.gait_of_late),
            "links": {site.words: link for site, link in links.items()},
            "playback": None if self.playback is None else self.playback.frame(),
        }

    def _support(self) -> str | None:
        left, right = self.feet[Foot.LEFT].phase, self.feet[Foot.RIGHT].phase
        return None if left is None or right is None else SUPPORT[left][right].value


NOTHING = FootCounts()
"""Of a foot that nothing is known of."""
PHASES: dict[type, Phase] = {event: phase for phase, event in EVENT_OF_PHASE.items()}

TAKEN: dict[type, Callable[[Scene, Any], None]] = {
    FootMoved: Scene._moved,
    FootPressed: Scene._pressed,
    HeelStrike: Scene._began,
    FootFlat: Scene._began,
    HeelOff: Scene._began,
    ToeOff: Scene._began,
    StrideTaken: Scene._stepped,
    GaitCycleMeasured: lambda scene, event: scene.pace.take(event),
    WearerMoved: lambda scene, event: scene.whereabouts.stepped(event),
    Placed: Scene._placed,
    PlaceLost: lambda scene, event: scene.whereabouts.lose(),
    LayoutKnown: Scene._laid_out,
    ClockReset: Scene._reset,
}
"""What changes the scene, besides the observer and the log."""


def _filled(key: str, value: Any) -> dict[str, Any]:
    return {key: value} if value else {}
