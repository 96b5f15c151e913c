"""Plays a recording: feeds a session at the pace of a watcher, with pause, speed and seek.

    player = Player(PackedItems(source), Session(poses=True, pressures=True, losses=True), Scene(...))
    player.advance(0.02)                    # 0.02 s of wall time passed
    player.feed_due(should_stop)            # feed the items that are due, until `should_stop()`
    player.seek(30.0)

The player reads no clock and uses no event loop; player_loop.py does. Numbers without a source were chosen by hand and
not swept."""

from __future__ import annotations

import pickle
import zlib
from collections.abc import Callable, Sequence
from copy import copy

from attrs import define, field, frozen

from ....events import Event
from ....floorplan.index import IndexedPlan
from ....link.driver import Driver
from ....session import Session
from ....types import Packet, Sample
from ..body import LiveBody
from ..messages import Command, CommandError
from ..scene.scene import Scene
from .packed_items import PackedItems
from .playback import Playback

STATE_SPACING = 10.0
"""Least time of the recording between two saved states, s; computing 10 s again takes some 0.2 s."""
MAX_SAVED_STATES = 60
"""Largest number of saved states; those of a long recording are farther apart."""
MAX_ELAPSED = 0.25
"""Longest wall time that one call of `advance` counts, s: a recording does not jump after the computer slept."""

OnEvents = Callable[[Packet | Sample | None, list[Event]], None]
"""Function that gets each item and the events that the session returned for it, at the end None and the last events."""


@frozen
class _SavedState:
    """The compressed `state` of session and scene at `t`, s, before item number `next` was fed."""

    t: float
    next: int
    state: bytes


@define
class Player:
    """Plays `items` through a new `session` into a new `scene`, as a watcher commands.

    `plan` is the floor plan of the session. `fault` says why the recording cannot be read beyond its last item; the
    scene shows it at the end. `on_events` gets every item once and in order, however often the item is played.

    Scene and snapshot at a time of the recording do not depend on what was played, skipped or played again before.
    Memory holds the items (PackedItems says how much), and up to MAX_SAVED_STATES states of some 0.1 MB."""

    items: PackedItems
    session: Session
    scene: Scene
    plan: IndexedPlan | None = None
    profiles: Sequence[Driver] = ()
    """Devices that an app added to the session."""
    fault: str = ""
    on_events: OnEvents | None = None
    spacing: float = STATE_SPACING
    """Least time of the recording between two saved states, s."""
    playback: Playback = field(init=False)
    _next: int = field(default=0, init=False)
    """Index of the next item to feed; that of the end after the last one, and one more after the end."""
    _furthest: int = field(default=0, init=False)
    """Number of items that were ever fed; one more after `on_events` got the end."""
    _due: float = field(init=False)
    """Time of the recording up to which items are due, s."""
    _saved: list[_SavedState] = field(factory=list, init=False)

    def __attrs_post_init__(self) -> None:
        start, end = self.items.start, self.items.end
        self._due = start
        self.spacing = max(self.spacing, (end - start) / MAX_SAVED_STATES)
        self.playback = Playback(start, end, start, "playing")
        self._show_session()
        self._save(start)

    def command(self, command: Command) -> None:
        """Execute a command of the page; a time beyond an end is replaced by that end.

        CommandError is raised for a position that a person reports: nothing is received while a recording plays."""
        match command:
            case Command("play"):
                self.play()
            case Command("pause"):
                self.pause()
            case Command("speed", float(speed)):
                self.playback.speed = speed
            case Command("seek", float(t)):
                self.seek(t)
            case _:
                raise CommandError("a browser reported a position, and a recording is played")

    def play(self) -> None:
        """Continue to play; a recording that has ended plays from its start."""
        if self.playback.state == "ended":
            self.seek(self.playback.start)
        self.playback.state = "playing"

    def pause(self) -> None:
        """Pause, unless the recording is paused or has ended."""
        if self.playback.state == "playing":
            self.playback.state = "paused"

    def seek(self, t: float) -> None:
        """Go to the time `t` of the recording, s; `feed_due` then computes what lies before it.

        A recording that has ended plays on from `t`."""
        playback = self.playback
        t = min(max(t, playback.start), playback.end)
        nearest = next(saved for saved in reversed(self._saved) if saved.t <= t)
        if t < playback.t or nearest.next > self._next:
            self._restore(nearest)
            playback.t = max(playback.start, nearest.t)
            if playback.state == "ended":
                playback.state = "playing"
        self._due = t
        playback.seeking = t if self._is_behind else None

    def advance(self, seconds: float) -> None:
        """Let wall time pass, s; while the player is behind, time that passes is not counted."""
        playback = self.playback
        if playback.state == "playing" and playback.t >= self._due:
            self._due = min(playback.end, self._due + min(seconds, MAX_ELAPSED) * playback.speed)

    def feed_due(self, should_stop: Callable[[], bool]) -> bool:
        """Feed the items that are due, checking `should_stop()` after each; return whether more are due."""
        playback = self.playback
        while self._is_behind:
            self._feed()
            if should_stop():
                break
        if self._is_behind:
            playback.t = max(playback.t, min(self._due, self.items.t(self._next - 1)))
            self.scene.tick(playback.t)
            return True
        if self._next >= len(self.items):
            playback.state = "ended"
        if self._next == len(self.items):
            self._feed()
        playback.t, playback.seeking = self._due, None
        self.scene.tick(playback.t)
        return False

    def run_through(self, should_stop: Callable[[], bool]) -> bool:
        """Feed the rest of the recording until `should_stop()`; return whether `on_events` still lacks a part of it."""
        if self._furthest > len(self.items):
            return False
        if self._due < self.playback.end or not self._is_behind:
            self.seek(self.playback.end)
        self.feed_due(should_stop)
        return self._furthest <= len(self.items)

    @property
    def delivered_count(self) -> int:
        """Number of items that `on_events` got."""
        return min(self._furthest, len(self.items))

    @property
    def _is_behind(self) -> bool:
        return self._next < len(self.items) and self.items.t(self._next) <= self._due

    def _feed(self) -> None:
        """Feed the next item, and after the last one end the session."""
        items, is_end = self.items, self._next == len(self.items)
        item = None if is_end else items[self._next]
        events = self.session.finish() if item is None else self.session.feed(item)
        self.scene.take(item, events)
        if is_end and self.fault:
            self.scene.log.add(items.end, "link", self.fault)
        self._next += 1
        if self._next > self._furthest:
            self._furthest = self._next
            if self.on_events is not None:
                self.on_events(item, events)
            if not is_end and items.t(self._next - 1) >= self._saved[-1].t + self.spacing:
                self._save(items.t(self._next - 1))

    def _save(self, t: float) -> None:
        scene = copy(self.scene)
        scene.plan = scene.playback = scene.body = None  # `_restore` sets them again
        saved = pickle.dumps((self.session.snapshot(), scene), pickle.HIGHEST_PROTOCOL)  # only this process reads it
        self._saved.append(_SavedState(t, self._next, zlib.compress(saved, 1)))

    def _restore(self, saved: _SavedState) -> None:
        plan = self.scene.plan
        snapshot, self.scene = pickle.loads(zlib.decompress(saved.state))
        self.session = Session.restore(snapshot, profiles=self.profiles, floorplan=self.plan)
        self.scene.plan = plan
        self._show_session()
        self._next = saved.next

    def _show_session(self) -> None:
        self.scene.playback, self.scene.body = self.playback, LiveBody(self.session)
