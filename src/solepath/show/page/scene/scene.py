"""Turns events into messages for a page: a whole scene for a new watcher, then the changes.

protocol/page.md says what the messages hold. Nothing here uses a clock, a thread or a network."""

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
    PositionRejected,
    PositionReported,
    StrideTaken,
    ToeOff,
    TrackRevised,
    WearerMoved,
)
from ....floorplan.plan import FloorPlan
from ....recording import printable
from ....types import SITE_OF_FOOT, Foot, Packet, Sample, Site
from ....types.attrs import NOT_SAVED
from ....walk.valid import has_valid_numbers
from ....walk.walk import REJECTIONS, Walk
from ..body import LiveBody
from ..guide import Guide, guide_frame
from ..messages import EncodedOnce, rounded
from ..player.playback import Playback
from .bending import bend_of
from .both_feet import both_feet_frame
from .feet import NO_COUNTS, PHASE_OF_EVENT, FootScene
from .gait import SceneGaitMeans, ScenePace, activity_frame
from .growing import GrowingLists
from .links import SceneFindings, feet_silent_since, link_frame
from .log import SceneLog
from .plan_drawing import draw_plan
from .reports import SceneReports, report_words
from .scales import Scales
from .wearer import WearerScene

VERSION = 1


@frozen
class Cursor:
    """The record of what a watcher has been sent.

    `whole_count` is that of the scene that was sent whole, `numbers` how many items had been added to each list of it,
    `values` the value that was sent last for each other key."""

    whole_count: int
    numbers: dict[str, int]
    values: dict[str, Any]


