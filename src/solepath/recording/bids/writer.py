"""Writes a recording, and what a session computes from it, into a Motion-BIDS dataset.

    writer = MotionWriter("study", Entities("01", "walk"), read_header("walk.jsonl"))
    posed = PosedSession(Session(poses=True))
    for item in source:
        events = posed.session.feed(item)
        writer.add(posed.take(), events)
    writer.write()

Every sensor is a tracking system of its own (tracksys-leftfoot), since sensors have different clocks and numbers of
samples. Its channels are what was measured, in SI units, and at each sample what was computed: position, velocity and
attitude. LATENCY has the true time of each sample, from the start that all sensors and events share: the earliest
sample. Gait events, strides and activities are in one events.tsv. The files of the dataset itself (description, README,
participants) are made if they are missing, and otherwise only completed by a new participant."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from datetime import timedelta
from importlib.metadata import version
from importlib.resources import files as files_of
from pathlib import Path
from typing import Any

from ...events import Event, LayoutKnown
from ...saving.files import FileReplacements, write_whole
from ...types import Site
from ..errors import RecordingError
from ..packets import read_start_time
from ..posed import PosedSample
from .columns import MotionColumns, read_json, read_table, to_json, write_table
from .gait_rows import EVENT_COLUMNS, event_row
from .names import BIDS_VERSION, TSV_MISSING, Entities

_TEXTS = files_of(__name__.rpartition(".")[0])
"""Folder with the files that every dataset has."""
DESCRIPTION, README, PARTICIPANTS = "dataset_description.json", "README", "participants.tsv"
_README_TEXT = """\
{name}

Recordings of sensors on the feet, written by solepath. Each sensor is a tracking system of its own. Its channels are
what the sensor measured and, at each sample, position, velocity and attitude as solepath computed them; channels.tsv
describes each. events.tsv has gait events, strides and activities, which solepath found.
"""


class MotionWriter:
    """Collects a recording for the dataset in folder `root`, and writes it at the end.

    `header`: header of the recording of packets, for its start time. RecordingError for a folder that has other files
    but no dataset, for a dataset whose description is damaged, and when the dataset has this recording already, unless
    `replace` is True."""

    def __init__(
        self, root: Path | str, entities: Entities, header: Mapping[str, Any] = {}, *, replace: bool = False
    ) -> None:
        self.root, self.entities, self._header = Path(root), entities, header
        self._sensors: dict[Site, MotionColumns] = {}
        self._events: list[tuple[float, dict[str, str]]] = []
        self._pressure_units: dict[Site, str] = {}
        if self.root.exists() and not self.root.is_dir():
            raise RecordingError(self.root, "is a file, not the folder of a dataset")
        if self.root.is_dir() and any(self.root.iterdir()) and not (self.root / DESCRIPTION).is_file():
            raise RecordingError(self.root, f"has other files and no {DESCRIPTION}: it is no BIDS dataset")
        if (self.root / DESCRIPTION).is_file():
            read_json(self.root / DESCRIPTION)  # a dataset with a damaged description is not added to
        self._earlier = self._list_earlier()
        if self._earlier and not replace:
            raise RecordingError(self._earlier[0], "the dataset has this recording already")

    def _list_earlier(self) -> list[Path]:
        folder = self.root / self.entities.folder
        return [path for path in sorted(folder.iterdir()) if self.entities.owns(path.name)] if folder.is_dir() else []

    def add(self, samples: Iterable[PosedSample], events: Iterable[Event]) -> None:
        """Add samples in order of time, and the events that came with them."""
        for event in events:
            if isinstance(event, LayoutKnown):
                self._pressure_units[event.site] = TSV_MISSING if event.layout.scale is None else "N"
            elif (row := event_row(event)) is not None:
                self._events.append(row)
        for posed in samples:
            site = posed.sample.site
            columns = self._sensors.get(site)
            if columns is None:
                columns = self._sensors[site] = MotionColumns(site)
            columns.add(posed)

    def write(self) -> list[Path]:
        """Write all files and return those of the recording; RecordingError without any sample, OSError."""
        if not self._sensors:
            raise RecordingError(self.root, "the recording has no samples, so that there is nothing to write")
        start = min([columns.t[0] for columns in self._sensors.values()])
        folder = self.root / self.entities.folder
        folder.mkdir(parents=True, exist_ok=True)
        described = {name: _TEXTS.joinpath(name).read_text("utf-8") for name in ("events.json", "channels.json")}
        texts = {self.entities.file("events.json"): described["events.json"]}
        names = [self.entities.file("events.tsv")]
        files = FileReplacements()
        try:
            self._write_events(files.temporary_path(folder / names[0]), start)
            for site, columns in self._sensors.items():
                columns.pressure_units = self._pressure_units.get(site, "N")
                motion, channels = (self.entities.file(end, columns.tracksys) for end in ("motion.tsv", "channels.tsv"))
                columns.write_motion(files.temporary_path(folder / motion), start)
                columns.write_channels(files.temporary_path(folder / channels))
                metadata = columns.metadata(self.entities.task, start, version("solepath"))
                texts[self.entities.file("motion.json", columns.tracksys)] = to_json(metadata)
                texts[self.entities.file("channels.json", columns.tracksys)] = described["channels.json"]
                names += [motion, channels]
            files.move_to_targets()
        finally:
            files.discard()
        for name, text in texts.items():
            write_whole(folder / name, text)
        written = [folder / name for name in [*names, *texts]]
        for path in self._earlier:
            if path not in written:
                path.unlink()  # of a sensor that this recording does not have
        self._write_scans(start)
        self._write_dataset()
        return sorted(written)

    def _write_events(self, path: Path, start: float) -> None:
        rows = [{"onset": f"{t - start:.6f}"} | row for t, row in sorted(self._events, key=lambda one: one[0])]
        write_table(path, EVENT_COLUMNS, rows)

    def _write_scans(self, start: float) -> None:
        """Write the start of each file into scans.tsv; all count their latencies from the start of the recording."""
        known, moment = read_start_time(self._header), TSV_MISSING
        if known is not None:
            first_moment, t = known
            exact = first_moment + timedelta(seconds=0.0 if t is None else start - t)
            moment = exact.isoformat(timespec="microseconds").replace("+00:00", "Z")
        path = self.root / self.entities.scans
        rows = read_table(path) if path.is_file() else []
        rows = [row for row in rows if not self.entities.owns(Path(row.get("filename", "")).name)]
        for columns in self._sensors.values():
            name = self.entities.file("motion.tsv", columns.tracksys)
            rows.append({"filename": f"motion/{name}", "acq_time": moment})
        others = [column for column in (rows[0] if rows else {}) if column not in ("filename", "acq_time")]
        write_table(path, ("filename", "acq_time", *others), rows)

    def _write_dataset(self) -> None:
        name = self.root.resolve().name
        description = {
            "Name": name,
            "BIDSVersion": BIDS_VERSION,
            "DatasetType": "raw",
            "GeneratedBy": [{"Name": "solepath", "Version": version("solepath")}],
        }
        if not (self.root / DESCRIPTION).exists():
            write_whole(self.root / DESCRIPTION, to_json(description))
        if not any(self.root.glob("README*")):
            write_whole(self.root / README, _README_TEXT.format(name=name))
        path, person = self.root / PARTICIPANTS, f"sub-{self.entities.subject}"
        rows = read_table(path) if path.is_file() else []
        if person not in [row.get("participant_id") for row in rows]:
            columns = tuple(rows[0]) if rows else ("participant_id",)
            write_table(path, columns, [*rows, {"participant_id": person}])
