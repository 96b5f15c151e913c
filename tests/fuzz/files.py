"""Mutated files: recordings of all formats, calibrations, floor plans; each is read, or rejected by its own error."""

from __future__ import annotations

import io
import json
import zipfile
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

import numpy as np
import walks
from changes import BORDERS, changed_bytes, changed_value
from floorplans import archive
from floors import office
from snooped import insoles_log

from solepath import Calibration, CalibrationError, Foot, Session
from solepath.calibration import InsoleCalibration, ShoeGeometry
from solepath.calibration.file import read_calibration, write_calibration
from solepath.emulate.sensors.insoles import layout
from solepath.floorplan.importers.geojson import format_floorplan
from solepath.floorplan.importers.reading import read_floorplan
from solepath.floorplan.plan import FloorPlanError
from solepath.recording import PacketWriter, RecordingError, open_source

MOST_ITEMS = 300
"""Number of packets or samples that are read from a file."""
FILES = 20
"""Number of files of a round."""
TOKENS = (
    b"nan",
    b"-1",
    b"1e999",
    b"",
    b'"',
    b"\0",
    b"\xff\xfe",
    b"null",
    b"[]",
    b"{}",
    b"1" * 400,
    b"left",
    b"\n",
    b",",
)
"""Words that replace a word of a text."""


@cache
def originals() -> dict[str, bytes]:
    """Return sound files, by a name with their suffix."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        with PacketWriter(folder / "walk.jsonl") as writer:
            for packet in walks.insoles().packets[:400]:
                writer.write(packet)
        log = insoles_log(walks.insoles().packets[:200]).save(folder / "phone.log")
        calibration = Calibration(insoles={Foot.LEFT: InsoleCalibration(layout(24, Foot.LEFT))}, shoe=ShoeGeometry())
        write_calibration(folder / "wearer.calibration", calibration)
        files = {file.name: file.read_bytes() for file in (folder / "walk.jsonl", log, folder / "wearer.calibration")}
    samples = [sample for sample in walks.samples(cells=0) if sample.site is walks.LEFT][:300]
    names = ("t", "acc_x", "acc_y", "acc_z", "gyro_x", "gyro_y", "gyro_z")
    lines = [",".join(map(repr, (sample.t, *(sample.acc or ()), *(sample.gyro or ())))) for sample in samples]
    files["walk.csv"] = "\n".join([",".join(names), *lines]).encode()
    packed = io.BytesIO()
    columns = {name: np.array([getattr(sample, name) for sample in samples]) for name in ("t", "acc", "gyro")}
    np.savez_compressed(packed, **columns)
    files["walk.npz"] = packed.getvalue()
    plan = json.loads(format_floorplan(office()))
    files["plan.geojson"] = json.dumps(plan).encode()
    files["plan.zip"] = archive({"manifest.json": {"version": "1.0.0", "language": "en"}, "unit.geojson": plan})
    return files


def run(seed: int) -> tuple[int, int]:
    """Read some mutated files; return their number, and how many of them were read to the end."""
    random, read = Random(seed), 0
    with TemporaryDirectory() as folder:
        for number in range(FILES):
            name = random.choice(list(originals()))
            path = Path(folder, f"{number}-{name}")
            path.write_bytes(mutated(name, originals()[name], random))
            try:
                _read(path)
                read += 1
            except (RecordingError, CalibrationError, FloorPlanError) as error:
                if len(str(error).splitlines()) != 1:
                    raise AssertionError(f"a reason of more than one line: {error!r}") from None
            path.unlink()
    return FILES, read


def _read(path: Path) -> None:
    if path.suffix == ".calibration":
        Session(calibration=read_calibration(path)).pack()
    elif path.name.partition("-")[2].startswith("plan"):
        Session(floorplan=read_floorplan(path))
    else:
        session, items = Session(), []
        for item in open_source(path, report=_ignore):
            items.append(item)
            if len(items) >= MOST_ITEMS:
                break
        session.feed(items)
        session.pack()


def _ignore(sentence: str) -> None:
    if len(sentence.splitlines()) != 1:
        raise AssertionError(f"a report of more than one line: {sentence!r}")


def mutated(name: str, data: bytes, random: Random) -> bytes:
    """Return the file with changed bytes, lines, words, JSON values, or members of an archive."""
    kind = random.randrange(4)
    if kind == 0:
        return changed_bytes(data, random, [other for other in originals().values()])
    if name.endswith((".npz", ".zip")) and kind < 3:
        return _changed_archive(data, random)
    if name.endswith((".geojson", ".calibration")) and kind < 3:
        document = json.loads(data)
        for _ in range(random.choice((1, 2, 5))):
            document = changed_value(document, random)
        return json.dumps(document, default=str).encode("utf-8", "replace")
    lines = data.split(b"\n")
    for _ in range(random.choice((1, 1, 3, 10))):
        at = random.randrange(len(lines))
        lines[at : at + 1] = _changed_line(lines[at], random)
        if not lines:
            break
    return b"\n".join(lines)


def _changed_line(line: bytes, random: Random) -> list[bytes]:
    kind = random.randrange(6)
    if kind == 0:
        return []
    if kind == 1:
        return [line] * random.choice((2, 3, 50))
    if kind == 2:
        return [line, bytes([random.choice(BORDERS)]) * random.choice((1, 100, 5000))]
    words = line.split(b",")
    words[random.randrange(len(words))] = random.choice(TOKENS)
    return [b",".join(words)]


def _changed_archive(data: bytes, random: Random) -> bytes:
    """Return an archive with a changed member whose checksum is right."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as source, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as target:
        names = source.namelist()
        chosen = random.choice(names)
        for name in names:
            content = source.read(name)
            if name == chosen:
                kind = random.randrange(4)
                if kind == 0:
                    continue
                content = bytes(10_000_000) if kind == 1 else changed_bytes(content, random)
            target.writestr(name, content)
    return out.getvalue()
