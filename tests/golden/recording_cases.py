"""Cases of recordings: packets, tables, logs of Bluetooth and datasets as they are read, whole and with one fault each.

A case yields what becomes of each file: what was read of it, or the sentence of its error, and what was reported."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from changes import LEFT, RIGHT, draws
from corpus import Case, given, plain
from snooped import MONITOR, Log, insoles_log

from solepath import Foot, Packet, Session, Site
from solepath.recording import PacketWriter, RecordingError, TableMapping, open_source, read_mapping, read_start_time
from solepath.recording.bids.names import Entities  # what `solepath convert` calls, and the dataset it writes
from solepath.recording.bids.writer import MotionWriter
from solepath.recording.btsnoop import open_btsnoop
from solepath.recording.posed import PosedSession
from solepath.recording.samples import load_samples
from solepath.recording.samples.shared_event import shared_offset  # what `track --shared-event` calls

EXPORTS = Path(__file__).resolve().parents[1] / "recording" / "tables" / "files"
CELLS = ("", "x", "1e999", "-0", "1,5", "nan", "9" * 40, "1e4", " 7 ", '"', "0.5e", "-12.5")
"""Texts that replace a cell of a table, each in turn."""
VALUES = (None, "", -1, 1.5, [], {}, "x", True, 1e12, "00:zz", "f" * 7, 10**400, "left_foot")
"""Values that replace one of a line of JSON, each in turn."""
MOMENTS = ("2026-11-21T09:30:00Z", "2026-11-21T09:30:00+01:00", "2026-11-21T09:30:00", "2026-02-30T00:00:00Z", "", 5)


def fate(folder: Path, read: Callable[[Callable[[str], None]], Any]) -> dict[str, Any]:
    """Return what is read, or the error, and what is reported, without the name of the folder."""
    reports: list[str] = []
    try:
        found = plain(read(reports.append))
    except (RecordingError, ValueError) as error:
        found = f"{type(error).__name__}: {error}"
    text = json.dumps([found, reports], default=lambda data: data.hex()).replace(str(folder), "")
    return {"": "Fate", "read": text}


def each_fate(texts: Iterable[bytes], name: str, **wishes: Any) -> Iterator[dict[str, Any]]:
    """Yield what becomes of each of these contents of a file of this name."""
    with TemporaryDirectory() as work:
        for text in texts:
            path = Path(work) / name
            path.write_bytes(text)

            def read(report: Callable[[str], None], path: Path = path) -> Any:
                source = open_source(path, report=report, **wishes)
                kept, ended = [], ""
                try:
                    kept.extend(source)
                except RecordingError as error:
                    ended = str(error)
                bad = source.bad_rows
                return [kept, ended, source.header, source.total, source.done, bad and [bad.count, bad.good]]

            yield fate(Path(work), read)


# --- packets ----------------------------------------------------------------------------------------------------------


def recorded(items: Iterable[Packet], header: dict[str, Any]) -> bytes:
    """Return a recording as it is written."""
    with TemporaryDirectory() as work:
        path = Path(work) / "walk.jsonl"
        with PacketWriter(path, header) as writer:
            for item in items:
                writer.write(item)
        return path.read_bytes()


def packets() -> Iterator[Any]:
    """Yield recordings of packets, whole, and with one value, line or byte changed."""
    some = [*given("insole")[:5], *given("thingy")[:5], Packet(1e-7, LEFT, "x/\ud800", b"", "C0:FF\n")]
    whole = recorded(some, {"began": MOMENTS[0], "began_t": 0.5, "note": "é"})
    yield whole.decode()
    lines = whole.splitlines()
    texts = [whole, whole[:-5], whole + b"\n\n", b"", b"\n", whole.replace(b"\n", b"\r\n"), b"\xef\xbb\xbf" + whole]
    for number in (0, 1, 3, len(lines) - 1):
        fields = json.loads(lines[number])
        for key in fields:
            for value in VALUES:
                texts.append(
                    b"\n".join([*lines[:number], json.dumps({**fields, key: value}).encode(), *lines[number + 1 :]])
                )
            rest = {name: value for name, value in fields.items() if name != key}
            texts.append(b"\n".join([*lines[:number], json.dumps(rest).encode(), *lines[number + 1 :]]))
        for damaged in (
            lines[number][:9],
            b"",
            b"[]",
            b"\xff\xfe",
            b'{"t": NaN}',
            b"{" * 2000,
            b" " * 40,
            lines[number] * 2,
        ):
            texts.append(b"\n".join([*lines[:number], damaged, *lines[number + 1 :]]))
    for length in (65_534, 65_535, 65_536, 65_537, 1_048_575, 1_048_576, 1_048_577):
        texts.append(b"\n".join([lines[0], b" " * (length - len(lines[1])) + lines[1], lines[2]]))
    yield from each_fate(texts, "walk.jsonl")
    yield from each_fate([whole], "walk.jsonl", foot=Foot.LEFT)
    for moment in MOMENTS:
        for t in (0.5, None, "0.5", float("inf")):
            yield fate(
                Path("/"), lambda report, moment=moment, t=t: str(read_start_time({"began": moment, "began_t": t}))
            )


# --- tables -----------------------------------------------------------------------------------------------------------

AXES = [f"{what}_{axis}" for what in ("acc", "gyro") for axis in "xyz"]
NAMES = ["t", *AXES, "pressure_0", "pressure_1"]
Rows = list[list[str]]


@cache
def walked() -> tuple[Rows, Rows]:
    """Return the rows of each foot: 6 s of the stroll at 50 Hz, time, specific force, angular rate and two cells."""
    feet: dict[Site, Rows] = {LEFT: [], RIGHT: []}
    for sample in given("stroll"):
        if 1.0 < sample.t < 7.0:
            numbers = (sample.t, *sample.acc, *sample.gyro, *sample.pressure[:2])
            feet[sample.site].append([f"{number:.5f}" for number in numbers])
    return feet[LEFT][::2], feet[RIGHT][::2]


def written(rows: Rows, names: list[str] = NAMES, separator: str = ",", decimal: str = ".", head: str = "") -> bytes:
    lines = [separator.join(names), *(separator.join(cell.replace(".", decimal) for cell in row) for row in rows)]
    return (head + "\n".join(lines) + "\n").encode()


def scaled(rows: Rows, columns: Iterable[int], by: float, plus: float = 0.0) -> Rows:
    """Return the rows with these columns in another unit."""
    return [[f"{float(cell) * by + plus:.6g}" if k in columns else cell for k, cell in enumerate(row)] for row in rows]


def faulty(table: Rows) -> Iterator[Rows]:
    """Yield a table of names and rows with one fault each."""
    texts = 0
    for number in (0, 1, 7, len(table) - 1):
        for column in range(len(table[number])):
            texts += 1
            row = [*table[number]]
            row[column] = CELLS[texts % len(CELLS)]
            yield [*table[:number], row, *table[number + 1 :]]
        yield table[:number] + table[number + 1 :]
        yield [*table[: number + 1], *table[number:]]
        yield [*table[:number], table[number][:-1], *table[number + 1 :]]
        yield [*table[:number], [*table[number], "8"], *table[number + 1 :]]


def tables() -> Iterator[Any]:
    """Yield tables in every dress and unit, and with one fault each."""
    left, right = walked()
    short = [NAMES, *left[:12]]
    yield from each_fate([written(one[1:], one[0]) for one in faulty(short)], "left.csv")
    dressed = [
        written(left, separator=separator, decimal=decimal, head=head)
        for separator, decimal in ((",", "."), (";", ","), ("\t", ","), ("|", "."), (" ", "."), (",", ","))
        for head in ("", "# note\n", "Rate;100\n\n", "sep=;\n")
    ]
    dressed += [
        written(left).replace(b"\n", b"\r"),
        written(left)[:-20],
        written(left).decode().encode("utf-16"),
        b"",
        b"\n",
    ]
    acc, gyro = range(1, 4), range(4, 7)
    for by in (1.0 / 9.80665, 1000.0 / 9.80665, 57.29578, 0.01, 0.0, 3.0):
        dressed += [written(scaled(left, acc, by)), written(scaled(left, gyro, by))]
    for by, plus in ((1000.0, 0.0), (1e6, 0.0), (1.0, 1.79e9), (1000.0, 1.79e12), (-1.0, 0.0), (0.0, 3.0), (1e-3, 0.0)):
        dressed.append(written(scaled(left, [0], by, plus)))
    counted = [[str(k), *row[1:]] for k, row in enumerate(left)]
    dressed += [written(counted), written([*counted[:50], *counted[51:]])]
    for one, other in ((1, 2), (1, 4), (4, 6), (3, 6)):
        names = [*NAMES]
        names[one], names[other] = names[other], names[one]
        dressed.append(written(left, names))
    yield from each_fate(dressed, "walk.csv")
    yield from each_fate(dressed[:3], "walk.csv", foot=Foot.LEFT)
    both = [[*one, *other[1:]] for one, other in zip(left, right, strict=False)]
    sides = ["t", *(f"{name}_left" for name in NAMES[1:]), *(f"right_{name}" for name in NAMES[1:])]
    named = ["t", *(f"{name}_left" for name in NAMES[1:]), *(f"{name}_right" for name in NAMES[1:])]
    blank = [row[:9] + [""] * 8 if k % 3 else row for k, row in enumerate(both)]
    yield from each_fate([written(both, sides), written(both, named), written(blank, named)], "both.csv")
    yield from each_fate([written(both, named)], "both.csv", foot=Foot.RIGHT)


def archives() -> Iterator[Any]:
    """Yield NumPy archives: of one foot and of both, by a mapping, of other shapes, and with one byte changed."""
    numbers = np.array(walked()[0], dtype=float)
    t, acc, gyro, cells = numbers[:, 0], numbers[:, 1:4], numbers[:, 4:7], numbers[:, 7:]
    one = {"t": t, "acc": acc, "gyro": gyro, "pressure": cells}
    holed = acc.copy()
    holed[7, 1], holed[9] = np.nan, np.inf
    kinds: tuple[tuple[dict[str, Any], str], ...] = (
        (one, ""), ({**one, "other": np.array(["x"])}, ""), ({**one, "acc": holed}, ""), ({**one, "acc": acc[:-1]}, ""),
        ({**one, "acc": acc[:, :2]}, ""), ({**one, "acc": acc.T}, ""), ({**one, "acc": acc.astype(np.float32)}, ""),
        ({**one, "t": t[:, None]}, ""), ({**one, "t": t[::-1]}, ""), ({**one, "t": np.array([str(x) for x in t])}, ""),
        ({f"{key}_left": value for key, value in one.items()}, ""), ({**one, "acc_left": acc}, ""),
        ({"t": t, "acc_left": acc, "acc_right": acc}, ""), ({"t": t}, ""), ({"acc": acc}, ""), ({}, ""),
        ({"t": t, "pressure": cells[:, :0]}, ""),
        ({"t": t[:0], "acc": acc[:0]}, ""), ({"t": t, "pressure": cells[:, 0]}, ""), ({"t": t, "pressure": cells}, ""),
        ({"zeit": 1e3 * t, "a": acc / 9.80665}, "t=zeit,acc=a"), ({"zeit": t, "a": acc}, "t=zeit,acc=b"),
        ({"zeit": t, "ax": acc[:, 0], "ay": acc[:, 1], "az": acc[:, 2]}, "t=zeit,acc=ax,-ay,az"),
    )  # fmt: skip
    whole = b""
    for arrays, columns in kinds:
        file = BytesIO()
        np.savez(file, **arrays)
        whole = whole or file.getvalue()
        for units in ("", "ms,g") if columns else ("",):
            yield from each_fate([file.getvalue()], "walk.npz", mapping=TableMapping.parse(columns, units))
    spoilt = [whole[:k] + bytes([whole[k] ^ 0x15]) + whole[k + 1 :] for k in (0, 3, 4, 8, 14, 26, 30, 40, 90, 130, 140)]
    yield from each_fate([*spoilt, whole[:500], whole[:-30], whole[:4]], "walk.npz")


def mapped() -> Iterator[Any]:
    """Yield tables with names of somebody else, by mappings right and wrong."""
    left, _ = walked()
    theirs = ["Zeit [ms]", *(f"A {axis}" for axis in "xyz"), *(f"G {axis} (deg/s)" for axis in "xyz"), "P1", "P2"]
    text = written(scaled(scaled(left, [0], 1000.0), range(4, 7), 57.29578), theirs)
    ways: tuple[dict[str, Any], ...] = (
        {"columns": "t=Zeit*,acc=A *,gyro=G *,pressure=P*"},
        {"columns": 't="Zeit [ms]",acc="A x","A y","A z"'},
        {"columns": "t=#1,acc=#2,#3,#4,gyro=#5,#6,#7"},
        {"columns": "t=#1,acc=#2,-#3,#4,gyro=G x*,-G y*,G z*", "units": "ms,m/s^2"},
        {"columns": "acc=A *,gyro=G *", "rate": 50.0},
        {"columns": "t=Zeit*,acc=A *,gyro=G *", "units": "s"},
        {"columns": "t=Zeit*,acc=A *,gyro=G *", "units": "rad/s"},
        {"columns": "t=Zeit*,acc=A *", "units": "g"},
        {"columns": "t=Zeit*,acc=A x,A y"},
        {"columns": "t=Zeit*,acc=B *"},
        {"columns": "t=Zeit*,gyro=G *"},
        {"columns": "t=#99,acc=A *"},
        {"columns": "t=Zeit*,acc_left=A *,gyro_left=G *"},
        {"columns": "t=Zeit*,acc=A *", "wrap": 2000.0},
        {"columns": "t=Zeit*,acc=A *", "header": 1},
        {"columns": "t=Zeit*,acc=A *", "header": 2},
        {"columns": "t=#1,acc=#2,#3,#4", "header": 0},
        {"columns": "t=Zeit*,acc=A *", "separator": ";"},
        {"columns": "t=Zeit*,acc=A *", "decimal": ","},
        {"columns": "t=Zeit*,acc=A *", "feet": {"left": "*alk*"}},
        {"format": "movella-dot"},
        {"columns": "x=1"}, {"units": "furlong"}, {"rate": 0.0}, {"units": "g,mg"}, {"columns": 't="A'},
        {},
    )  # fmt: skip
    for way in ways:
        try:
            mapping = TableMapping.parse(**way)
        except ValueError as error:
            yield str(error)
            continue
        texts = [text, text.replace(b"(deg/s)", b"(g)"), text.replace(b"[ms]", b"[Hz]")]
        yield from each_fate(texts, "walk.csv", mapping=mapping)
    with TemporaryDirectory() as work:
        path = Path(work) / "columns.toml"
        for size in (1_000_000, 1_000_001):
            path.write_text('format = "movella-dot"'.ljust(size))
            yield fate(Path(work), lambda report: read_mapping(path))


def exports() -> Iterator[Any]:
    """Yield the files of known devices, each whole and with one line changed or left out."""
    for path in sorted(EXPORTS.rglob("*.*")):
        whole = path.read_bytes()
        lines = whole.splitlines(keepends=True)
        texts = [whole, *(b"".join(lines[:k] + lines[k + 1 :]) for k in range(len(lines)))]
        texts += [b"".join([*lines[:k], line.replace(b"1", b"x", 1), *lines[k + 1 :]]) for k, line in enumerate(lines)]
        yield from each_fate(texts, path.name)


def several() -> Iterator[Any]:
    """Yield what becomes of several files: of both feet, of several sensors, on clocks of their own."""
    left, right = walked()
    accelerometer = [row[:4] for row in left]
    gyroscope = [[row[0], *row[4:7]] for row in left]
    late = scaled(gyroscope, [0], 1.0, 0.004)
    holed = [row for k, row in enumerate(gyroscope) if not 50 < k < 53 and not 100 < k < 110]
    contents = {
        "left.csv": written(left), "right.csv": written(right), "one.csv": written(left), "two.csv": written(right),
        "acc.csv": written(accelerometer, NAMES[:4]), "gyro.csv": written(gyroscope, [NAMES[0], *NAMES[4:7]]),
        "late.csv": written(late, [NAMES[0], *NAMES[4:7]]), "holed.csv": written(holed, [NAMES[0], *NAMES[4:7]]),
        "slow.csv": written(gyroscope[::3], [NAMES[0], *NAMES[4:7]]),
        "apart.csv": written(scaled(gyroscope, [0], 1.0, 900.0), [NAMES[0], *NAMES[4:7]]),
        "epoch.csv": written(scaled(left, [0], 1.0, 1.79e9)),
    }  # fmt: skip
    choices: tuple[tuple[tuple[str, ...], Any], ...] = (
        (("left.csv", "right.csv"), None), (("right.csv", "left.csv"), None), (("one.csv", "two.csv"), None),
        (("one.csv", "two.csv"), (Foot.LEFT, Foot.RIGHT)), (("one.csv", "two.csv"), (Foot.LEFT,)),
        (("left.csv", "left.csv"), None), (("left.csv", "two.csv"), None), (("acc.csv", "gyro.csv"), None),
        (("gyro.csv", "acc.csv"), Foot.LEFT), (("acc.csv", "late.csv"), None), (("acc.csv", "holed.csv"), None),
        (("acc.csv", "slow.csv"), None), (("acc.csv", "apart.csv"), None), (("gyro.csv",), None),
        (("acc.csv", "left.csv"), None), (("left.csv", "right.csv"), Foot.RIGHT), (("epoch.csv",), None),
        (("absent.csv",), None), (("left.csv", "gyro.csv"), (Foot.LEFT, Foot.LEFT)),
    )  # fmt: skip
    with TemporaryDirectory() as work:
        for name, text in contents.items():
            (Path(work) / name).write_bytes(text)
        for names, foot in choices:
            paths = [Path(work) / name for name in names]
            yield fate(Path(work), lambda report, paths=paths, foot=foot: [*open_source(paths, foot, report=report)])


def shaken(offset: float, noise: float, lone: float = 0.0) -> tuple[Rows, Rows]:
    """Return rows of both feet that feel a lift start and stop, the right one `offset` late, and one foot alone."""
    drawn, feet = draws(7), []
    for late, own in ((0.0, 0.0), (offset, lone)):
        rows = []
        for k in range(1200):
            t = 0.01 * k - late
            lift = 1.2 * max(0.0, 1.0 - abs(t - 3.0)) - 1.2 * max(0.0, 1.0 - abs(t - 8.0))
            step = own if 5.0 < t < 5.6 else 0.0
            rows.append([f"{0.01 * k:.2f}", f"{noise * (next(drawn) - 0.5):.4f}", "0", f"{9.81 + lift + step:.4f}"])
        feet.append(rows)
    return feet[0], feet[1]


def shared() -> Iterator[Any]:
    """Yield the time between the clocks of the feet from an event that both feel; numpy's last digits are left out."""
    for offset, noise, lone in ((0.137, 0.2, 0.0), (-1.4, 0.05, 0.0), (0.3, 0.5, 2.0), (0.0, 3.0, 6.0)):
        for start, end in ((1.5, 9.5), (2.0, 4.5), (2.0, 2.4), (2.0, 2.39), (-1.0, 5.0), (6.0, 14.0)):
            with TemporaryDirectory() as work:
                paths = [Path(work) / "left.csv", Path(work) / "right.csv"]
                for path, rows in zip(paths, shaken(offset, noise, lone), strict=True):
                    path.write_bytes(written(rows, NAMES[:4]))

                def read(report: Callable[[str], None], paths: list[Path] = paths, span: Any = (start, end)) -> Any:
                    return [round(value, 5) for value in shared_offset(load_samples(paths, report=report), *span)]

                yield fate(Path(work), read)


