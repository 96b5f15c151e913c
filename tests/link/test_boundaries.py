"""Every field of every value of every channel at its boundaries: values and reasons by hand from the byte tables."""

from __future__ import annotations

import re
import struct
from binascii import crc_hqx
from functools import partial
from math import inf, pi
from typing import Any

import pytest
from attrs import frozen
from formats import FORMATS

from solepath.events import PacketRejected, Rejection
from solepath.link.catalogue import PROFILES  # internal: the list of all devices, which this table must have whole
from solepath.link.decoder import Decoder
from solepath.types import Packet, Sample, Site
from solepath.wire.error import WireError

TABLE = """
# channels : a valid value [: channel = value before] [: channel = value after]
# first bit | field | becomes | value in SI units of the number v | full scale | allowed ("=": as it is) | else why not
# "gyro" is of the newest sample, "0.gyro" of the oldest; "gyro?" is there if the field is not 0, "silent_for!" is not

insole/frame : f510 07 01 0000 00000000 4801 01 02 000000 000000000000 000000000000 0040000000000000 0000 <
  : : site right
0 | u16 |  |  |  | =
16 | u1 |  |  |  | v == 1 | wrong_site
17 | u2 |  |  |  | =
19 | u1 | saturated | v
20 | u1
21 | u3 |  |  |  | v == 0
24 | u8
32 | u16
48 | u32
80 | u16 |  |  |  | 1 <= v <= 65535
96 | u16 |  |  |  | =
112 | 2 x u12 | pressure | v
136 | 3 x i16 | acc | v * 16 / 32768 * g
184 | 3 x i16 | gyro | v * 2000 / 32768 * deg
232 | 4 x i16
296 | u16 |  |  |  | =

insole/frame : f510 06 01 0000 00000000 4801 01 03 000000 0000 000000000000 000000000000 0040000000000000 0000 <
  : insole/info = f511 00 01 07000000 00800000 4801
  0000003c 0000003b 0000403e f00a 03 01 00 000000000000000000 030000 0000 <
0 | u24 |  |  |  | =
24 | u8 |  |  |  | v == 1 | wrong_layout
32 | u80 |  |  |  | =
112 | 3 x u12 | pressure | v * 3 / 16
148 | u4 |  |  |  | v == 0
152 | 3 x i16 | acc | v / 128
200 | 3 x i16 | gyro | v / 512
248 | u80 |  |  |  | =

insole/info : f511 01 01 07000000 00800000 4801 0000003c 0000003b 0000403e f00a 02 01 01 000000000000 020100 31 0000 <
  : : insole/frame = f510 03 01 0000 00000000 4801 01 02 010000 010001000100 010001000100 0000 < : site right
0 | u8 |  |  |  | v == 245
8 | u8 |  |  |  | v == 17
16 | u1 |  |  |  | v == 1 | wrong_site
17 | u7 |  |  |  | v == 0
24 | u8 | layout.id | v |  | v == 1 | wrong_layout
32 | u32
64 | u32 |  |  |  | 100 <= v <= 4294967295 | absurd if 1 <= v <= 99 else malformed
96 | u16 |  |  |  | 1 <= v <= 65535
112 | f32 | acc.1 | v |  | v == 0.0 or 2.9628245544e-4 <= v <= 0.29927520752 | absurd if 0.0 <= v < inf else malformed
144 | f32 | gyro.1 | v |  | v == 0.0 or 5.3263222e-6 <= v <= 0.0532632218 | absurd if 0.0 <= v < inf else malformed
176 | f32 | layout.scale | v |  | 0.0 <= v <= 24.42002442 | absurd if 1.0 <= v < inf else malformed
208 | u16 | layout.length | v / 10000
224 | u24 |  |  |  | =
248 | u12 | layout.cells.0.x | v / 10000
260 | u12 | layout.cells.0.y | (v - 2048) / 10000
272 | u12 | layout.cells.1.x | v / 10000
284 | u12 | layout.cells.1.y | (v - 2048) / 10000
296 | u8 |  |  |  | v == 2
304 | u16 | layout.cells.1.area | v / 10000000
320 | u8 |  |  |  | 0 <= v <= 127
328 | u16 |  |  |  | =

insole/control : 03 0100
0 | u8 |  |  |  | =
8 | u16 |  |  |  | 1 <= v <= 65535

insole/control : 04 0000 01
0 | u8 |  |  |  | =
8 | u16
24 | u8 |  |  |  | 1 <= v <= 255

insole/control : 01
0 | u8 |  |  |  | 1 <= v <= 2 | truncated if 3 <= v <= 4 else malformed

cc2650/movement : 0000 0000 0000 0000 0000 0000 0000 0000 0000
0 | 3 x i16 | gyro | v * 500 / 65536 * deg | 32767
48 | 3 x i16 | acc | v * 8 / 32768 * g | 32767
96 | i16 | mag.1 | v * 4912 / 32760 * uT
112 | i16 | mag.0 | v * 4912 / 32760 * uT
128 | i16 | mag.2 | v * -4912 / 32760 * uT

cc2650/movement-config : 7f 02 : : cc2650/movement = 000000000000000000000010000000000000
0 | 3 x u1 | gyro?
3 | 3 x u1 | acc?
6 | u1 | mag?
7 | u1 | silent_for!
8 | u2 | acc.2 | [1/4, 1/2, 1, 2][v] * g
10 | u6 |  |  |  | v == 0

cc2650/movement-period cc2650/barometer-period cc2541/accelerometer-period cc2541/magnetometer-period : 0a
0 | u8 |  |  |  | 1 <= v <= 255

cc2541/barometer-period cc2541/gyroscope-period : 0a
0 | u8 |  |  |  | 1 <= v <= 255

cc2650/barometer : 000000 000000
0 | i24
24 | u24 | air_pressure | v

cc2650/barometer-config cc2541/magnetometer-config : 00
0 | u8 |  |  |  | 0 <= v <= 1

cc2650/keys : 00
0 | u1 | down:left
1 | u1 | down:right
2 | u1 | down:reed
3 | u5 |  |  |  | v == 0

cc2541/keys : 00
0 | u1 | down:right
1 | u1 | down:left
2 | u1 | down:side
3 | u5 |  |  |  | v == 0

cc2541/accelerometer : 000000
0 | 3 x i8 | acc | v / 16 * g

cc2541/accelerometer-config : 03 : : cc2541/accelerometer = 000010
0 | u8 | acc.2 | [1, 1/4, 1/2, 1][v] * g |  | 0 <= v <= 3

cc2541/gyroscope : 000000000000 : cc2541/accelerometer = 000000
0 | 3 x i16 | gyro | v * 500 / 65536 * deg | 32441

cc2541/gyroscope-config : 07
0 | 3 x u1
3 | u5 |  |  |  | v == 0

cc2541/magnetometer : 000000000000 : : cc2541/accelerometer = 000000
0 | 3 x i16 | mag | v * 2000 / 65536 * uT

cc2541/barometer : 0000 0000 : cc2541/barometer-calibration = 0000 0000 0100 0000 0000 0000 0000 0000
0 | i16
16 | u16 | air_pressure | v / 16384

cc2541/barometer-config : 01
0 | u8 |  |  |  | 0 <= v <= 2

cc2541/barometer-calibration : 0000 0000 0000 0000 0000 0000 0000 0000 : : cc2541/barometer = 0040 0080
0 | 2 x u16
32 | u16 | air_pressure | v * 2
48 | u16 | air_pressure | v / 4
64 | i16 | air_pressure | v / 32
80 | i16 | air_pressure | v
96 | i16 | air_pressure | v / 8
112 | i16 | air_pressure | v / 32

thingy/motion : 0000 0000 0000 0000 0000 0000 0000 0000 0000
0 | 3 x i16 | acc | -v / 1024 * g | 31744
48 | 3 x i16 | gyro | v / 32 * deg | 32736
96 | 3 x i16 | mag | v / 16 * uT

thingy/motion-config : e803 e803 6400 6400 00
0 | 2 x u16 |  |  |  | 100 <= v <= 5000
32 | u16 |  |  |  | 100 <= v <= 1000
48 | u16 |  |  |  | 5 <= v <= 200
64 | u8 |  |  |  | 0 <= v <= 1

thingy/pressure : f5030000 00
0 | i32 | air_pressure | v * 100 |  | -1000000 <= v <= 1000000 | absurd if -2147483648 <= v <= 2147483647 else malformed
32 | u8 | air_pressure | v + 101300 |  | 0 <= v <= 99

thingy/environment-config : 8813 e803 8813 8813 03 000000
0 | u16 |  |  |  | 100 <= v <= 5000
16 | u16 |  |  |  | 50 <= v <= 5000
32 | u16 |  |  |  | 100 <= v <= 5000
48 | u16 |  |  |  | 200 <= v <= 5000
64 | u8 |  |  |  | 1 <= v <= 3
72 | 3 x u8

orphe/values : 38 0000 00 00 00 0000 4000000000000000 000000000000 000000000000 000000000000000000000000
  4000000000000000 000000000000 000000000000 000000000000000000000000
  0000000000000000000000000000000000000000000000000000000000000000
0 | u8 |  |  |  | =
8 | >u16
24 | u8 |  |  |  | 0 <= v <= 23
32 | u8 |  |  |  | 0 <= v <= 59
40 | u8 |  |  |  | 0 <= v <= 59
48 | >u16 |  |  |  | 0 <= v <= 999
64 | 4 x >i16
128 | 3 x >i16 | gyro | v * 7 / 100 * deg | 32767
176 | 3 x >i16 | acc | v * 16 / 32768 * g | 32767
224 | 6 x >u16 | pressure | v
320 | 4 x >i16
384 | 3 x >i16 | 0.gyro | v * 7 / 100 * deg | 32767
432 | 3 x >i16 | 0.acc | v * 16 / 32768 * g | 32767
480 | 6 x >u16 | 0.pressure | v
576 | u256

orphe/info : 00 00 000000000000 03 03 <
  : : orphe/values = 38 0000 00 00 00 0000 4000000000000000 006400000000 000000000800 000000000000000000000000
  4000000000000000 000000000000 000000000000 000000000000000000000000
  0000000000000000000000000000000000000000000000000000000000000000
0 | u8
8 | u1 |  |  |  | v == 0 | wrong_site
9 | u7
16 | u48
64 | u8 | acc.2 | [1/8, 1/4, 1/2, 1][v] * g |  | 0 <= v <= 3
72 | u8 | gyro.0 | [875/1000, 175/100, 35/10, 7][v] * deg |  | 0 <= v <= 3

orphe/mode : 0d 04
0 | u8 |  |  |  | v == 13
8 | u8 |  |  |  | 1 <= v <= 4

dot/rates : 00000000 00000000 00000000 00000000 00000000 00000000 00000000 000000000000000000000000
0 | u32
32 | 3 x f32 | acc | v | 155.337336 | -1e8 <= v <= 1e8 | absurd if -inf < v < inf else malformed
128 | 3 x f32 | gyro | v * deg | 1980 | -5.7295779513e9 <= v <= 5.7295779513e9 | absurd if -inf < v < inf else malformed
224 | u96 |  |  |  | v == 0

dot-orientation/quaternion : 00000000 0000803f 00000000 00000000 00000000
0 | u32
32 | f32 |  |  |  | 0.98994950 <= abs(v) <= 1.00995049
64 | 3 x f32 |  |  |  | -0.14142135 <= v <= 0.14142135

dot/control dot-orientation/control : 01 01 15
0 | u8 |  |  |  | v == 1
8 | u8 |  |  |  | 0 <= v <= 1
16 | u8 |  |  |  | 1 <= v <= 7 or 16 <= v <= 26

dot/device-control dot-orientation/device-control :
  10 00 00 00000000 00 00000000000000000000000000000000 3c00 00 0000000000
0 | u4
4 | u1
5 | u3
8 | u184
192 | u16 |  |  |  | v in (1, 4, 10, 12, 15, 20, 30, 60, 120)
208 | u48

dot/battery dot-orientation/battery : 00 00
0 | u8 | level | v / 100 |  | 0 <= v <= 100
8 | u8 |  |  |  | 0 <= v <= 1

device/battery : 00
0 | u8 | level | v / 100 |  | 0 <= v <= 100

receiver/dropped : 01000000
0 | u32 | count | v |  | 1 <= v <= 4294967295

receiver/position : 0000803f 01 0000000000000000 0000000000000000
0 | f32 | sigma | v |  | 1e-45 <= v <= 10000.0
32 | u8 |  |  |  | =
40 | f64 | position.0 | v |  | -1e6 <= v <= 1e6
104 | f64 | position.1 | v |  | -1e6 <= v <= 1e6"""
REASONS = {one.name.lower(): one.value for one in Rejection}
NAMES = {"g": 9.80665, "deg": pi / 180.0, "uT": 1e-6, "inf": inf, **REASONS}
"""Names in the table: units in SI units, and reasons."""
CODES = {"f32": ("<f", "<I"), "f64": ("<d", "<Q")}
"""Notations of floats, and of their bits."""


