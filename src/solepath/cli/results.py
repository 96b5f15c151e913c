"""What `solepath track` makes of a recording's events: a summary, files, a picture of the plan, a report."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from types import TracebackType

from attrs import define, field

from ..events import Event
from ..floorplan.plan import FloorPlan
from ..output import PLAN, TrackFiles
from ..report import Report
from ..tally import Tally
from ..types import Packet, Sample
from ..view.placed import Places
from ..view.plan import PlanPicture
from ..view.summary import summary
from .failure import check_writable


@define
class Results:
    """`out`: the directory of the files; nothing in it is touched before the recording has given something, so that a
    file that cannot be used replaces nothing of an earlier run. `report`: the file of the report. None: not wanted.
    OSError from all of it when something cannot be written."""

    title: str
    out: Path | None = None
    report: Path | None = None
    plan: FloorPlan | None = None
    recipe: str = ""
    when: str = ""
    """The recording began, to be read."""
    tally: Tally = field(factory=Tally, init=False)
    places: Places = field(factory=Places, init=False)
    _picture: PlanPicture | None = field(init=False)
    _report: Report | None = field(init=False)
    _files: TrackFiles | None = field(default=None, init=False)
    _open: ExitStack = field(factory=ExitStack, init=False)

    def __attrs_post_init__(self) -> None:
        self._picture = None if self.plan is None else PlanPicture(self.plan)
        self._report = None
        if self.report is not None:
            check_writable(self.report)
            self._report = Report(self.title, self.plan, self.recipe, self.when, _version())

    def begin(self) -> None:
        """There is something to write, or there will be nothing."""
        if self._files is None and self.out is not None:
            self._files = self._open.enter_context(TrackFiles(self.out, places=self.plan is not None))
            if self.plan is not None:
                check_writable(self.out / PLAN)  # it is written last

    def told(self, item: Packet | Sample | None, events: list[Event]) -> None:
        """What the session said of an item; of none, at the end."""
        if isinstance(item, Sample):
            self.tally.fed_sample(item)
        elif item is not None:
            self.tally.fed_packet(item)
        for event in events:
            self.tally.add(event)
            if self._files is not None:
                self._files.write(event)
            if self._report is not None:
                self._report.add(event)
            if self._picture is not None:
                self.places.add(event)
                self._picture.add(event)

    def print(self, seconds: float) -> None:
        """The summary, the picture and the report. `seconds` on the wall that it took."""
        print(summary(self.tally, title=self.title, seconds=seconds))
        if self._picture is not None:
            print("\n".join(self.places.lines()))
            if self.out is not None:
                self._picture.write(self.out / PLAN, self.title)
        if self.out is not None:
            print(f"written to {self.out}")
        if self._report is not None and self.report is not None:
            self._report.write(self.report)
            print(f"report in {self.report}")

    def __enter__(self) -> Results:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """The files are closed."""
        self._open.__exit__(kind, error, trace)


def _version() -> str:
    from importlib.metadata import version

    return version("solepath")
