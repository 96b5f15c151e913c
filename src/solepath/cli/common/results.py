"""Feeds a session, and writes the results of `solepath track`: files, picture of the plan, report."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from attrs import define, field

from ...events import Event
from ...floorplan.plan import FloorPlan, Start
from ...link.kinds import DeviceKinds
from ...recording import printable
from ...saving.files import FileReplacements, os_errors_naming
from ...session import Session
from ...session.repeats import Repeats
from ...show.findings import findings
from ...show.output import PLAN_FILE, RUN_FILE, TrackFiles
from ...show.tables.plan import PlanPicture
from ...show.tables.summary import place_lines, summary
from ...types import Packet, Sample
from ...walk.walk import Walk
from .failure import Failure
from .files import OutputFile, replacements
from .run_file import made_by, write_run

if TYPE_CHECKING:
    from ...show.outcomes.clinic import OutcomeRequest
    from ...show.report import Report


@define
class Results:
    """The results of one recording with one recipe, which are collected and written at the end.

    `out` is the directory of the files, `report` the file of the report; what is None is not written. Every method
    raises OSError when something cannot be written. Files of an earlier run stay as they were until `write` replaces
    all of them by complete ones. Leaving the context removes what was not completed."""

    session: Session
    title: str
    out: Path | None = None
    report: Path | None = None
    contents: Report | None = None
    """The report, as its options describe it; None without one."""
    plan: FloorPlan | None = None
    outputs: Sequence[OutputFile] = ()
    """All files of `out`, and `report`, as they were before the run."""
    outcomes: OutcomeRequest | None = None
    """Clinical outcomes; None without any."""
    options: Namespace | None = None
    """Options of the command, for run.json; None without this file."""
    export: Path | None = None
    """The file of the way; None without one."""
    kinds: DeviceKinds | None = None
    """Devices of the session; None if none was added."""
    start: Start | None = None
    """Start on the plan that was given; None without one."""
    walk: Walk = field(factory=Walk, init=False)
    seconds: float = field(default=0.0, init=False)
    """Wall time that `feed` took, s."""
    _files: TrackFiles | None = field(default=None, init=False)
    _repeats: Repeats = field(factory=Repeats, init=False)
    _report_path: Path | None = field(default=None, init=False)
    _replacements: FileReplacements = field(init=False)
    _stack: ExitStack = field(factory=ExitStack, init=False)

    def __attrs_post_init__(self) -> None:
        self.walk.kinds = self.kinds
        self._replacements = replacements(self.outputs)
        self._stack.callback(self._replacements.discard)
        if self.out is not None or self.outcomes is not None or self.export is not None:
            self.walk.limit = None
        if self.contents is not None:
            self.contents.walk, self.contents.outcomes = self.walk, self.outcomes

    def feed(self, item: Packet | Sample | None) -> None:
        """Feed an item to the session, or None at the end of the recording."""
        start = perf_counter()
        self.add(item, self.session.finish() if item is None else self.session.feed(item))
        self.seconds += perf_counter() - start

    def add(self, item: Packet | Sample | None, events: list[Event]) -> None:
        """Add a packet or sample and its events, or None and the last events; the first one opens the files.

        The session tells each trouble of a link by itself; the files have them as a session tells them by default."""
        if self._files is None and self.out is not None:
            self._files = TrackFiles(self.out, self.plan is not None, self._replacements.temporary_path)
            self._stack.callback(self._files.close)
        if self._report_path is None and self.report is not None:
            self._report_path = self._replacements.temporary_path(self.report)
        self.walk.take(item, events)
        if self._files is not None:
            repeats = self._repeats
            reported = repeats.end(events, self.session.now) if item is None else repeats.gather(item, events)
            for event in reported:
                self._files.write(event)

    def write(self) -> list[str]:
        """Complete files and report; return the lines of the summary.

        Raises Failure, and writes nothing, if no packet of the recording could be used."""
        if self.walk.is_useless and (why := self.urgent_links()):
            raise Failure(f"{self.title}: {'; '.join(why)}")
        lines = [summary(self.walk, title=self.title, seconds=self.seconds)]
        if self.plan is not None:
            lines += place_lines(self.walk.places)
        found = None if self.outcomes is None else self.outcomes.results(self.walk)
        if found is not None:
            lines += found.lines()
        if self._files is not None and self.out is not None:
            self._files.close()
            with os_errors_naming(self.out):
                if self.plan is not None:
                    picture = PlanPicture(self.plan, self.walk.placed, start=self.start)
                    picture.write(self._replacements.temporary_path(self.out / PLAN_FILE), self.title)
                if self.options is not None:
                    run = self._replacements.temporary_path(self.out / RUN_FILE)
                    write_run(run, self.session.recipe, self.walk, self.options)
                if found is not None:
                    from ...show.outcomes.files import BOUTS_FILE, OUTCOMES_FILE, write_bouts, write_outcomes

                    write_bouts(found, self._replacements.temporary_path(self.out / BOUTS_FILE))
                    write_outcomes(found, self._replacements.temporary_path(self.out / OUTCOMES_FILE))
            lines.append(f"written to {printable(str(self.out))}")
        if self.export is not None and self.options is not None:
            lines.append(self._write_way(self.export, made_by(self.session.recipe, self.options)))
        if self.contents is not None and self.options is not None:
            self.contents.made_by = made_by(self.session.recipe, self.options)
        if self.contents is not None and self._report_path is not None and self.report is not None:
            with os_errors_naming(self.report):
                self.contents.write(self._report_path)
            lines.append(f"report in {printable(str(self.report))}")
        self._replacements.move_to_targets()
        return lines

    def _write_way(self, path: Path, made: dict[str, Any]) -> str:
        """Write the way and return the line about it."""
        from ...show.export import LOCAL_NOTE, has_degrees, write_way

        written = self._replacements.temporary_path(path)
        count = write_way(written, self.walk, self.plan, ending=path.suffix.lower(), made_by=made)
        why = "" if count else ", which is empty: no place was found" if self.plan else ", which is empty: no stride"
        note = "" if has_degrees(self.plan) else f"; {LOCAL_NOTE}"
        return f"way in {printable(str(path))}{why}{note}"

    def urgent_links(self) -> list[str]:
        """Return what the counts of the links show to be wrong until somebody acts."""
        return [one.text for one in findings(self.walk) if one.act and one.event is None and one.site is not None]

    def __enter__(self) -> Results:
        return self

    def __exit__(self, *error: object) -> None:
        self._stack.close()
