"""An app's loop without asyncio: a thread that receives, a bounded queue, and one thread that holds the session.

    python examples/thread_and_queue.py                     an emulated walk, eight times as fast as life
    python examples/thread_and_queue.py walk.jsonl [SPEED]  a recording (solepath demo --record walk.jsonl)

What one learns: a session belongs to one thread; a Bluetooth library's callback only puts packets into a queue. What
to do when that is full (drop, count, say so), stays empty (advance), when the app goes to the background (save,
restore) and when it ends (stop the receiver, use what is left, finish).
"""

import json
import queue
import sys
import threading
import time
from collections.abc import Callable, Iterator

from solepath import Event, Foot, Packet, PacketsDropped, Session, Site, StepTaken, StreamResumed, StreamStale
from solepath.link.known import PROFILES
from solepath.recording import read_packets
from solepath.sim import Route, emulate
from solepath.wire.receiver import build_dropped

# What comes a hundred times a second may be dropped; a layout or a range, which comes once, may not.
STREAMS = {name for profile in PROFILES for name in profile.streams}


class Clock:
    """The time that packets are stamped with: time.monotonic() in an app, here that of the walk."""

    def __init__(self, speed: float, begin: float) -> None:
        self.speed, self.begin, self.began = speed, begin, time.monotonic()

    def now(self) -> float:
        return self.begin + (time.monotonic() - self.began) * self.speed


class Receiver(threading.Thread):
    """Stands for the thread that a Bluetooth library calls back on; `notified` is what such a callback does."""

    def __init__(self, packets: Iterator[Packet], clock: Clock, capacity: int) -> None:
        super().__init__(name="receiver", daemon=True)
        self.packets, self.clock, self.began = packets, clock, clock.now()
        self.inbox: queue.Queue[list[Packet] | None] = queue.Queue(capacity)
        self.dropped: dict[Site, int] = {}
        self.stopped = threading.Event()

    def run(self) -> None:
        for packet in self.packets:
            if packet.t < self.began:
                continue  # sent while nobody listened
            if self.stopped.wait(max(0.0, packet.t - self.clock.now()) / self.clock.speed):
                break
            self.notified(packet)  # a library's callback makes it: Packet(time.monotonic(), site, channel, data)
        self.inbox.put(None)  # no more comes; whoever takes from the queue goes on until this

    def notified(self, packet: Packet) -> None:
        """Never waits for the app, unless the packet is one that all others are read with."""
        site, count = packet.site, self.dropped.get(packet.site, 0)
        told = [Packet(packet.t, site, "receiver/dropped", build_dropped(count), packet.device)] if count else []
        try:
            self.inbox.put([*told, packet], block=packet.channel not in STREAMS)
        except queue.Full:
            self.dropped[site] = count + 1
        else:
            self.dropped.pop(site, None)


class App:
    """All of it is called by one thread. `show` takes what happened; a GUI hands it on to its own thread there."""

    def __init__(self, packets: Iterator[Packet], clock: Clock, show: Callable[[Event], None]) -> None:
        self.packets, self.clock, self.show = packets, clock, show
        self.session = Session()
        self.listen()

    def listen(self) -> None:
        self.receiver = Receiver(self.packets, self.clock, capacity=200)  # one second of two insoles
        self.receiver.start()

    def turn(self) -> bool:
        """One turn of the loop; False when the receiver has ended and everything is used."""
        try:
            packets = self.receiver.inbox.get(timeout=0.2 / self.clock.speed)
        except queue.Empty:  # time has passed all the same
            events = self.session.advance(self.clock.now())
        else:
            if packets is None:
                self.receiver.inbox.put(None)  # for whoever asks again
                return False
            events = self.session.feed(packets)
        for event in events:
            self.show(event)
        return True

    def stop(self) -> None:
        self.receiver.stopped.set()
        while self.turn():
            pass  # what waits is used; then the receiver's thread has ended

    def pause(self) -> str:
        """The app goes to the background; its state, for a file."""
        self.stop()
        return json.dumps(self.session.snapshot())

    def resume(self, text: str) -> None:
        """It comes back, perhaps as another process."""
        self.session = Session.restore(json.loads(text))
        self.listen()

    def close(self) -> None:
        self.stop()
        for event in self.session.finish():
            self.show(event)


def show(event: Event) -> None:
    match event:
        case StepTaken(t=t, foot=foot, stride_length=length, degraded=degraded, number=number):
            print(f"{t:6.2f} s  {foot.value} step of {length:.2f} m{', with a gap in it' if degraded else ''}")
            if number == 2 and foot is Foot.LEFT:
                time.sleep(0.2)  # the screen hangs
        case PacketsDropped(t=t, site=site, count=count):
            print(f"{t:6.2f} s  {site.value}: {count} packets dropped, the screen was too slow")
        case StreamStale(t=t, site=site):
            print(f"{t:6.2f} s  {site.value}: nothing comes")
        case StreamResumed(t=t, site=site):
            print(f"{t:6.2f} s  {site.value}: heard again")


if len(sys.argv) > 1:
    sent, speed = list(read_packets(sys.argv[1])), float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
else:
    walk = emulate(Route().stand(2).walk(16, speed=1.3).stop(2), seed=5)
    sent, speed = [packet for packet in walk.packets if not 7.5 < packet.t < 9.5], 8.0  # the radio falls silent
app = App(iter(sent), Clock(speed, sent[0].t), show)
background = sent[0].t + 11.0
try:
    while app.turn():
        if app.clock.now() > background:
            background, text = float("inf"), app.pause()
            print(f"{app.clock.now():6.2f} s  paused, {len(text) / 1000:.0f} kB of state")
            time.sleep(0.3)
            app.resume(text)
except KeyboardInterrupt:
    pass
app.close()
print(f"{app.clock.now():6.2f} s  closed")
