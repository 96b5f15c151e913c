"""Holds a walk that is measured now: its session, its scene, and both of them saved."""

from __future__ import annotations

import json
from time import monotonic

from attrs import define, field

from ...events import Event
from ...floorplan.index import IndexedPlan
from ...recording.packet_writer import format_packet
from ...saving.codec import SnapshotError
from ...session import Session
from ...session.host import TICK_INTERVAL
from ...session.json_host import JsonHost
from ...types import Packet, Site
from ...wire.receiver import PositionFrame, build_position
from ..page.scene.saved_scene import restore_scene, save_scene
from ..page.scene.scene import Scene

CLOCK_TOLERANCE = 1.0
"""Time by which the clocks of two pages may differ although none was set, s; chosen by hand."""


@define
class LiveWalk:
    """A session, and the scene that shows it; times are in s from the start of the walk."""

    session: Session
    scene: Scene
    plan: IndexedPlan | None = None
    finished: bool = False
    count: int = field(default=0, init=False)
    """Number of packets that the session was fed since this walk was started or restored."""
    host: JsonHost = field(init=False)
    """The devices that feed the session."""
    _clock_offset: float | None = field(default=None, init=False)
    """Time of the walk when this machine's monotonic clock was 0, s; None if the page does not say it."""
    _lines: list[bytes] = field(factory=list, init=False)
    """Lines of the packets that were fed since `take_lines`."""

    def __attrs_post_init__(self) -> None:
        self.host = JsonHost(self.session, observe=self._observe)

    @classmethod
    def restore(cls, text: str, plan: IndexedPlan | None) -> LiveWalk:
        """Return the walk that `save` returned; raise SnapshotError for any other text, or with another floor plan."""
        try:
            saved = json.loads(text)
            session_state, scene_state = saved["session"], saved["scene"]
        except (ValueError, TypeError, KeyError, RecursionError):
            raise SnapshotError("not a saved walk") from None
        session = Session.restore(session_state, floorplan=plan)
        return cls(session, restore_scene(scene_state, None if plan is None else plan.plan), plan)

    def save(self) -> str | None:
        """Return session and scene as JSON, from which `restore` continues; None before anything was received."""
        if self.session.now is None or self.scene.walk.item_count == 0:
            return None
        return json.dumps({"session": self.session.snapshot(), "scene": save_scene(self.scene)})

    def receive(self, text: str, now: float | None = None) -> str:
        """Return the answers of the host to messages of the page (protocol/host.md), which are received at `now`, s.

        With `now`, the time from the arrival of a frame until its events are there is noted too."""
        self._clock_offset = None if now is None else now - monotonic()
        return "[]" if self.finished else self.host.receive(text)

    def take_lines(self) -> bytes:
        """Return the lines of a recording of the packets since the last call."""
        lines = b"".join(self._lines)
        self._lines.clear()
        return lines

    def _observe(self, packet: Packet | None, events: list[Event]) -> None:
        offset = self._clock_offset
        self.scene.take(packet, events, None if offset is None else offset + monotonic())
        if packet is not None:
            self.count += 1
            self._lines.append(format_packet(packet))
        elif self.session.now is not None:
            self.scene.tick(self.session.now)

    def report_position(self, position: PositionFrame) -> None:
        """Add a packet receiver/position: a person reports where the wearer is at the newest known time."""
        now, sites = self.session.now, self.scene.walk.links
        if now is not None and not self.finished:
            packet = Packet(now, next(iter(sites), Site.LEFT_FOOT), "receiver/position", build_position(position))
            self._observe(packet, self.session.feed(packet))

    def advance(self, now: float) -> None:
        """Let time pass until `now`, s; a time before the newest packet changes nothing."""
        if self.session.now is not None and now > self.session.now:
            self._observe(None, self.session.advance(now))

    def replay(self, packet: Packet) -> None:
        """Feed a packet of a recording; time without packets passes as it did when the packet was received."""
        newest = self.session.now
        if newest is not None and packet.t > newest + TICK_INTERVAL:
            self.advance(packet.t)
        self.scene.take(packet, self.session.feed(packet))
        self.count += 1

    def resume(self, now: float) -> float:
        """Go on at `now`, s, after a time without packets; return the time of the walk from then on, s.

        A clock that was set back meanwhile goes on from the newest packet: how long nothing came is then unknown."""
        newest = self.session.now
        if newest is not None and now < newest - CLOCK_TOLERANCE:
            self.host.host.restart_clock(newest)
            return newest
        self.advance(now)
        return now

    def finish(self) -> None:
        """End the session; its last events are shown."""
        self.host.host.finish()
        self.finished = True