@frozen
class Field:
    """One field of the table: its bits, what it becomes, and what it may be; cells are expressions of the number."""

    channel: str
    base: bytes
    before: str
    after: str
    options: str
    at: int
    kind: str
    becomes: str = ""
    value: str = ""
    full: str = ""
    allowed: str = ""
    reason: str = ""

    @property
    def bits(self) -> int:
        return int(self.kind.lstrip(">")[1:])

    def of(self, cell: str, number: float) -> Any:
        """Return the value of a cell of the table for a number."""
        return eval(cell, {**NAMES, "v": number})

    def with_value(self, raw: int) -> bytes:
        """Return the value of the channel in which this field has the bits `raw`."""
        order: Any = "big" if self.kind[0] == ">" else "little"
        shift = 8 * len(self.base) - self.at - self.bits if order == "big" else self.at
        whole = int.from_bytes(self.base, order) & ~((1 << self.bits) - 1 << shift)
        return seal(self.channel, (whole | raw << shift).to_bytes(len(self.base), order))

    def number(self, raw: int) -> float:
        """Return the number that the bits `raw` stand for."""
        if self.kind in CODES:
            notation, bits = CODES[self.kind]
            return float(struct.unpack(notation, struct.pack(bits, raw))[0])
        return raw - (1 << self.bits) if "i" in self.kind and raw >> self.bits - 1 else raw

    def boundaries(self) -> set[int]:
        """Return the bits of zero, smallest, sign bit, all set, and of the numbers that the table names, and beside."""
        most = (1 << self.bits) - 1
        raws = {0, 1, most >> 1, most - 1, most}
        named = [float(number) for number in re.findall(r"-?\d[\d.]*(?:e-?\d+)?", self.allowed + " " + self.full)]
        for end in {0.0, *named, *[-number for number in named]}:
            if self.kind in CODES:
                notation, bits = CODES[self.kind]
                end = struct.unpack(bits, struct.pack(notation, end))[0]
            raws |= {int(end) + step & most for step in (-1, 0, 1)}
        infinite = {"f32": 0x7F800000, "f64": 0x7FF0 << 48}.get(self.kind, 0)
        return raws | {infinite - 1 & most, infinite, infinite + 1, infinite | 1 << self.bits - 1}


