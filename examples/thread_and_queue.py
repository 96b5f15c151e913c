"""An app's loop without asyncio: a thread that receives, a bounded queue, and one thread that holds the session.

    python examples/thread_and_queue.py                     an emulated walk, as fast as the app takes it
    python examples/thread_and_queue.py walk.jsonl [SPEED]  a recording (solepath demo --record walk.jsonl), real time

A session belongs to one thread; a Bluetooth library's callback only puts packets into a queue. When the queue is full,
packets are dropped, counted and reported. While it is empty, the session advances. When the app goes to the background,
the session is saved, and later restored.
"""

import json
import queue
import sys
import threading
import time
from collections.abc import Callable, Iterator
from math import inf

from solepath import Event, Foot, Packet, PacketsDropped, Session, Site, StreamResumed, StreamStale, StrideTaken
from solepath.emulate import Route, emulate
from solepath.link.catalogue import PROFILES
from solepath.recording import read_packets
from solepath.wire.receiver import build_dropped

# Packets of these channels may be dropped. A layout or a range is sent only once and must not be dropped.
STREAMS = {name for profile in PROFILES for name in profile.streams}


class Clock:
    """The clock of the packets' times, at `speed` times real time. An app uses time.monotonic()."""

    def __init__(self, speed: float, t_start: float) -> None:
        self.speed, self.t_start, self.t, self.started_at = speed, t_start, t_start, time.monotonic()
        self.app_waits = threading.Event()

    def advance_to(self, t: float) -> None:
        if self.speed == inf:  # as fast as the app consumes packets
            self.app_waits.wait()
            self.app_waits.clear()
        time.sleep(max(0.0, self.started_at + (t - self.t_start) / self.speed - time.monotonic()))
        self.t = t


class Receiver(threading.Thread):
    """The thread of a Bluetooth library, which calls `on_notification` for each packet."""

    def __init__(self, packets: Iterator[Packet], clock: Clock, capacity: int) -> None:
        super().__init__(name="receiver", daemon=True)
        self.packets, self.clock, self.listening_since = packets, clock, clock.t
        self.inbox: queue.Queue[list[Packet] | None] = queue.Queue(capacity)
        self.dropped, self.stopped, self.must_wait = dict[Site, int](), False, False

    def run(self) -> None:
        for packet in self.packets:
            while self.clock.t < packet.t and not self.stopped:
                self.clock.advance_to(min(packet.t, self.clock.t + 0.2))
            if self.stopped:
                break
            if packet.t >= self.listening_since:  # otherwise it was sent while the app was in the background
                self.on_notification(packet)  # in an app: Packet(time.monotonic(), site, channel, data)
        self.inbox.put(None)  # marks the end for the thread that reads the queue

    def on_notification(self, packet: Packet) -> None:
        """Put the packet into the queue. Wait for space only when the packet must not be dropped."""
        site, count = packet.site, self.dropped.get(packet.site, 0)
        report = [Packet(packet.t, site, "receiver/dropped", build_dropped(count), packet.device)] if count else []
        self.must_wait = packet.channel not in STREAMS
        try:
            self.inbox.put([*report, packet], block=self.must_wait)
            self.dropped[site] = 0
        except queue.Full:
            self.dropped[site] = count + 1


class App:
    """The app, whose methods run in one thread. `show` receives the events; a GUI passes them on to its own thread."""

    def __init__(self, packets: Iterator[Packet], clock: Clock, show: Callable[[Event], None]) -> None:
        self.packets, self.clock, self.show = packets, clock, show

    def listen(self, saved: str = "") -> None:
        """Start the app, or continue with the state that `stop` returned, perhaps in another process."""
        self.session = Session.restore(json.loads(saved)) if saved else Session()
        self.receiver = Receiver(self.packets, self.clock, capacity=200)  # one second of two insoles
        self.receiver.start()

    def run_once(self) -> bool:
        """Run the loop once; return False when the receiver has ended and the queue is empty."""
        inbox = self.receiver.inbox
        if inbox.empty():
            self.clock.app_waits.set()
        try:
            packets = inbox.get(timeout=max(0.02, 0.2 / self.clock.speed))
        except queue.Empty:
            packets = []
        if packets is None:
            inbox.put(None)  # for the next call
            return False
        # time passes even when nothing arrives
        for event in self.session.feed(packets) if packets else self.session.advance(self.clock.t):
            self.show(event)
        return True

    def stop(self) -> str:
        """Return the state as text, for a file, when the app goes to the background or ends."""
        self.receiver.stopped = True
        while self.run_once():
            pass  # the remaining packets are used; then the receiver's thread has ended
        return json.dumps(self.session.snapshot())

    def close(self) -> None:
        self.stop()
        for event in self.session.finish():
            self.show(event)


def show(event: Event) -> None:
    match event:
        case StrideTaken(t=t, foot=foot, length=length, degraded=degraded, number=number):
            print(f"{t:6.2f} s  {foot.value} stride of {length:.2f} m{', with a gap in it' if degraded else ''}")
            blocked_until = app.clock.t + 1.6 if number == 2 and foot is Foot.LEFT else 0.0  # the screen is busy
            while app.clock.t < blocked_until and app.receiver.is_alive() and not app.receiver.must_wait:
                app.clock.app_waits.set()
                time.sleep(0.001)
        case PacketsDropped(t=t, site=site, count=count):
            print(f"{t:6.2f} s  {site.value}: {count} packets dropped, the screen was too slow")
        case StreamStale(t=t, site=site) | StreamResumed(t=t, site=site):
            print(f"{t:6.2f} s  {site.value}: {'nothing comes' if isinstance(event, StreamStale) else 'samples again'}")


if len(sys.argv) > 1:
    sent, speed = list(read_packets(sys.argv[1])), float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
else:
    walk = emulate(Route().stand(2).walk(16, speed=1.3).stop(2), seed=5)
    sent, speed = [packet for packet in walk.packets if not 7.5 < packet.t < 9.5], inf  # the radio is silent for 2 s
app, background_at = App(iter(sent), Clock(speed, sent[0].t), show), sent[0].t + 11.0
app.listen()
try:
    while app.run_once():
        if app.clock.t > background_at:
            background_at, text = inf, app.stop()
            print(f"{app.clock.t:6.2f} s  paused, {len(text) / 1000:.0f} kB of state")
            app.clock.app_waits.set()
            app.clock.advance_to(app.clock.t + 2.4)
            app.listen(text)
except KeyboardInterrupt:
    pass
app.close()
print(f"{app.clock.t:6.2f} s  closed")
