"""For the maker of a sensor, or its owner: a device that solepath does not know, declared in one file.

    python examples/own_device.py

You see that the declaration agrees with own_device.json (bytes and their meaning, worked out by hand from the data
sheet), then a walk in this device's bytes, three lost packets, and the stride they fall in. docs/device.md explains it.
"""

import json
from math import radians
from pathlib import Path

from construct import Const, Int16ul, Struct, Terminated

from solepath import (
    Access,
    Channel,
    Driver,
    Fields,
    Foot,
    Measured,
    Packet,
    Profile,
    Reading,
    SampleGap,
    Session,
    Site,
    StrideTaken,
    Write,
)
from solepath.emulate import Route, Walker
from solepath.testing.vectors import disagreements

UUID = "5d1e000{}-9c60-4cf1-a1b3-1a2b3c4d5e6f".format
MOTION = Channel("shoe/motion", UUID(1), UUID(2), Access.NOTIFY)
START = Channel("shoe/start", UUID(1), UUID(3), Access.WRITE)
PROFILE = Profile(
    name="shoe", names=("My shoe",), services=(UUID(1),), channels=(MOTION, START), streams=("shoe/motion",),
    setup=(Write("shoe/start", b"\xc2"),), nominal_rate=100.0, stale_after=1.0,
)  # fmt: skip
FORMATS = {
    "shoe/motion": Struct(
        "number" / Int16ul, "ticks" / Int16ul, "acc" / Fields("<3h"), "gyro" / Fields("<3h"), Terminated
    ),
    "shoe/start": Struct(Const(b"\xc2"), Terminated),
}
ACC, GYRO = 16 * 9.80665 / 32768, radians(2000 / 32768)  # m/s^2 and rad/s for one count


def motion(sent, known):
    sample = Measured(acc=tuple(v * ACC for v in sent.acc), gyro=tuple(v * GYRO for v in sent.gyro))
    return Reading((sample,), sequence=sent.number, ticks=sent.ticks)


DRIVER = Driver(PROFILE, FORMATS, {"shoe/motion": motion}, sequence=65536, tick_rate=4096.0, tick_modulus=65536)

if __name__ == "__main__":  # `solepath track FILE --driver own_device.py` loads this file as well
    vectors = json.loads(Path(__file__).with_suffix(".json").read_text())
    print(disagreements(DRIVER, vectors) or "the vectors agree")
    session = Session(profiles=[DRIVER])
    for k, true in enumerate(Walker(Route().stand(2).walk(8).stop(2)).samples(Foot.LEFT, 100.0)):
        counts = {"acc": [round(v / ACC) for v in true.acc], "gyro": [round(v / GYRO) for v in true.gyro]}
        data = DRIVER.write("shoe/motion", {"number": k, "ticks": round(4096 * true.t) % 65536, **counts})
        if 500 <= k < 503:
            continue  # three packets are lost
        for event in session.feed(Packet(true.t + 0.01, Site.LEFT_FOOT, "shoe/motion", data)):
            match event:
                case StrideTaken(t=t, length=length, longest_gap=gap):
                    print(f"{t:6.2f} s  stride of {length:.2f} m{', with a gap in it' if gap else ''}")
                case SampleGap(t=t, count=count):
                    print(f"{t:6.2f} s  {count} samples missing")