# --- logs of Bluetooth ------------------------------------------------------------------------------------------------


def logs() -> Iterator[Any]:
    """Yield a phone's log of two insoles in every form, and with one record or byte changed."""
    frames = [item for item in given("insole") if item.t < 0.12]
    wholes = [insoles_log(frames, log) for log in (None, Log(MONITOR), Log(piece=27))]
    contents = [log.bytes() for log in wholes]
    log, whole = wholes[0], contents[0]
    head = whole[:16]
    for k in range(0, len(log.records), 2):
        contents.append(head + b"".join(log.records[:k] + log.records[k + 1 :]))
        contents.append(head + b"".join([*log.records[:k], log.records[k][:-3], *log.records[k + 1 :]]))
    contents += [whole[:k] for k in (0, 7, 12, 16, 20, 40, 45, len(whole) - 1)]
    contents += [whole[:k] + bytes([whole[k] ^ 0x15]) + whole[k + 1 :] for k in range(0, min(len(whole), 4000), 11)]
    with TemporaryDirectory() as work:
        path = Path(work) / "phone.log"
        for content in contents:
            path.write_bytes(content)
            yield fate(Path(work), lambda report: [*open_btsnoop(path, report=report)])


# --- datasets ---------------------------------------------------------------------------------------------------------


def datasets() -> Iterator[Any]:
    """Yield the files of a dataset of two visits, and what is read of them whole and with one line changed."""
    with TemporaryDirectory() as work:
        root = Path(work) / "study"
        for visit, header in (("1", {"began": MOMENTS[0], "began_t": 0.5}), ("2", {})):
            writer = MotionWriter(root, Entities("01", "walk", visit), header)
            posed = PosedSession(Session(poses=True))
            for item in given("insole"):
                if item.t < 5.0:
                    events = posed.session.feed(item)
                    writer.add(posed.take(), events)
            writer.write()
        files = {path: path.read_text() for path in sorted(root.rglob("*")) if path.is_file()}
        motion = next(path for path in files if "leftfoot_motion.tsv" in path.name)
        for path, text in files.items():
            text = re.sub('(Version": )"[^"]*"', r"\1", text)
            yield {"": "File", "name": str(path.relative_to(root)), "text": text}
        yield fate(root, lambda report: [*open_source(motion, report=report)])
        small = "".join(files[motion].splitlines(keepends=True)[:6])
        motion.write_text(small)
        for path, text in files.items():
            if path.parent != motion.parent or "events" in path.name:
                continue
            lines = (small if path == motion else text).splitlines(keepends=True)
            for k in range(0, len(lines), 1 + len(lines) // 5):
                line = lines[k]
                for changed in ("", line.replace("acc", "acx").replace("m/s^2", "furlong"), line.replace("1", "x", 1)):
                    path.write_text("".join([*lines[:k], changed, *lines[k + 1 :]]))
                    yield fate(root, lambda report: [*open_source(motion, report=report)])
            path.write_text(small if path == motion else text)


RECORDINGS: tuple[Case, ...] = tuple(
    Case(name, make)
    for name, make in {
        "recordings of packets": packets,
        "tables": tables,
        "archives": archives,
        "tables by a mapping": mapped,
        "tables of known devices": exports,
        "several files": several,
        "an event that both feet feel": shared,
        "logs of Bluetooth": logs,
        "datasets": datasets,
    }.items()
)
