"""Writes the results of `solepath track`: summary, files, picture of the floor plan, report."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from attrs import define, field

from ...events import Event
from ...floorplan.plan import FloorPlan
from ...recording import printable
from ...saving.files import FileReplacements
from ...show.output import PLAN_FILE, TrackFiles, os_errors_naming
from ...show.tables.plan import PlanPicture
from ...show.tables.summary import place_lines, summary
from ...types import Packet, Sample
from ...walk.walk import Walk
from .failure import Failure, note
from .files import OutputFile, replacements
from .own_devices import UnusedPackets

if TYPE_CHECKING:
    from ...show.outcomes.clinic import OutcomeRequest
    from ...show.report import Report


@define
class Results:
    """The results of one recording, which are collected and written at the end.

    `out` is the directory of the files, `report` the file of the report; what is None is not written. Every method
    raises OSError when something cannot be written. Files of an earlier run stay as they were until `write_and_print`
    replaces them by complete ones."""

    title: str
    out: Path | None = None
    report: Path | None = None
    contents: Report | None = None
    """The report, as its options describe it; None without `report`."""
    plan: FloorPlan | None = None
    outputs: Sequence[OutputFile] = ()
    """All files of `out`, and `report`, as they were before the run."""
    outcomes: OutcomeRequest | None = None
    """Clinical outcomes; None without any."""
    unused: UnusedPackets = field(factory=UnusedPackets)
    walk: Walk = field(factory=Walk, init=False)
    _files: TrackFiles | None = field(default=None, init=False)
    _open: ExitStack = field(factory=ExitStack, init=False)
    _file_replacements: FileReplacements = field(init=False)
    _report_replacement: FileReplacements = field(init=False)
    _picture_path: Path | None = field(default=None, init=False)
    _report_path: Path | None = field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        self._file_replacements, self._report_replacement = replacements(self.outputs), replacements(self.outputs)
        if self.out is not None or self.outcomes is not None:
            self.walk.limit = None
        if self.contents is not None:
            self.contents.walk, self.contents.outcomes = self.walk, self.outcomes

    def open_files(self) -> None:
        """Open the files, if they are not open."""
        if self._files is None and self.out is not None:
            self._files = TrackFiles(
                self.out, places=self.plan is not None, path_to_write=self._file_replacements.temporary_path
            )
            self._open.callback(self._files.close)
            if self.plan is not None:
                self._picture_path = self._file_replacements.temporary_path(self.out / PLAN_FILE)
        if self._report_path is None and self.report is not None:
            self._report_path = self._report_replacement.temporary_path(self.report)

    def add(self, item: Packet | Sample | None, events: list[Event]) -> None:
        """Add a packet or sample and its events, or None and the last events at the end of the recording."""
        self.walk.take(item, events)
        self.unused.take(item, events)
        if self._files is not None:
            for event in events:
                self._files.write(event)

    def write_files(self) -> list[str]:
        """Complete the files of `out`; return the lines of the clinical outcomes.

        Raises Failure, and writes nothing, if no packet of the recording could be used."""
        self._open.close()
        if self.unused.is_all:
            raise Failure(f"{self.title}: {'; '.join(self.unused.sentences())}")
        if self.plan is not None and self._picture_path is not None and self.out is not None:
            with os_errors_naming(self.out):
                PlanPicture(self.plan, self.walk.placed).write(self._picture_path, self.title)
        results = None if self.outcomes is None else self.outcomes.results(self.walk)
        if results is not None and self.out is not None:
            from ...show.outcomes.files import BOUTS_FILE, OUTCOMES_FILE, write_bouts, write_outcomes

            with os_errors_naming(self.out):
                write_bouts(results, self._file_replacements.temporary_path(self.out / BOUTS_FILE))
                write_outcomes(results, self._file_replacements.temporary_path(self.out / OUTCOMES_FILE))
        self._file_replacements.move_to_targets()
        return [] if results is None else results.lines()

    def write_and_print(self, seconds: float) -> None:
        """Complete files and report, and print the summary; `seconds` is the wall time that computing took."""
        clinical_lines = self.write_files()
        print(summary(self.walk, title=self.title, seconds=seconds))
        if self.plan is not None:
            print("\n".join(place_lines(self.walk.places)))
        if clinical_lines:
            print("\n".join(clinical_lines))
        if self.out is not None:
            print(f"written to {printable(str(self.out))}")
        if self.contents is not None and self._report_path is not None and self.report is not None:
            with os_errors_naming(self.report):
                self.contents.write(self._report_path)
            self._report_replacement.move_to_targets()
            print(f"report in {printable(str(self.report))}")
        for sentence in self.unused.sentences():
            note(sentence)

    def __enter__(self) -> Results:
        return self

    def __exit__(self, *error: object) -> None:
        """Close the files and remove temporary ones that were not moved to their targets."""
        try:
            self._open.close()
        finally:
            self._file_replacements.discard()
            self._report_replacement.discard()
