"""A walk without hardware: an emulated wearer with two pressure insoles, and the events of a session.

python examples/emulated_walk.py
"""

from math import degrees, radians

from solepath import FootFlat, HeelOff, HeelStrike, PacketRejected, PacketsLost, Session, StrideTaken, ToeOff
from solepath.emulate import Radio, Route, emulate

# Stand, walk six metres, turn left on a bend, walk on, stop. The radio loses one packet in fifty.
route = Route().stand(2).walk(6, speed=1.3).turn(radians(90), radius=1.5).walk(3).stop(2)
walk = emulate(route, radio=Radio(loss=0.02, latency=0.015, jitter=0.030), seed=1)
print(f"{len(walk.packets)} packets in {walk.truth.duration:.1f} s. The first one:")
print(walk.packets[0])

# An app needs only a session, which opens no files or devices and never waits. Packets go in, events come out.
session = Session()
lost = rejected = 0
for packet in walk.packets:
    for event in session.feed(packet):  # in the order in which they became known
        match event:
            case HeelStrike() | FootFlat() | HeelOff() | ToeOff():
                # t is the time of the event, known_at that of the packet after which it could be reported.
                delay = 1000 * (event.known_at - event.t)
                print(f"{event.t:6.2f} s  {event.foot.value:5}  {type(event).__name__:10}  known {delay:3.0f} ms later")
            case StrideTaken(t=t, foot=foot, number=number, length=length, heading_change=turn):
                print(f"{t:6.2f} s  {foot.value:5}  stride {number}: {length:.2f} m, turned {degrees(turn):+.0f} deg")
            case PacketsLost(count=count):
                lost += count
            case PacketRejected():
                rejected += 1
session.finish()

end = route.end
print(f"\nThe route ends at x {end.x:.2f} m (ahead), y {end.y:.2f} m (left).")
if session.position is not None:
    x, y, z = session.position.position
    print(f"The session says  x {x:.2f} m,         y {y:.2f} m.")
print(f"{lost} packets lost, {rejected} rejected.")
