"""Playing a recording: a session fed at the pace of somebody who watches, with pause, speed and seek.

    player = Player(Kept(source), Session(poses=True, pressures=True), Scene(...))
    player.passed(0.02)                     # so much time went by on the wall
    player.work(enough)                     # feed what is due, until `should_stop()`
    player.seek(30.0)

It reads no clock and knows no event loop: playing.py is the side that does.
"""

from __future__ import annotations

import json
import pickle
import zlib
from collections.abc import Callable
from copy import copy

from attrs import define, field, frozen

from ....events import Event
from ....floorplan.index import IndexedPlan
from ....session import Session
from ....types import Packet, Sample
from ..messages import FASTEST, SLOWEST, Command
from ..scene.scene import Scene
from .packed_items import PackedItems
from .playback import Playback

SPACING = 10.0
"""s of the recording between two saved moments, at first: as much is computed again in a fifth of a second."""
MOST_SAVED = 60
"""Of which there are no more: then every other is dropped, and they lie twice as far apart."""
LONGEST = 0.25
"""s on the wall that count as passed at once: a computer that slept does not skip what it slept through."""

OnEvents = Callable[[Packet | Sample | None, list[Event]], None]
"""Takes an item and what the session said of it; None and what it said at the end."""


@frozen
class _SavedState:
    """All of it, at a time, before the item `next` was fed. `session` and `scene` are packed."""

    t: float
    next: int
    session: bytes
    scene: bytes


@define
class Player:
    """`items` through `session` into `scene`, both new, as somebody wants to see it.

    `plan`: the floor plan of the session. `fault`: why the recording goes no further than its last item, said in the
    scene there. `on_events` hears of every item once and in order, however often it is played again: what it makes of them
    does not depend on what somebody does with the player.

    What the scene shows at a time of the recording, and the session's snapshot there, are the same whatever was played,
    skipped or seen again before. Memory: the items (Kept says how much), and MOST_SAVED saved moments of some 0.1 MB.
    """

    items: PackedItems
    session: Session
    scene: Scene
    plan: IndexedPlan | None = None
    fault: str = ""
    on_events: OnEvents | None = None
    spacing: float = SPACING
    """s of the recording between two saved moments; doubles when there are MOST_SAVED."""
    playback: Playback = field(init=False)
    _next: int = field(default=0, init=False)
    """Which item comes next."""
    _frontier: int = field(default=0, init=False)
    """How many were ever fed; one more than there are when the end was told, too."""
    _finished: bool = field(default=False, init=False)
    _due: float = field(init=False)
    """To where it is to be played, s."""
    _saved: list[_SavedState] = field(factory=list, init=False)

    def __attrs_post_init__(self) -> None:
        start, end = self.items.start, self.items.end
        self._due = start
        self.playback = Playback(start=start, end=end, t=start, state="playing", speed=1.0, seeking=None)
        self.scene.playback = self.playback
        self._save(start)

    def command(self, command: Command) -> None:
        """What the page asks for. Values beyond what there is are taken as the nearest."""
        match command.do:
            case "play":
                self.play()
            case "pause":
                self.pause()
            case "speed" if command.value is not None:
                self.speed(command.value)
            case "seek" if command.value is not None:
                self.seek(command.value)

    def play(self) -> None:
        """Go on; from the beginning, when it had come to the end."""
        if self.playback.state == "ended":
            self.seek(self.playback.start)
        self.playback.state = "playing"

    def pause(self) -> None:
        if self.playback.state == "playing":
            self.playback.state = "paused"

    def speed(self, times: float) -> None:
        """Times real time, from SLOWEST to FASTEST."""
        self.playback.speed = min(max(times, SLOWEST), FASTEST)

    def seek(self, t: float) -> None:
        """To `t` of the recording, s: from the nearest saved moment as fast as it can be computed, in `feed_due`. What had
        come to its end plays on from there."""
        now = self.playback
        t = min(max(t, now.start), now.end)
        there = next(moment for moment in reversed(self._saved) if moment.t <= t)
        if t < now.t or there.next > self._next:
            self._restore(there)
            now.t = max(now.start, there.t)
            if now.state == "ended":
                now.state = "playing"
        self._due = t
        now.seeking = t if self._behind else None

    def advance(self, seconds: float) -> None:
        """So much time went by on the wall. Nothing is owed for time in which it could not keep up."""
        now = self.playback
        if now.state == "playing" and now.t >= self._due:
            self._due = min(now.end, self._due + min(seconds, LONGEST) * now.speed)

    def feed_due(self, should_stop: Callable[[], bool]) -> bool:
        """Feed what is due, one item at the least and no more once `should_stop()`; whether more is due."""
        now = self.playback
        while self._next < len(self.items) and self.items.t(self._next) <= self._due:
            self._feed()
            if should_stop():
                break
        if self._behind:
            now.t = max(now.t, min(self._due, self.items.t(self._next - 1)))
            self.scene.tick(now.t)
            return True
        if self._next == len(self.items):
            self._finish()
        now.t, now.seeking = self._due, None
        self.scene.tick(now.t)
        return False

    def run_through(self, should_stop: Callable[[], bool]) -> bool:
        """`feed_due`, but on to the end as fast as it can; whether there is more. `on_events` then has heard it all."""
        if self._frontier > len(self.items):
            return False
        if self._due < self.playback.end or not self._behind:
            self.seek(self.playback.end)
        self.feed_due(should_stop)
        return self._frontier <= len(self.items)

    @property
    def done(self) -> int:
        """How many items `on_events` has heard of."""
        return min(self._frontier, len(self.items))

    @property
    def _behind(self) -> bool:
        if self._next == len(self.items):
            return False
        return self.items.t(self._next) <= self._due

    def _feed(self) -> None:
        item = self.items[self._next]
        events = self.session.feed(item)
        self.scene.take(item, events)
        t = self.items.t(self._next)
        self._next += 1
        if self._next > self._frontier:
            self._frontier = self._next
            if self.on_events is not None:
                self.on_events(item, events)
            if t >= self._saved[-1].t + self.spacing:
                self._save(t)

    def _finish(self) -> None:
        self.playback.state = "ended"
        if self._finished:
            return
        self._finished = True
        events = self.session.finish()
        self.scene.take(None, events)
        if self.fault:
            self.scene.log.add(self.items.end, "link", self.fault)
        if self._frontier <= len(self.items):
            self._frontier = len(self.items) + 1
            if self.on_events is not None:
                self.on_events(None, events)

    def _save(self, t: float) -> None:
        scene = copy(self.scene)
        # neither belongs to the moment, and plans are large
        scene.plan = scene.drawing = scene.playback = None
        session = json.dumps(self.session.snapshot()).encode()
        packed = pickle.dumps(scene, pickle.HIGHEST_PROTOCOL)  # only ever read again by this process
        self._saved.append(_SavedState(t, self._next, zlib.compress(session, 1), zlib.compress(packed, 1)))
        if len(self._saved) > MOST_SAVED:
            del self._saved[1::2]
            self.spacing *= 2.0

    def _restore(self, moment: _SavedState) -> None:
        plan, drawing = self.scene.plan, self.scene.drawing
        self.session = Session.restore(json.loads(zlib.decompress(moment.session)), floorplan=self.plan)
        self.scene = pickle.loads(zlib.decompress(moment.scene))
        self.scene.plan, self.scene.drawing, self.scene.playback = plan, drawing, self.playback
        self._next, self._finished = moment.next, False
