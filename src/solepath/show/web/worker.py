"""Runs in a worker of the browser, in Pyodide: packets and files in, messages of protocol/page.md out.

worker.js calls it. Nothing here reads a clock of the day, draws, or asks the network. Numbers without a source were
chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from time import monotonic
from types import GeneratorType
from typing import Any

from attrs import define, field

from ...calibration import Calibration, CalibrationError
from ...calibration.file import read_calibration
from ...floorplan.findings import find_warnings
from ...floorplan.importers.reading import read_floorplan
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import FloorPlan, FloorPlanError
from ...link.catalogue import DEVICES
from ...recipes import DEFAULT, NAMES, Recipe, by_name
from ...recording import RecordingError, read_packets
from ...saving.codec import SnapshotError
from ...session import Session
from ...walk.walk import Walk
from ..outcome_options import parse_person, parse_test
from ..outcomes.clinic import OutcomeRequest, WalkTest
from ..page.live_commands import position_of
from ..page.messages import CommandError, encode, parse_command
from ..page.player.player import Player
from ..page.scene.scales import newtons_of
from ..page.scene.scene import Follower, Scene
from ..report import Report, ReportDetails
from ..report.bands import Band, BandError, mean_bands, read_bands
from .live_walk import LiveWalk
from .opening import NOTE_COUNT, OpenedRecording, kind_of, open_recording


class WalkRunning(Exception):
    """Error for a recording that is opened while a walk is measured."""


class UnknownRecipe(Exception):
    """Error for a recipe that is chosen by a name that no recipe has."""


class WrongOption(Exception):
    """Error for an option of a report that a person wrote wrongly."""


PROBLEMS = (
    RecordingError,
    CalibrationError,
    FloorPlanError,
    SnapshotError,
    WalkRunning,
    UnknownRecipe,
    WrongOption,
    BandError,
    OSError,
)
"""Errors whose texts are sentences for a person."""
ITEMS_PER_STEP = 64
"""Number of packets that a long task handles before the worker may do something else."""
Task = Generator[float, None, Any]
"""A task that yields the share that is done, 0 to 1, and returns its result."""


DETAILS = ("title", "subject", "date", "device")
"""Options that only the head of a report shows."""
SIZE = ("height", "weight")
"""Options of a person's size, which go together."""


def ordered(options: Mapping[str, Any]) -> OutcomeRequest:
    """Return the outcomes that the options of a report order; raise WrongOption, with a sentence."""
    values = {name: str(value) for name, value in options.items()}
    test, marks = values.get("test", ""), values.get("marks", "").replace(" ", "")
    size = [values.get(name, "") for name in SIZE]
    person = [values.get("age", ""), values.get("sex", ""), *(size if any(size) else [])]
    try:
        name, times = parse_test(f"{test}={marks}" if marks else test) if test else (None, ())
        return OutcomeRequest(
            outcomes=bool(options.get("outcomes")),
            test=None if name is None else WalkTest(name),
            marks=times,
            person=parse_person(",".join(person)) if any(person) else None,
        )
    except ValueError as error:
        raise WrongOption(f"{error}: it stands under what a report has") from None


