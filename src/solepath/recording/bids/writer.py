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
from importlib.resources import files as files_of
from pathlib import Path
from typing import Any

from ...events import Event, LayoutKnown
from ...saving.files import FileReplacements, write_whole
from ...saving.provenance import installed_version
from ...types import Site
from ..errors import RecordingError
from ..packets import read_start_time
from ..posed import PosedSample
from .columns import CHANNEL_COLUMNS, MotionColumns, read_json, read_table, to_json, to_tsv
from .gait_rows import EVENT_COLUMNS, event_row
from .names import BIDS_VERSION, TSV_MISSING, Entities

_TEXTS = files_of(__name__.rpartition(".")[0])
"""Folder with the files that every dataset has."""
GENERATOR: dict[str, Any] = {"Name": "solepath", "Version": installed_version()}
DESCRIPTION, README, PARTICIPANTS = "dataset_description.json", "README", "participants.tsv"
_README_TEXT = """\
{name}

Recordings of sensors on the feet, written by solepath. Each sensor is a tracking system of its own. Its channels are
what the sensor measured and, at each sample, position, velocity and attitude as solepath computed them; channels.tsv
describes each. events.tsv has gait events, strides and activities, which solepath found.
"""


class MotionWriter:
    """Collects a recording for the dataset in folder `root`, and writes it at the end.

    `header`: header of the recording of packets, for its start time. `made_by`: how tracks and events were computed, as
    `provenance` says it (saving/provenance.py); it is in each motion.json, as "GeneratedBy". RecordingError for a
    folder that has other files but no dataset, for a dataset whose description is damaged, and when the dataset has
    this recording already, unless `replace` is True."""

    def __init__(
        self,
        root: Path | str,
        entities: Entities,
        header: Mapping[str, Any] = {},
        *,
        replace: bool = False,
        made_by: Mapping[str, Any] = {},
    ) -> None:
        self.root, self.entities, self._header = Path(root), entities, header
        self._generated_by = [GENERATOR | {"Settings": dict(made_by)}] if made_by else [GENERATOR]
        self._sensors: dict[Site, MotionColumns] = {}
        self._events: list[tuple[float, dict[str, str]]] = []
        self._pressure_units: dict[Site, str] = {}
        if self.root.exists() and not self.root.is_dir():
            raise RecordingError(self.root, "is a file, not the folder of a dataset")
        if self.root.is_dir() and any(self.root.iterdir()) and not (self.root / DESCRIPTION).is_file():
            raise RecordingError(self.root, f"has other files and no {DESCRIPTION}: it is no BIDS dataset")
        if (self.root / DESCRIPTION).is_file():
            read_json(self.root / DESCRIPTION)  # a dataset with a damaged description is not added to
        folder = self.root / self.entities.folder
        listed = sorted(folder.iterdir()) if folder.is_dir() else []
        self._earlier = [path for path in listed if self.entities.owns(path.name)]
        if self._earlier and not replace:
            raise RecordingError(self._earlier[0], "the dataset has this recording already")

    def add(self, samples: Iterable[PosedSample], events: Iterable[Event]) -> None:
        """Add samples in order of time, and the events that came with them."""
        for event in events:
            if isinstance(event, LayoutKnown):
                self._pressure_units[event.site] = TSV_MISSING if event.layout.scale is None else "N"
            elif (row := event_row(event)) is not None:
                self._events.append(row)
        for posed in samples:
            site = posed.sample.site
            self._sensors.setdefault(site, MotionColumns(site)).add(posed)

    def write(self) -> list[Path]:
        """Write all files and return those of the recording; RecordingError without any sample, OSError."""
        if not self._sensors:
            raise RecordingError(self.root, "the recording has no samples, so that there is nothing to write")
        start = min([columns.t[0] for columns in self._sensors.values()])
        folder = self.root / self.entities.folder
        folder.mkdir(parents=True, exist_ok=True)
        events = [{"onset": f"{t - start:.6f}"} | row for t, row in sorted(self._events, key=lambda one: one[0])]
        described = {name: _TEXTS.joinpath(name).read_text("utf-8") for name in ("events.json", "channels.json")}
        name = self.entities.file
        texts = {name("events.json"): described["events.json"], name("events.tsv"): to_tsv(EVENT_COLUMNS, events)}
        files = FileReplacements()
        try:
            for site, columns in self._sensors.items():
                columns.pressure_units, system = self._pressure_units.get(site, "N"), columns.tracksys
                texts[name("motion.tsv", system)] = ""
                texts[name("channels.tsv", system)] = to_tsv(CHANNEL_COLUMNS, columns.channels())
                metadata = columns.metadata(self.entities.task, start) | {"GeneratedBy": self._generated_by}
                texts[name("motion.json", system)] = to_json(metadata)
                texts[name("channels.json", system)] = described["channels.json"]
            written = {folder / one: files.temporary_path(folder / one) for one in texts}
            for path, text in zip(written.values(), texts.values(), strict=True):
                path.write_text(text, encoding="utf-8", newline="\n")
            for columns in self._sensors.values():
                columns.write_motion(written[folder / name("motion.tsv", columns.tracksys)], start)
            files.move_to_targets()
        finally:
            files.discard()
        for path in self._earlier:
            if path not in written:
                path.unlink()  # of a sensor that this recording does not have
        self._write_scans(start)
        self._write_dataset()
        return sorted(written)

    def _write_scans(self, start: float) -> None:
        """Write the start of each file into scans.tsv; all count their latencies from the start of the recording."""
        known, moment = read_start_time(self._header), TSV_MISSING
        if known is not None:
            first_moment, t = known
            exact = first_moment + timedelta(seconds=0.0 if t is None else start - t)
            moment = exact.isoformat(timespec="microseconds").replace("+00:00", "Z")
        path = self.root / self.entities.scans
        rows = [row for row in read_table(path) if not self.entities.owns(Path(row.get("filename", "")).name)]
        for columns in self._sensors.values():
            name = self.entities.file("motion.tsv", columns.tracksys)
            rows.append({"filename": f"motion/{name}", "acq_time": moment})
        write_whole(path, to_tsv({"filename": "", "acq_time": ""} | rows[0], rows))

    def _write_dataset(self) -> None:
        name = self.root.resolve().name
        description = {"Name": name, "BIDSVersion": BIDS_VERSION, "GeneratedBy": [GENERATOR]}
        description["DatasetType"] = "derivative"
        if not (self.root / DESCRIPTION).exists():
            write_whole(self.root / DESCRIPTION, to_json(description))
        if not any(self.root.glob("README*")):
            write_whole(self.root / README, _README_TEXT.format(name=name))
        path, person = self.root / PARTICIPANTS, f"sub-{self.entities.subject}"
        rows = read_table(path)
        if person not in [row.get("participant_id") for row in rows]:
            rows.append({"participant_id": person})
            write_whole(path, to_tsv(rows[0], rows))