def seal(channel: str, data: bytes) -> bytes:
    """Return the value with the CRC of its bytes, if its channel has one."""
    sealed = channel in ("insole/frame", "insole/info")
    return data[:-2] + crc_hqx(data[:-2], 0xFFFF).to_bytes(2, "little") if sealed else data


def fields() -> list[Field]:
    """Return the fields of the table; a field of three numbers is three fields."""
    found = []
    for block in TABLE.split("\n\n")[1:]:
        lines = [line for line in block.splitlines() if line.strip() and line[0] != "#"]
        head = " ".join(line.strip() for line in lines if "|" not in line)
        channels, base, *rest = [part.strip() for part in head.split(" :")]
        options = ("variable " if base[-1] == "<" else "") + " ".join(part for part in rest if part[:4] == "site")
        before, after = [*(part for part in rest if part[:4] != "site"), "", ""][:2]
        for channel in channels.split():
            of_value = partial(Field, channel, bytes.fromhex(base.rstrip("<")), before, after, options)
            for line in [line for line in lines if "|" in line]:
                at, kind, *others = [cell.strip() for cell in line.split("|")]
                count, kind = (int(kind[0]), kind[4:]) if " x " in kind else (1, kind)
                for k in range(count):
                    cells = list(others)
                    if count > 1 and cells and cells[0] and cells[0][-1] not in "?!":
                        cells[0] += f".{k}"
                    defaults = ("", "", "inf", "True", "malformed")
                    cells += [""] * (5 - len(cells))
                    filled = [cell or default for cell, default in zip(cells, defaults, strict=True)]
                    found.append(of_value(int(at) + k * int(kind.lstrip(">")[1:]), kind, *filled))
    return found


