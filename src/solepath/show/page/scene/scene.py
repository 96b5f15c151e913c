"""Turns events into messages for a page: a whole scene for a new watcher, then the changes.

protocol/page.md says what the messages hold. Nothing here uses a clock, a thread or a network."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from attrs import define, field

from ....events import (
    ClockReset,
    EscalatorRidden,
    Event,
    FootFlat,
    FootMoved,
    FootPressed,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    LayoutKnown,
    LiftRidden,
    Placed,
    PlaceLost,
    PositionRejected,
    PositionReported,
    StrideFused,
    StrideTaken,
    ToeOff,
    TrackRevised,
    WearerMoved,
)
from ....foot.phase import SUPPORT
from ....recording import printable
from ....types import SITE_OF_FOOT, Foot, Layout, Packet, Sample, Site
from ....types.attrs import NOT_SAVED
from ....walk.valid import has_valid_numbers
from ....walk.walk import REJECTIONS, Walk
from ..body import LiveBody, body_frame
from ..guide import ShownPosture
from ..messages import members, plain
from ..player.playback import Playback
from .bending import bend_of
from .feet import NO_COUNTS, PHASE_OF_EVENT, FootScene
from .gait import SceneGaitMeans, ScenePace, activity_frame
from .links import feet_silent_since, findings_frame, link_frame
from .lists import GrowingList
from .log import SceneLog
from .plan_drawing import PlanDrawing, draw_plan
from .reports import SceneReports, report_words
from .scales import Scales
from .wearer import WearerScene

VERSION = 1
Lists = dict[tuple[str, ...], GrowingList[Any]]
"""The lists of a scene, by their place in its messages: key, and for some the name in the object there."""


@define
class Scene:
    """The state that a page shows of one session, which is made with `poses=True`, `pressures=True` and `losses=True`.

    Times are in s on the session's clock; positions in m, in the world frame, places on `plan` in the plan frame.
    `source` is "live", "demo" or "recording". `newtons` are the feet whose calibration turns counts into N. A player
    writes `playback`, who measures a shoe `guide`. The scene feeds `walk` and shows its counts. An event with
    a number that is not finite is not shown, as it is not counted. `take` is cheap: it is called for every packet.
    Memory is bounded. Two threads must not use a scene at once."""

    title: str
    recipe: str
    source: str = "live"
    plan: PlanDrawing | None = field(default=None, converter=draw_plan, metadata=NOT_SAVED)
    playback: Playback | None = field(default=None, metadata=NOT_SAVED)
    guide: ShownPosture | None = field(default=None, metadata=NOT_SAVED)
    body: LiveBody | None = field(default=None, metadata=NOT_SAVED)
    newtons: tuple[Foot, ...] = ()
    walk: Walk = field(factory=lambda: Walk(limit=0))
    feet: dict[Foot, FootScene] = field(factory=lambda: {foot: FootScene() for foot in Foot}, init=False)
    wearer: WearerScene = field(factory=WearerScene, init=False)
    gait_means: SceneGaitMeans = field(factory=SceneGaitMeans, init=False)
    pace: ScenePace = field(factory=ScenePace, init=False)
    scales: Scales = field(factory=Scales, init=False)
    log: SceneLog = field(factory=SceneLog, init=False)
    reports: SceneReports = field(factory=SceneReports, init=False)

    def take(self, item: Packet | Sample | None, events: Sequence[Event], returned_at: float | None = None) -> None:
        """Add a packet or sample that the session was fed, and the events that it returned at `returned_at`, s.

        None as the item means that nothing came: time passed or the session ended."""
        for event in events:
            if not isinstance(event, REJECTIONS):
                self.tick(event.known_at)  # a silent foot is shown as silent before the event that ends it
        for event in events:
            if has_valid_numbers(event):
                self._show(event)
        self.walk.count_item(item, events, returned_at)
        if not events:
            self._mark_silent_feet()

    def tick(self, t: float) -> None:
        """Advance the time to `t`, s, on the clock of the packets."""
        if t > self.now:
            self.walk.advance(t)
            self._mark_silent_feet()

    @property
    def now(self) -> float:
        """Latest known moment, s."""
        return self.walk.now

    def _show(self, event: Event) -> None:
        self.log.add_event(event, self.walk)
        self.walk.count(event)
        match event:
            case FootMoved(foot=foot) if self._is_connected(foot):
                self.feet[foot].add_position(event)
            case FootPressed(foot=foot) if self._is_connected(foot):
                self.feet[foot].add_pressure(event)
                self.scales.add_sample(foot, event.values)
            case HeelStrike(foot=foot) | FootFlat(foot=foot) | HeelOff(foot=foot) | ToeOff(foot=foot):
                if self._is_connected(foot):
                    self.feet[foot].start_phase(event.t, PHASE_OF_EVENT[type(event)])
                    if isinstance(event, ToeOff):
                        self.scales.end_stance(foot)
            case StrideTaken(foot=foot):
                self.feet[foot].add_stride(event)
            case GaitCycleMeasured():
                self.pace.add_stride(event)
            case WearerMoved():
                self.wearer.add_position(event)
            case LiftRidden() | EscalatorRidden():
                self.wearer.ride(event)
            case Placed(level=level) if self.wearer.add_place(event):
                self.log.add(event.t, "place", f"on {self._level_name(level)}")
            case PlaceLost():
                self.wearer.level = None
            case PositionReported(level=level):
                moved = self.wearer.moved
                self.reports.add(event, None if moved is None else moved.position)
                self.log.add(event.t, "here", printable(report_words(event, self._level_name(level)), 300))
            case PositionRejected() | TrackRevised():
                self.reports.settle(event)
                if isinstance(event, TrackRevised):
                    bend = bend_of(event, self.wearer.track.items)
                    for foot_scene in self.feet.values():
                        foot_scene.revise(bend, event.by)
                    self.wearer.revise(event, bend)
            case LayoutKnown(site=site, layout=layout) if site.foot is not None:
                newtons = site.foot in self.newtons or layout.scale is not None
                if self.feet[site.foot].set_layout(layout):
                    self.scales.set_layout(site.foot, layout, newtons)
            case ClockReset(site=site) if site.foot is not None:
                self.pace.reset(site.foot)
        if getattr(event, "site", None) is not None:
            self._mark_silent_feet()

    def _mark_silent_feet(self) -> None:
        """Mark the phase of each foot with a silent link as unknown.

        A phase that started after the silence stays: the foot sends again, and the event of its sample comes next."""
        for foot, foot_scene in self.feet.items():
            link = self.walk.links.get(SITE_OF_FOOT[foot])
            if foot_scene.phase is None or link is None or link.state(self.now) == "ok":
                continue
            if not foot_scene.phase_started_after(link.silent_from):
                foot_scene.mark_silent(self.now if link.last_sample_at is None else link.last_sample_at)

    def _is_connected(self, foot: Foot) -> bool:
        """Return whether a foot is connected; late samples of a broken connection do not count."""
        return self.walk.link(SITE_OF_FOOT[foot]).broken_at is None

    def _level_name(self, level: str) -> str:
        names = [] if self.plan is None else [known["name"] for known in self.plan["levels"] if known["id"] == level]
        return names[0] if names and names[0] else f"level {level}"

    def whole_message(self, control: bool = False) -> dict[str, Any]:
        """Return the message "scene" with everything; `control` says whether its page may send commands."""
        lists = self.lists()
        return {
            "type": "scene",
            "v": VERSION,
            "title": self.title,
            "recipe": self.recipe,
            "source": self.source,
            "control": control,
            "plan": self.plan,
            "layouts": {foot.value: one.layout_message(foot in self.newtons) for foot, one in self.feet.items()},
            **_nested({place: [*one.items] for place, one in lists.items()}),
            "frame": self.frame_message(self.values() | _nested({place: [] for place in lists})),
        }

    def frame_message(self, news: Mapping[str, Any] = {}) -> dict[str, Any]:
        """Return the message "frame" with what is new; without anything a page learns that the server is there."""
        return {"type": "frame", "t": plain(self.now) or 0.0, **news}

    def lists(self) -> Lists:
        """Return the lists of which a frame has only what is new."""
        return {
            **{("tracks", foot.value): one.track for foot, one in self.feet.items()},
            ("tracks", "wearer"): self.wearer.track,
            **{("phases", foot.value): one.phases for foot, one in self.feet.items()},
            ("places",): self.wearer.places,
            ("log",): self.log.lines,
            ("reports",): self.reports.marks,
        }

    def values(self) -> dict[str, Any]:
        """Return the other members of a frame, whole."""
        now, walk = self.now, self.walk
        links = {site.words: link_frame(walk.links[site], now) for site in Site if site in walk.links}
        silent_since, (since, activity) = feet_silent_since(walk.links, now), walk.timeline.last
        silent = frozenset(site for site, link in links.items() if link["state"] in ("silent", "lost"))
        left, right = [one.phase for one in self.feet.values()]
        down, fused = walk.touchdown, walk.fused
        legs = None if self.body is None else self.body.frame(now)
        if legs is None and down is not None and down.legs is not None:
            legs = body_frame(down.t, down.legs)
        return {
            "feet": {foot.value: one.frame(walk.feet.get(foot, NO_COUNTS)) for foot, one in self.feet.items()},
            "wearer": self.wearer.wearer_frame(),
            "place": self.wearer.place_frame(walk.places.last),
            "activity": activity_frame(since, activity, silent_since),
            "pace": None if silent_since is not None else self.pace.frame(now, activity, since, walk.spoilt_feet),
            "support": None if left is None or right is None else SUPPORT[left][right].value,
            "touchdown": None if down is None else members(down, "t", "foot", "mode", "position"),
            "body": legs,
            "spoilt": [foot.value for foot in walk.spoilt_feet],
            "fused": None if fused is None else _fused_frame(fused),
            "scales": self.scales.frame(),
            **self.gait_means.frames(walk.recent_gait, walk.gait),
            "findings": findings_frame(walk, silent),
            "links": links,
            "playback": None if self.playback is None else self.playback.frame(),
            "posture": None if self.guide is None else plain(self.guide),
        }


@define
class Follower:
    """The record of what one page was sent of a scene, from which it follows what comes next.

    `message` takes some 0.1 ms and is for at most 30 calls a second."""

    _scene: Scene | None = None
    _layouts: list[Layout | None] = field(factory=list)
    _counts: dict[tuple[str, ...], int] = field(factory=dict)
    """Count of changes of each list."""
    _values: dict[str, Any] = field(factory=dict)

    def message(self, scene: Scene, control: bool = False) -> dict[str, Any] | None:
        """Return the message "frame" with what has changed; None when nothing has.

        It is "scene" at first, for another scene, with a new layout, and after a track was revised. `control` says
        whether the page may send commands."""
        lists, values, sent = scene.lists(), scene.values(), self._values
        layouts = [one.layout for one in scene.feet.values()]
        is_whole = scene is not self._scene or layouts != self._layouts
        news = {} if is_whole else {place: one.since(self._counts[place]) for place, one in lists.items()}
        self._scene, self._layouts, self._values = scene, layouts, values
        self._counts = {place: one.count for place, one in lists.items()}
        if is_whole or None in news.values():
            return scene.whole_message(control)
        message = {key: value for key, value in values.items() if value != sent[key]}
        message |= _nested({place: items for place, items in news.items() if items})
        return scene.frame_message(message) if message else None

    def restart(self) -> None:
        """Send the whole scene again."""
        self._scene = None


def _nested(members: dict[tuple[str, ...], Any]) -> dict[str, Any]:
    """Return members of a message, those with two names as objects."""
    message: dict[str, Any] = {}
    for (key, *names), value in members.items():
        for name in names:
            message.setdefault(key, {})[name] = value
        if not names:
            message[key] = value
    return message


def _fused_frame(fused: StrideFused) -> dict[str, Any]:
    """Return the member "fused": the last stride of a recipe that fuses strides (Chen et al. 2019, (9) to (13))."""
    names = ("t", "foot", "similarity", "error_index", "chosen", "distance")
    lengths = {"length": plain(fused.stride_length), "share": plain(fused.coefficient)}
    return members(fused, *names, error_index=4, distance=2) | lengths
