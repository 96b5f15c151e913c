"""Plays a recording: feeds a session at the pace of a watcher, with pause, speed and seek.

    player = Player(PackedItems(source), Session(poses=True, pressures=True), Scene(...))
    player.advance(0.02)                    # so much wall time passed
    player.feed_due(should_stop)            # feed what is due, until `should_stop()`
    player.seek(30.0)

It reads no clock and knows no event loop; player_loop.py does."""

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
"""Time of the recording between two saved states at first, s; so much is computed again in a fifth of a second."""
MAX_SAVED_STATES = 60
"""Largest number of saved states: with more, every other one is dropped and the spacing doubles."""
LONGEST = 0.25
"""Wall time that counts as passed at once, s: after the computer slept, nothing of the recording is skipped."""

OnEvents = Callable[[Packet | Sample | None, list[Event]], None]
"""Takes an item and the events that the session reported of it; None and the last events at the end."""


@frozen
class _SavedState:
    """State of the player at a time, before the item `next` was fed; `session` and `scene` are compressed."""

    t: float
    next: int
    session: bytes
    scene: bytes


@define
class Player:
    """Plays `items` through `session` into `scene`, both new, as a watcher commands.

    `plan` is the floor plan of the session. `fault` says why the recording goes no further than its last item; the
    scene shows it there. `on_events` gets every item once and in order, however often it is played again, so that its
    result does not depend on the commands.

    The scene at a time of the recording, and the session's snapshot there, are the same whatever was played, skipped or
    seen again before. Memory: the items (PackedItems says how much), and MAX_SAVED_STATES saved states of some 0.1 MB."""

    items: PackedItems
    session: Session
    scene: Scene
    plan: IndexedPlan | None = None
    fault: str = ""
    on_events: OnEvents | None = None
    spacing: float = SPACING
    """Time of the recording between two saved states, s; it doubles when there are MAX_SAVED_STATES."""
    playback: Playback = field(init=False)
    _next: int = field(default=0, init=False)
    """Index of the item that comes next."""
    _frontier: int = field(default=0, init=False)
    """Number of items that were ever fed, plus one once `on_events` got the end."""
    _finished: bool = field(default=False, init=False)
    _due: float = field(init=False)
    """Time up to which the recording is to be played, s."""
    _saved: list[_SavedState] = field(factory=list, init=False)

    def __attrs_post_init__(self) -> None:
        start, end = self.items.start, self.items.end
        self._due = start
        self.playback = Playback(start=start, end=end, t=start, state="playing", speed=1.0, seeking=None)
        self.scene.playback = self.playback
        self._save(start)

    def command(self, command: Command) -> None:
        """Execute a command of the page; a value out of range counts as the nearest in range."""
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
        """Continue; from the start, when it had come to the end."""
        if self.playback.state == "ended":
            self.seek(self.playback.start)
        self.playback.state = "playing"

    def pause(self) -> None:
        """Pause, when it is playing."""
        if self.playback.state == "playing":
            self.playback.state = "paused"

    def speed(self, times: float) -> None:
        """Set the speed in multiples of real time, limited to SLOWEST to FASTEST."""
        self.playback.speed = min(max(times, SLOWEST), FASTEST)

    def seek(self, t: float) -> None:
        """Go to `t` s of the recording, from the nearest saved state; `feed_due` then computes as fast as it can.

        After the end had been reached, it plays on from there."""
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
        """Let wall time pass; time in which the player could not keep up is not made up for."""
        now = self.playback
        if now.state == "playing" and now.t >= self._due:
            self._due = min(now.end, self._due + min(seconds, LONGEST) * now.speed)

    def feed_due(self, should_stop: Callable[[], bool]) -> bool:
        """Feed what is due, one item at least and no more once `should_stop()`; return whether more is due."""
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
        """Feed as `feed_due`, but to the end at full speed; return whether there is more.

        When it returns False, `on_events` got all of the recording."""
        if self._frontier > len(self.items):
            return False
        if self._due < self.playback.end or not self._behind:
            self.seek(self.playback.end)
        self.feed_due(should_stop)
        return self._frontier <= len(self.items)

    @property
    def done(self) -> int:
        """Number of items that `on_events` got."""
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
        # none of them belongs to the saved state, and plans are large
        scene.plan = scene.drawing = scene.playback = None
        session = json.dumps(self.session.snapshot()).encode()
        packed = pickle.dumps(scene, pickle.HIGHEST_PROTOCOL)  # only this process reads it
        self._saved.append(_SavedState(t, self._next, zlib.compress(session, 1), zlib.compress(packed, 1)))
        if len(self._saved) > MAX_SAVED_STATES:
            del self._saved[1::2]
            self.spacing *= 2.0

    def _restore(self, moment: _SavedState) -> None:
        plan, drawing = self.scene.plan, self.scene.drawing
        self.session = Session.restore(json.loads(zlib.decompress(moment.session)), floorplan=self.plan)
        self.scene = pickle.loads(zlib.decompress(moment.scene))
        self.scene.plan, self.scene.drawing, self.scene.playback = plan, drawing, self.playback
        self._next, self._finished = moment.next, False