@define
class Scene:
    """The state that a page shows of one session, which is made with `poses=True` and `pressures=True`.

    Times are in s on the session's clock; positions in m, in the world frame, places on `plan` in the plan frame.
    `source` is "live", "demo" or "recording". `newtons` are the feet whose calibration turns counts into N. A player
    writes `playback`, who measures a shoe or a walk `guide`. The scene feeds `walk` and shows its counts.
    `take` is cheap: it is called for every packet. `message_since` takes some 0.1 ms and is for at most 30 calls a
    second. Memory is bounded. Two threads must not use a scene at once."""

    title: str
    recipe: str
    source: str = "live"
    plan: FloorPlan | None = field(default=None, metadata=NOT_SAVED)
    playback: Playback | None = field(default=None, metadata=NOT_SAVED)
    guide: Guide | None = field(default=None, metadata=NOT_SAVED)
    body: LiveBody | None = field(default=None, metadata=NOT_SAVED)
    newtons: tuple[Foot, ...] = ()
    walk: Walk = field(factory=lambda: Walk(limit=0))
    feet: dict[Foot, FootScene] = field(factory=lambda: {foot: FootScene(foot) for foot in Foot}, init=False)
    wearer: WearerScene = field(factory=WearerScene, init=False)
    gait_means: SceneGaitMeans = field(factory=SceneGaitMeans, init=False)
    pace: ScenePace = field(factory=ScenePace, init=False)
    scales: Scales = field(factory=Scales, init=False)
    log: SceneLog = field(factory=SceneLog, init=False)
    findings: SceneFindings = field(factory=SceneFindings, init=False)
    reports: SceneReports = field(factory=SceneReports, init=False)
    whole_count: int = field(default=0, init=False)
    """Number of layouts that became known and of revised tracks; after each a watcher needs the whole scene again."""
    drawing: EncodedOnce | None = field(default=None, init=False, metadata=NOT_SAVED)  # of the plan, made once

    def __attrs_post_init__(self) -> None:
        self.drawing = None if self.plan is None else draw_plan(self.plan)

    def take(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """Add a packet or sample that the session was fed, and the events that it returned.

        None as the item means that nothing came: time passed or the session ended."""
        for event in events:
            if not isinstance(event, REJECTIONS):
                self.tick(event.known_at)  # a silent foot is shown as silent before the event that ends it
        self.walk.count_item(item, events)
        for event in events:
            if isfinite(event.known_at) and isfinite(event.t):
                self._show(event)
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
        self.findings.add_event(event)
        self.walk.add(event)
        handle = HANDLERS.get(type(event))
        if handle is not None:
            handle(self, event)
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

    def _connected(self, foot: Foot) -> bool:
        """Return whether a foot is connected; late samples of a broken connection do not count."""
        return self.walk.link(SITE_OF_FOOT[foot]).broken_at is None

    def _moved(self, event: FootMoved) -> None:
        if self._connected(event.foot):
            self.feet[event.foot].add_position(event)

    def _pressed(self, event: FootPressed) -> None:
        if self._connected(event.foot):
            self.feet[event.foot].add_pressure(event)
            self.scales.add_sample(event.foot, event.values)

    def _phase_started(self, event: HeelStrike | FootFlat | HeelOff | ToeOff) -> None:
        if self._connected(event.foot):
            self.feet[event.foot].start_phase(event.t, PHASE_OF_EVENT[type(event)])
            if isinstance(event, ToeOff):
                self.scales.end_stance(event.foot)

    def _stride_taken(self, event: StrideTaken) -> None:
        self.feet[event.foot].add_stride(event)

    def _layout_known(self, event: LayoutKnown) -> None:
        foot = event.site.foot
        if foot is not None and self.feet[foot].set_layout(event.layout):
            self.whole_count += 1
            self.scales.set_layout(foot, event.layout, foot in self.newtons or event.layout.scale is not None)

    def _reset(self, event: ClockReset) -> None:
        if event.site.foot is not None:
            self.pace.reset(event.site.foot)

    def _placed(self, event: Placed) -> None:
        level = self.wearer.add_place(event)
        if level is not None:
            self.log.add(event.t, "place", f"on {self._level_name(level)}")

    def _reported(self, event: PositionReported) -> None:
        moved = self.wearer.moved
        self.reports.add(event, None if moved is None else moved.position[:2])
        self.log.add(event.t, "here", printable(report_words(event, self._level_name(event.level)), 300))

    def _revised(self, event: TrackRevised) -> None:
        self.reports.settle(event)
        if has_valid_numbers(event):
            bend = bend_of(event, self.wearer.track.points)
            for foot_scene in self.feet.values():
                foot_scene.revise(bend, event.by)
            self.wearer.revise(event, bend)
            self.whole_count += 1

    def _level_name(self, level: str) -> str:
        names = [] if self.plan is None else [known.name for known in self.plan.levels if known.id == level]
        return names[0] if names and names[0] else f"level {level}"

    def whole_message(self) -> tuple[dict[str, Any], Cursor]:
        """Return the message "scene" with everything, and the cursor from which `message_since` continues."""
        values, lists = self._values(), self._lists()
        message = {
            "type": "scene",
            "v": VERSION,
            "title": self.title,
            "recipe": self.recipe,
            "source": self.source,
            "control": False,
            "plan": self.drawing,
            "layouts": {foot.value: one.layout_message(foot in self.newtons) for foot, one in self.feet.items()},
            **lists.whole(),
            "frame": {"type": "frame", "t": self._t(), **values, **lists.empty()},
        }
        return message, Cursor(self.whole_count, lists.numbers(), values)

    def message_since(self, cursor: Cursor) -> tuple[dict[str, Any] | None, Cursor]:
        """Return the message "frame" with what has changed since `cursor`, and the next cursor.

        The message is None when nothing has changed. It is "scene" for a watcher that is too far behind, or has an old
        layout or a track that was revised since."""
        if cursor.whole_count != self.whole_count:
            return self.whole_message()
        values, lists = self._values(), self._lists()
        message = {key: value for key, value in values.items() if value != cursor.values[key]}
        numbers = lists.numbers()
        if numbers != cursor.numbers:
            news = lists.since(cursor.numbers)
            if news is None:
                return self.whole_message()
            message |= news
        if not message:
            return None, cursor
        return {"type": "frame", "t": self._t(), **message}, Cursor(self.whole_count, numbers, values)

    def heartbeat_message(self) -> dict[str, Any]:
        """Return the message "frame" with nothing but the time."""
        return {"type": "frame", "t": self._t()}

    def _t(self) -> float:
        return rounded(self.now) or 0.0

    def _lists(self) -> GrowingLists:
        return GrowingLists(
            {**{foot.value: one.track for foot, one in self.feet.items()}, "wearer": self.wearer.track},
            {foot.value: one.phases for foot, one in self.feet.items()},
            self.wearer.places,
            {"log": self.log.lines, "reports": self.reports.marks},
        )

    def _values(self) -> dict[str, Any]:
        now, walk = self.now, self.walk
        links = {site: link_frame(walk.links[site], now) for site in Site if site in walk.links}
        feet: dict[str, Any] = {}
        for foot, foot_scene in self.feet.items():
            link = links.get(SITE_OF_FOOT[foot])
            rate = 0.0 if link is None else link["rate"]
            feet[foot.value] = foot_scene.frame(rate, walk.feet.get(foot, NO_COUNTS))
        silent_since, (since, activity) = feet_silent_since(walk.links, now), walk.timeline.last
        return {
            "feet": feet,
            "wearer": self.wearer.wearer_frame(),
            "place": self.wearer.place_frame(walk.places.last),
            "activity": activity_frame(since, activity, silent_since),
            "pace": None if silent_since is not None else self.pace.frame(now, activity, since, self.findings.unsound),
            **both_feet_frame(self.feet, walk, self.body),
            "scales": self.scales.frame(),
            **self.gait_means.frames(walk.recent_gait, walk.gait),
            "findings": self.findings.frame(
                frozenset(site for site, link in links.items() if link["state"] in ("silent", "lost"))
            ),
            "links": {site.words: link for site, link in links.items()},
            "playback": None if self.playback is None else self.playback.frame(),
            **guide_frame(self.guide),
        }


HANDLERS: dict[type, Callable[[Scene, Any], None]] = {
    FootMoved: Scene._moved,
    FootPressed: Scene._pressed,
    HeelStrike: Scene._phase_started,
    FootFlat: Scene._phase_started,
    HeelOff: Scene._phase_started,
    ToeOff: Scene._phase_started,
    StrideTaken: Scene._stride_taken,
    GaitCycleMeasured: lambda scene, event: scene.pace.add_stride(event),
    WearerMoved: lambda scene, event: scene.wearer.add_position(event),
    Placed: Scene._placed,
    PlaceLost: lambda scene, event: scene.wearer.forget_level(),
    PositionReported: Scene._reported,
    TrackRevised: Scene._revised,
    PositionRejected: lambda scene, event: scene.reports.settle(event),
    LayoutKnown: Scene._layout_known,
    ClockReset: Scene._reset,
}
"""Function that changes the scene at each event; the walk and the log get every event besides."""
