"""For an app without asyncio: one thread receives, a bounded queue, and one thread that holds the session.

    python examples/thread_and_queue.py    two emulated insoles, four times as fast as real time

The callback of a Bluetooth library only puts packets into a queue, and one thread owns the session. You see strides, a
screen that is busy for so long that packets are dropped, counted and reported, and a radio that is silent for two
seconds, which the app notices because it lets time pass.
"""

import queue
import threading
import time

from solepath import Packet, PacketsDropped, Session, Site, StreamResumed, StreamStale, StrideTaken
from solepath.emulate import Route, emulate
from solepath.wire.receiver import build_dropped

SPEED, STARTED = 4.0, time.monotonic()
inbox = queue.Queue[Packet | None](maxsize=200)  # one second of two insoles
dropped = dict.fromkeys(Site, 0)


def on_notification(packet: Packet) -> None:
    """Your Bluetooth library calls this in its thread, with Packet(time.monotonic(), site, channel, data)."""
    try:
        if count := dropped[packet.site]:
            inbox.put_nowait(Packet(packet.t, packet.site, "receiver/dropped", build_dropped(count), packet.device))
            dropped[packet.site] = 0
        inbox.put(packet, block=packet.channel != "insole/frame")  # what is sent only once must not be dropped
    except queue.Full:
        dropped[packet.site] += 1


def radio() -> None:
    for packet in emulate(Route().stand(2).walk(16, speed=1.3).stop(2), seed=5).packets:
        if not 7.5 < packet.t < 9.5:  # it is silent for two seconds
            time.sleep(max(0.0, packet.t / SPEED - (time.monotonic() - STARTED)))
            on_notification(packet)
    inbox.put(None)


threading.Thread(target=radio, daemon=True).start()
session, is_open = Session(), True
while is_open:
    try:
        packet = inbox.get(timeout=0.2 / SPEED)
        is_open = packet is not None
        events = session.feed(packet) if packet else session.finish()
    except queue.Empty:
        events = session.advance(SPEED * (time.monotonic() - STARTED))  # in an app: time.monotonic()
    for event in events:
        match event:
            case StrideTaken(t=t, foot=foot, length=length, number=number):
                print(f"{t:6.2f} s  {foot.value} stride of {length:.2f} m")
                while number == 2 and sum(dropped.values()) < 20:
                    time.sleep(0.01)  # the screen is busy until the queue is full
            case PacketsDropped(t=t, site=site) | StreamStale(t=t, site=site) | StreamResumed(t=t, site=site):
                print(f"{t:6.2f} s  {site.value}: {type(event).__name__} {getattr(event, 'count', '')}")