@define
class Worker:
    """The library behind the page: a walk that is measured now, or a recording that is played.

    `version` is that of solepath, for the report."""

    version: str = ""
    walk: LiveWalk = field(init=False)
    """Walk that is measured now, or was last; one without any packet that is over if there was none."""
    player: Player | None = field(default=None, init=False)
    recording: OpenedRecording | None = field(default=None, init=False)
    calibration: Calibration | None = field(default=None, init=False)
    plan: IndexedPlan | None = field(default=None, init=False)
    bands: Mapping[str, Band] = field(factory=dict, init=False)
    recipe: Recipe = field(default=DEFAULT, init=False)
    _follower: Follower = field(factory=Follower, init=False)
    _task: Task | None = field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        self.walk = self._new_walk("", is_over=True)

    # --- messages for the page

    @property
    def scene(self) -> Scene:
        """Scene that the page shows."""
        return self.walk.scene if self.player is None else self.player.scene

    def message(self) -> str | None:
        """Return the next message for the page: the whole scene at first, then what has changed; None for no change."""
        message = self._follower.message(self.scene, self.player is not None or not self.walk.finished)
        return None if message is None else encode(message)

    def heartbeat(self) -> str:
        """Return a message with nothing but the time."""
        return encode(self.scene.frame_message())

    # --- a walk that is measured now

    def choices(self) -> str:
        """Return the names of all recipes and of all kinds of devices, as JSON."""
        return encode({"recipes": NAMES, "profiles": tuple(DEVICES)})

    def choose_recipe(self, name: str) -> None:
        """Use this recipe for the next walk and for what is played; raise UnknownRecipe for another name."""
        try:
            self.recipe = by_name(name)
        except ValueError as error:
            raise UnknownRecipe(str(error)) from None
        self._use_choices()

    def start_walk(self, title: str) -> None:
        """Start a walk with what was opened and chosen (calibration, plan, recipe); any other walk is forgotten."""
        self.player = self.recording = None
        self.walk = self._new_walk(title)

    def receive(self, text: str, now: float | None = None) -> str:
        """Return the answers to messages of the page on sensors (protocol/host.md), which are received at `now`, s.

        Without a walk there are none."""
        return self.walk.receive(text, now)

    def take_lines(self) -> bytes:
        """Return the lines of the recording of the walk since the last call."""
        return self.walk.take_lines()

    def save(self) -> str | None:
        """Return the walk as JSON; None when there is nothing to save."""
        return self.walk.save()

    def resume_walk(self, title: str, saved: str | None, tail: str, now: float) -> Task:
        """Continue a walk from its save, then from the packets of the recording `tail`, up to `now`, s from its start.

        Without a save `tail` is the whole recording. Returns the time of the walk from then on, s. If it raises, there
        is no walk."""
        self.player = self.recording = None
        self.walk = self._new_walk("", is_over=True)
        walk = self._new_walk(title) if saved is None else LiveWalk.restore(saved, self.plan)
        for packet in read_packets(tail, report=lambda _: None) if tail else ():
            walk.replay(packet)
            if walk.count % ITEMS_PER_STEP == 0:
                yield 0.0
        now = walk.resume(now)
        self.walk = walk
        return now

    def finish_walk(self) -> None:
        """End the walk; the page goes on to show the end of it."""
        self.walk.finish()
        self._follower.restart()  # the page learns that it has nothing to control any more

    # --- recordings and other files

    def open(self, name: str) -> Task:
        """Open a file of the working folder: play a recording, or use a plan, calibration or bands from now on.

        Returns {"kind", "notes"}; raises one of PROBLEMS."""
        path = Path(name)
        kind = kind_of(path)
        notes: Sequence[str] = ()
        if kind == "plan":
            plan = read_floorplan(path)
            self.plan, notes = (
                IndexedPlan(plan),
                [f"{path.name}: {words}" for words in find_warnings(plan, reach=False)],
            )
        elif kind == "calibration":
            self.calibration = read_calibration(path)
        elif kind == "bands":
            self.bands = read_bands(path)
            return {"kind": kind, "notes": []}
        else:
            self._check_idle()
            self.recording = yield from open_recording(path)
            notes = self.recording.notes
        self._use_choices()
        return {"kind": kind, "notes": list(notes[:NOTE_COUNT])}

    def open_demo(self, name: str, title: str) -> Task:
        """Play the recording that comes with the site."""
        self._check_idle()
        opened = yield from open_recording(Path(name))
        self.recording = OpenedRecording(opened.items, title, "", ())
        self._play(self.recording, "demo")

    def _check_idle(self) -> None:
        if not self.walk.finished:
            raise WalkRunning("a walk is measured now: end it first")

    def _use_choices(self) -> None:
        """Show the plan before a walk, and play a recording again with what was opened or chosen."""
        if self.recording is not None:
            self._play(self.recording, "recording")
        elif self.walk.finished and self.walk.session.now is None:
            self.walk = self._new_walk("", is_over=True)

    def _session(self) -> Session:
        """Return a new session with what was opened and chosen."""
        known, plan = self.calibration, self.plan
        return Session(self.recipe, poses=True, pressures=True, losses=True, calibration=known, floorplan=plan)

    def _scene(self, title: str, source: str) -> Scene:
        """Return a new scene for `_session`."""
        return Scene(title, self.recipe.name, source, plan=self._drawn_plan, newtons=newtons_of(self.calibration))

    @property
    def _drawn_plan(self) -> FloorPlan | None:
        return None if self.plan is None else self.plan.plan

    def _new_walk(self, title: str, is_over: bool = False) -> LiveWalk:
        return LiveWalk(self._session(), self._scene(title, "live"), self.plan, finished=is_over)

    def _play(self, recording: OpenedRecording, source: str) -> None:
        self.walk = self._new_walk("", is_over=True)
        self.player = Player(recording.items, self._session(), self._scene(recording.title, source), self.plan)

    def command(self, text: str) -> None:
        """Execute a command of the page (protocol/page.md), if it is one for what is played or measured by now."""
        command = parse_command(text)
        with suppress(CommandError):
            if self.player is not None:
                self.player.command(command)
            else:
                self.walk.report_position(position_of(command, None if self.walk.plan is None else self.walk.plan.plan))

    def play(self, seconds: float, budget: float) -> None:
        """Let wall time pass for the recording, s, and compute what is due, for `budget` s at most."""
        if self.player is not None:
            self.player.advance(seconds)
            end = monotonic() + budget
            self.player.feed_due(lambda: monotonic() >= end)

    def report(self, name: str, title: str, options: Mapping[str, Any] = {}) -> Task:
        """Return the report of a recording of the working folder, or of what is played if `name` is empty, as HTML.

        `options` has what a person filled in, as texts: the head (title, subject, date, device), the person (age, sex,
        height, weight), test and marks; `outcomes` is a flag. `compare` names an earlier recording of the folder, which
        is run without floor plan, and `marks_before` are the marks of the test in it."""
        request, earlier = ordered(options), str(options.get("compare", ""))
        before = None
        if earlier:
            other = yield from open_recording(Path(earlier))
            request_before = ordered({**options, "marks": options.get("marks_before", "")})
            session = Session(self.recipe, poses=True, pressures=True, losses=True, calibration=self.calibration)
            before = yield from self._run_report(other, session, request_before, source=other.title)
        recording = self.recording
        if name:
            recording = yield from open_recording(Path(name))
        if recording is None:
            raise RecordingError("report", "there is no walk to report on")
        head = ReportDetails(**{name: options.get(name, "") for name in DETAILS})
        given = {"source": title, "plan": self._drawn_plan, "version": self.version, "details": head, "before": before}
        report = yield from self._run_report(recording, self._session(), request, **given)
        return report.text()

    def _run_report(self, recording: OpenedRecording, session: Session, request: OutcomeRequest, **given: Any) -> Task:
        """Return the report of a recording with these outcomes; `given` are further arguments of Report."""
        report = Report(
            recipe=self.recipe.name,
            when=recording.when,
            walk=Walk(limit=None) if request.outcomes or request.test else Walk(),
            bands={**mean_bands(request.person), **self.bands},
            calibrated=self.calibration is not None,
            outcomes=request if request.outcomes or request.test else None,
            **given,
        )
        items = recording.items
        for number in range(len(items)):
            item = items[number]
            report.take(item, session.feed(item))
            if number % ITEMS_PER_STEP == 0:
                yield number / len(items)
        report.take(None, session.finish())
        return report

    # --- calls that may take long

    def start(self, name: str, arguments: Sequence[Any]) -> None:
        """Start the method `name`; `step` runs it."""
        self._task = self._run(name, arguments)

    def step(self, budget: float) -> str:
        """Run the started method for about `budget` s; return {"share"}, or at the end {"value"} or {"problem"}."""
        end = monotonic() + budget
        answer: dict[str, Any] = {"value": None}
        try:
            while self._task is not None:
                share = next(self._task)
                if monotonic() >= end:
                    return encode({"share": share})
        except StopIteration as ended:
            answer = {"value": ended.value}
        except PROBLEMS as error:
            answer = {"problem": str(error)}
        self._task = None
        return encode(answer)

    def _run(self, name: str, arguments: Sequence[Any]) -> Task:
        if name not in CALLS:
            raise ValueError(f"the worker has no call {name}")
        value = getattr(self, name)(*arguments)
        return (yield from value) if isinstance(value, GeneratorType) else value


CALLS = (
    "start_walk", "save", "resume_walk", "finish_walk", "open", "open_demo", "choose_recipe", "report",
)  # fmt: skip
"""Methods that `start` may run."""
