"""Runs the loop of the README over a recording of packets.

    solepath demo --record walk.jsonl
    python examples/own_loop.py walk.jsonl

The loop for live data is the same: make a Packet of every Bluetooth notification and feed it. While nothing arrives,
call `session.advance(now)` several times a second, so that a silent device is reported (StreamStale).
"""

import sys

from solepath import HeelStrike, PacketRejected, Session, StrideTaken
from solepath.recording import read_packets

if len(sys.argv) != 2:
    sys.exit("usage: own_loop.py RECORDING   (solepath demo --record RECORDING makes one)")

session = Session()
for packet in read_packets(sys.argv[1]):  # Packet(t, site, channel, data)
    for event in session.feed(packet):
        match event:
            case HeelStrike(foot=foot, t=t):
                print(f"{t:7.2f} s  {foot.value} heel-strike")
            case StrideTaken(foot=foot, t=t, length=length, position=(x, y, _)):
                print(f"{t:7.2f} s  {foot.value} stride of {length:.2f} m, now at {x:.2f}, {y:.2f}")
            case PacketRejected(t=t, reason=reason):
                print(f"{t:7.2f} s  a packet was not used: {reason.value}")
session.finish()
if session.position is not None:
    x, y, _ = session.position.position
    print(f"the wearer stands {x:.2f} m ahead and {y:.2f} m to the left of where they began")