FIELDS = fields()


def received(field: Field, data: bytes) -> list[Any]:
    """Return what a receiver gives for the value and those before and after it, until the stream is silent."""
    site = Site.RIGHT_FOOT if "site right" in field.options else Site.LEFT_FOOT
    decoder, output = Decoder(site), []
    for item in (field.before, None, field.after):
        channel, _, value = (item or "").partition(" = ")
        if item is None or channel:
            sent = data if item is None else seal(channel, bytes.fromhex(value.rstrip("< ")))
            output += decoder.feed(Packet(1.0, site, field.channel if item is None else channel, sent))
    return [*output, *decoder.advance(30.0), *decoder.finish()]


def reason_of(field: Field, data: bytes) -> str:
    """Return why the value is rejected; "" for one that is accepted."""
    try:
        rejected = [event for event in received(field, data) if isinstance(event, PacketRejected)]
    except WireError as error:
        return error.reason.value
    return rejected[0].reason.value if rejected else ""


def found_in(output: list[Any], path: str) -> tuple[Any, Any]:
    """Return the item that has this quantity, and the quantity."""
    first, *steps = path.split(".")
    items = output if first != "0" else [one for one in output if isinstance(one, Sample)][:1]
    name = steps.pop(0) if first == "0" else first
    item = next((one for one in reversed(items) if getattr(one, name, None) is not None), None)
    value = getattr(item, name, None)
    for step in steps if value is not None else ():
        value = value[int(step)] if step.isdigit() else getattr(value, step)
    return item, value


