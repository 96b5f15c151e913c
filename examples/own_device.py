"""Declares a device of your own in one file: the layout of its bytes, their meaning, and what is written to it.

    python examples/own_device.py

The device is invented. It sends 100 samples a second of 16 bytes each, with a number of 15 bits and without a time. The
program checks the declaration against own_device.json, which has bytes and their meaning, worked out by hand. Real
devices are declared in the same way in solepath/link/devices. Pass the declaration to
`ble.DeviceConfig(site, profile=PROFILE)` and `Session(profiles=[DRIVER])`.
"""

import json
from math import radians
from pathlib import Path

from construct import Const, Int16ub, OneOf, Struct, Terminated

from solepath import BatteryLevel, Foot, Packet, PacketsLost, Session, Site, StrideTaken
from solepath.emulate import Route, Walker
from solepath.link.driver import Driver, Measured, Reading
from solepath.link.profile import Access, Channel, Profile, Write
from solepath.testing.vectors import disagreements
from solepath.wire.fields import Fields

SERVICE = "5d1e0001-9c60-4cf1-a1b3-1a2b3c4d5e6f"
PROFILE = Profile(
    name="shoe",  # first part of the channel names
    names=("My shoe",),  # as it advertises
    services=(SERVICE,),
    channels=(
        Channel("shoe/motion", SERVICE, "5d1e0002-9c60-4cf1-a1b3-1a2b3c4d5e6f", Access.NOTIFY),
        Channel("shoe/start", SERVICE, "5d1e0003-9c60-4cf1-a1b3-1a2b3c4d5e6f", Access.WRITE),
    ),
    setup=(Write("shoe/start", b"\xc2"),),
    reads=(),
    nominal_rate=100.0,  # samples a second, after setup
    streams=("shoe/motion",),
    stale_after=1.0,  # s without data until StreamStale
)

FORMATS = {  # construct reads and writes them
    "shoe/motion": Struct(
        "number" / OneOf(Int16ub, range(1 << 15)),
        "battery" / OneOf(Int16ub, range(1001)),  # per mille
        "acc" / Fields("<3h"),  # 8 g full scale
        "gyro" / Fields("<3h"),  # 1/16 degree/s
        Terminated,
    ),
    "shoe/start": Struct(Const(b"\xc2"), Terminated),
}
ACC, GYRO = 8 * 9.80665 / 32768, radians(1 / 16)


def motion(frame, settings):
    """Return one notification in SI units. `settings` has values that the device sent earlier, such as its range."""
    sample = Measured(acc=tuple(v * ACC for v in frame.acc), gyro=tuple(v * GYRO for v in frame.gyro))
    with_battery = frame.number % 1000 == 0  # the battery level is of interest only every ten seconds
    return Reading((sample,), sequence=frame.number, battery=frame.battery / 1000 if with_battery else None)


DRIVER = Driver(PROFILE, FORMATS, readers={"shoe/motion": motion}, sequence=1 << 15)

print(disagreements(DRIVER, json.loads(Path(__file__).with_suffix(".json").read_text())) or "the vectors agree")

session = Session(profiles=[DRIVER])
for k, true in enumerate(Walker(Route().stand(2).walk(8).stop(2)).samples(Foot.LEFT, 100.0)):
    counts = {"acc": [round(v / ACC) for v in true.acc], "gyro": [round(v / GYRO) for v in true.gyro]}
    data = DRIVER.write("shoe/motion", {"number": (32500 + k) % (1 << 15), "battery": 873, **counts})
    if 500 <= k < 503:
        continue  # three packets are lost
    for event in session.feed(Packet(true.t + 0.008, Site.LEFT_FOOT, "shoe/motion", data)):
        match event:
            case StrideTaken(t=t, number=number, length=length, degraded=degraded):
                print(f"{t:6.2f} s  stride {number}: {length:.2f} m{', with a gap in it' if degraded else ''}")
            case PacketsLost(t=t, count=count):
                print(f"{t:6.2f} s  {count} packets lost")
            case BatteryLevel(level=level):
                print(f"{event.t:6.2f} s  battery {level:.0%}")
