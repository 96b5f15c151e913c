"""For a physiotherapist's app: a beep at each right heel-strike, and a warning when the left stance gets too long.

    python examples/feedback.py               an emulated wearer who gets slower, in real time
    python examples/feedback.py walk.jsonl    a recording (solepath demo --record walk.jsonl), as fast as it is read

You hear the bell of the terminal (BEL), and see what it rang for and how long after its cause. A signal whose deadline
has passed, because this program was kept from running, is dropped. docs/app.md has all rules.
"""

import sys
import time

from solepath import Foot, Session
from solepath.feedback import EveryHeelStrike, Feedback, StanceLonger

feedback = Feedback([EveryHeelStrike(Foot.RIGHT), StanceLonger(Foot.LEFT, 0.75)])
session = Session(poses=feedback.needs_poses, impacts=True)


def in_real_time(packets):
    """Yield each packet when it arrives, with the time of the host on the same clock."""
    started = time.monotonic()
    for packet in packets:
        time.sleep(max(0.0, started + packet.t - time.monotonic()))
        yield packet, time.monotonic() - started


if len(sys.argv) > 1:
    from solepath.recording import read_packets

    arrivals = ((packet, packet.t) for packet in read_packets(sys.argv[1]))
else:
    from solepath.emulate import Radio, Route, emulate

    route = Route().stand(2).walk(8, speed=1.3).walk(6, speed=0.7).stop(2)
    arrivals = in_real_time(emulate(route, radio=Radio(interval=0.03, loss=0.01)).packets)

for packet, now in arrivals:
    for signal in feedback.feed(session.feed(packet), now):
        what = type(signal.rule).__name__ + ("" if signal.value is None else f" {signal.value:.2f} s")
        print(f"\a{signal.t:6.2f} s  {signal.foot.value:5}  {what}, {1000 * (now - signal.t):.0f} ms later", flush=True)