@pytest.mark.parametrize("channel", sorted({field.channel for field in FIELDS}))
def test_every_field_at_its_boundaries_is_its_value_in_SI_units_or_rejected_for_its_reason(channel: str) -> None:
    for field in [one for one in FIELDS if one.channel == channel and one.allowed != "="]:
        for raw in sorted(field.boundaries()):
            number, data = field.number(raw), field.with_value(raw)
            where = f"{channel}, bit {field.at}, {field.kind}: {number!r}"
            if not field.of(field.allowed, number):
                assert reason_of(field, data) == field.of(field.reason, number), where
                continue
            assert reason_of(field, data) == "", where
            wire = FORMATS.get(channel.replace("/", "-"))
            if wire is not None:
                assert wire.build(wire.parse(data)) == data, where
            output, becomes = received(field, data), field.becomes
            if becomes[-1:] in ("?", "!"):
                assert (found_in(output, becomes[:-1])[1] is not None) is (bool(raw) is (becomes[-1] == "?")), where
            elif becomes.startswith("down:"):
                assert found_in(output, "down")[1] == ((becomes[5:],) if raw else ()), where
            elif becomes:
                item, value = found_in(output, becomes)
                assert (value or 0.0) == pytest.approx(field.of(field.value, number), rel=1e-12, abs=1e-300), where
                for sample in [one for one in output if isinstance(one, Sample) and becomes != "saturated"]:
                    is_full = abs(number) >= float(field.full)
                    assert sample.saturated is (sample is item and is_full), where


