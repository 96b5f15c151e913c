"""For the developer of an app: the whole loop, from the packets of the sensors to what a screen shows.

    python examples/own_loop.py              two emulated insoles, over a radio that loses one packet in fifty
    python examples/own_loop.py walk.jsonl   a recording (solepath demo --record walk.jsonl makes one)

You see each moment at which a foot touches or leaves the floor, and how much later it was known; each stride (what one
foot does from lying flat to lying flat again); and where the wearer stands at the end. Live data need the same loop:
make a Packet of every Bluetooth notification. While nothing arrives, call `session.advance(now)` several times a
second, so that a silent sensor is reported.
"""

import sys
from math import degrees, radians

from solepath import FootFlat, HeelOff, HeelStrike, PacketRejected, SampleGap, Session, StrideTaken, ToeOff

# Packet(t, site, channel, data): when it arrived (s), where it is worn, what it is, its bytes
if len(sys.argv) > 1:
    from solepath.recording import read_packets

    packets = read_packets(sys.argv[1])
else:
    from solepath.emulate import Radio, Route, emulate

    route = Route().stand(2).walk(6, speed=1.3).turn(radians(90), radius=1.5).walk(3).stop(2)
    packets = iter(emulate(route, radio=Radio(loss=0.02, jitter=0.03)).packets)
    print(f"The route ends at x {route.end.x:.2f} m (ahead), y {route.end.y:.2f} m (left).")

session = Session()
missing = 0
for packet in packets:
    for event in session.feed(packet):  # in the order in which they became known
        match event:
            case HeelStrike() | FootFlat() | HeelOff() | ToeOff():
                delay = 1000 * (event.known_at - event.t)
                print(f"{event.t:6.2f} s  {event.foot.value:5}  {type(event).__name__:10}  known {delay:3.0f} ms later")
            case StrideTaken(t=t, foot=foot, number=number, length=length, heading_change=turn):
                print(f"{t:6.2f} s  {foot.value:5}  stride {number}: {length:.2f} m, turned {degrees(turn):+.0f} deg")
            case SampleGap(count=count):
                missing += count
            case PacketRejected(t=t, reason=reason):
                print(f"{t:6.2f} s  a packet was not used: {reason.value}")
missing += sum(event.count for event in session.finish() if isinstance(event, SampleGap))  # told together with others

if session.position is not None:
    x, y, z = session.position.position
    print(f"The wearer stands at x {x:.2f} m, y {y:.2f} m. {missing} samples are missing.")