@pytest.mark.parametrize("channel", sorted({field.channel for field in FIELDS}))
def test_a_value_that_is_a_byte_too_short_or_too_long_is_rejected(channel: str) -> None:
    for field in {one.base: one for one in FIELDS if one.channel == channel}.values():
        data = seal(channel, field.base)
        for cut in range(len(data)):
            assert reason_of(field, data[:cut]) == "truncated" or "variable" in field.options, cut
        assert reason_of(field, data + b"\0") == "oversized" or "variable" in field.options


SIZES = """
# channel | a valid value; {} is as long as it has to be | its least and its largest size | why not shorter, not longer
orphe/info | 00 00 000000000000 03 03 {} | 10 32 | truncated malformed
device/firmware | {} | 1 512 | truncated oversized
receiver/connected | c4 {} | 1 249 | truncated oversized
receiver/disconnected | {} | 0 0 | . oversized
receiver/tick | {} | 0 0 | . oversized
receiver/restarted | {} | 1 512 | truncated oversized
receiver/trouble | {} | 1 512 | truncated oversized
receiver/position | 0000803f 00 {} | 5 5 | truncated oversized
receiver/position | 0000803f 01 0000000000000000 0000000000000000 {} | 21 21 | truncated oversized
receiver/position | 0000803f 02 0000000000000000 0000000000000000 {} | 22 85 | truncated oversized
receiver/position | 0000803f 03 {} | 6 69 | truncated oversized
insole/frame | 00 {} | 2 512 | truncated oversized
"""


@pytest.mark.parametrize("row", [line for line in SIZES.splitlines() if "{}" in line and line[0] != "#"])
def test_a_value_of_any_size_is_used_from_the_least_to_the_largest_and_rejected_beyond(row: str) -> None:
    """A piece of a frame is a value of insole/frame too; what it is a piece of does not come."""
    channel, value, sizes, reasons = [cell.strip() for cell in row.split(" | ")]
    start, (least, largest), (short, long) = bytes.fromhex(value[:-2]), map(int, sizes.split()), reasons.split()
    for size in {least - 1, least, least + 1, (least + largest) // 2, largest - 1, largest, largest + 1}:
        data = (start + b"1" * 513)[: max(size, 0)]
        reason = short if size < least else long if size > largest else ""
        assert size < 0 or reason_of(Field(channel, data, "", "", "", 0, "u8"), data) == reason, size


CELLS, NAMED = {0: "", 1: "", 128: "", 129: "malformed"}, {0: "", 1: "", 255: ""}
"""Why not so many cells, and not so many bytes of a name."""


@pytest.mark.parametrize("cells", CELLS)
def test_an_insole_has_128_cells_at_most_in_its_frames_and_in_what_it_says_of_itself(cells: int) -> None:
    sensors, packed = bytes(12), bytes((3 * cells + 1) // 2)
    frame = bytes.fromhex("f510 02 01 0000 00000000 4801 01") + bytes([cells]) + packed + sensors + bytes(2)
    assert reason_of(Field("insole/frame", frame, "", "", "", 0, "u8"), seal("insole/frame", frame)) == CELLS[cells]
    for name in NAMED:
        runs = bytes([cells, 1, 0]) if cells else b""
        counts = bytes([cells, len(runs) // 3, name])
        info = bytes.fromhex("f511 00 01 07000000 00800000 4801 0000003c 0000003b 0000403e f00a") + counts
        info += bytes(3 * cells) + runs + b"1" * name + bytes(2)
        expected = CELLS[cells] if len(info) <= 512 else "oversized"
        assert reason_of(Field("insole/info", info, "", "", "", 0, "u8"), seal("insole/info", info)) == expected, name


def test_the_table_has_every_bit_of_every_value_of_every_channel() -> None:
    for base in {(one.channel, one.base) for one in FIELDS}:
        spans = sorted((one.at, one.at + one.bits) for one in FIELDS if (one.channel, one.base) == base)
        assert [start for start, _ in spans] == [0, *(end for _, end in spans[:-1])], base
        assert spans[-1][1] == 8 * len(base[1]), base
    channels = {channel.name for profile in PROFILES for channel in profile.channels} - {"device/firmware"}
    assert channels <= {field.channel for field in FIELDS}
