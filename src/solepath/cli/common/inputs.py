"""Reads the inputs of a command: the recording and its foot, the calibration, the floor plan and the start on it."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Sequence
from math import isfinite, nan, radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...calibration import Calibration
from ...link.decoder import Decoder
from ...link.kinds import DeviceKinds, make_kinds
from ...recording import RecordingError, Source, TableMapping, open_source, printable
from ...types import Foot, Sample, Site
from ..completion import complete_with
from .failure import Failure, note, parse_degrees, parse_offset, recipe_named

if TYPE_CHECKING:
    from ...floorplan.index import IndexedPlan
    from ...floorplan.plan import Start
    from ...link.driver import Driver
    from ...recipes import Recipe
    from ...recording.btsnoop import BtsnoopLog


def add_foot(command: argparse.ArgumentParser) -> None:
    """Add --foot to a command."""
    command.add_argument(
        "--foot",
        choices=["left", "right"],
        help="whose the samples of a recording of one foot are (default: right); of other recordings, the foot to use",
    )


def _recipe_names() -> Sequence[str]:
    from ...recipes import NAMES

    return NAMES


def add_recipe_name(command: argparse.ArgumentParser, what: str = "how to compute", **more: Any) -> None:
    """Add --recipe to a command; `what` says what the recipe is for."""
    action = command.add_argument(
        "--recipe", metavar="NAME", **{"default": "default", "help": f"{what} (default: default)"} | more
    )
    complete_with(action, _recipe_names)


def add_recipe(command: argparse.ArgumentParser, *, several: bool = False) -> None:
    """Add --recipe and --heading to a command; `several` lets --recipe be given again."""
    if several:
        add_recipe_name(
            command,
            action="append",
            default=None,
            help="how to compute (default: default); given again, one table with a column for each recipe",
        )
    else:
        add_recipe_name(command)
    command.add_argument(
        "--heading",
        metavar="DEGREES",
        type=parse_degrees,
        help="where the wearer looks at the start, to the left of x of the world that all sensors share (for most "
        "suits, north); for walking-modes with body sensors (default: the first steps say)",
    )


def recipe_of(options: argparse.Namespace) -> Recipe:
    """Return the recipe of --recipe and --heading; raise Failure when there is none, or when it takes no heading."""
    return _headed(recipe_named(options.recipe), options)


def recipes_of(options: argparse.Namespace) -> list[Recipe]:
    """Return the recipes of a command whose --recipe may be given again; raise Failure as `recipe_of` does."""
    return [_headed(recipe_named(name), options) for name in options.recipe or ["default"]]


def _headed(recipe: Recipe, options: argparse.Namespace) -> Recipe:
    if options.heading is None:
        return recipe
    try:
        return recipe.with_heading(options.heading)
    except (LookupError, ValueError) as error:
        raise Failure(f"--heading: {error}") from None


def foot_of(options: argparse.Namespace) -> Foot | None:
    """Return the foot of --foot; None without it."""
    return Foot(options.foot) if options.foot else None


def add_clocks(command: argparse.ArgumentParser) -> None:
    """Add --clock-offset and --shared-event to a command."""
    one = command.add_mutually_exclusive_group()
    one.add_argument(
        "--clock-offset",
        metavar="S",
        type=parse_offset,
        help="feet recorded with separate clocks: seconds to add to the times of the right foot",
    )
    one.add_argument(
        "--shared-event",
        metavar="START,END",
        help="the same, with the offset from a lift ride or a jump from both feet between these times, s; the recording"
        " must be of samples",
    )


def undo_clocks(source: Source, options: argparse.Namespace) -> None:
    """Correct the times of the right foot by --clock-offset or --shared-event.

    The offset of a shared event is printed. Failure and RecordingError are raised when it cannot be found."""
    source.clock_offset = options.clock_offset or 0.0
    if options.shared_event is None:
        return
    bounds = [_finite(text) for text in options.shared_event.split(",")]
    if len(bounds) != 2 or bounds[0] is None or bounds[1] is None or not bounds[0] < bounds[1]:
        raise Failure(f"--shared-event {printable(options.shared_event, 80)} is not START,END, as in 12.5,20")
    if source.samples is None:
        raise Failure(f"--shared-event: {printable(str(source.path))} holds packets, not samples")
    from ...recording.samples.shared_event import shared_offset

    source.clock_offset, sigma = shared_offset(source.samples, bounds[0], bounds[1])
    note(f"{1000.0 * source.clock_offset:+.0f} ms (+-{1000.0 * sigma:.0f}) are added to the times of the right foot")


def source_of(
    files: Path | Sequence[Path],
    foot: Foot | Sequence[Foot] | None = None,
    mapping: TableMapping | None = None,
    own: Iterable[Driver] = (),
) -> Source:
    """Open a recording and print its flaws on stderr; raise RecordingError when it cannot be used.

    Packets of devices of one's `own` become samples, for what computes with the built-in devices only."""
    from ...show.tables.progress import progress_bar

    names = [Path(file).name for file in ([files] if isinstance(files, Path) else files)]
    with progress_bar(f"reading {printable(names[0])}"):
        source = open_source(files, foot, mapping=mapping, report=note)
    source.own_kinds = make_kinds(own)
    return source


class Recording:
    """The items of a recording up to the first fault, which `failure` then holds, with a line of progress."""

    def __init__(self, source: Source | BtsnoopLog) -> None:
        self.source = source
        self.name = printable(source.name if isinstance(source, Source) else source.path.name)
        self.failure: RecordingError | None = None

    def __iter__(self) -> Iterator[Any]:
        from ...show.tables.progress import progress_bar

        with progress_bar(self.name, self.source.total) as show:
            try:
                for item in self.source:
                    yield item
                    show(self.source.done)
            except RecordingError as error:
                self.failure = error


def assumed_foot(source: Source) -> str | None:
    """Return the sentence on a recording of samples that does not say of which foot it is; None for any other."""
    tables = () if source.samples is None else source.samples.tables
    if source.foot is not None or len(tables) != 1 or tables[0].is_named:
        return None
    why = "the file does not say of which foot it is" if tables[0].is_assumed else "only the file's name says its foot"
    return f"{why}: taken as the {tables[0].foot} one; --foot says otherwise"


def check_pressure(recipe: Recipe, source: Source, own: Iterable[Driver] = ()) -> None:
    """Raise Failure when the recipe needs pressure cells and the recording has none.

    `own` are the drivers of devices of one's own."""
    if recipe.needs_pressure and not _has_pressure(source, make_kinds(own)):
        raise Failure(f"recipe {recipe.name} needs pressure cells; {printable(str(source.path))} has none")


def _has_pressure(source: Source, kinds: DeviceKinds) -> bool:
    """Return whether the recording has pressure; True if it cannot be read."""
    if source.samples is not None:
        return any("pressure" in table.columns for table in source.samples.tables)
    decoders: dict[Site, Decoder] = {}
    try:
        for packet in source.look_ahead():
            if source.foot is None or packet.site.foot in (None, source.foot):
                records = decoders.setdefault(packet.site, Decoder(packet.site)).feed(packet, kinds)
                if any(isinstance(record, Sample) and record.pressure for record in records):
                    return True
    except RecordingError:
        return True  # the run itself reports what is wrong with it
    return False


def add_calibration(command: argparse.ArgumentParser) -> None:
    """Add --calibration to a command."""
    command.add_argument(
        "--calibration",
        metavar="FILE",
        type=Path,
        help="what is known of wearer, shoes and insoles, as `solepath calibrate` writes it",
    )


def calibration_of(options: argparse.Namespace) -> Calibration | None:
    """Return the calibration of --calibration, None without it; raise CalibrationError when the file is malformed."""
    from ...calibration.file import read_calibration

    return None if options.calibration is None else read_calibration(options.calibration)


def add_floorplan(command: argparse.ArgumentParser) -> None:
    """Add --floorplan and --start to a command."""
    command.add_argument(
        "--floorplan",
        metavar="FILE",
        type=Path,
        help="find the wearer on this plan: GeoJSON, an IMDF archive or OpenStreetMap indoor tagging",
    )
    command.add_argument(
        "--start",
        metavar="LEVEL,X,Y[,HEADING]|heading=DEGREES",
        help="where on it the wearer sets out: m in the plan's frame, and the first heading in degrees, anticlockwise"
        " from the plan's x axis, or that heading alone; without a place it is known after stairs or a lift",
    )


def floorplan_of(options: argparse.Namespace) -> tuple[IndexedPlan | None, Start | None]:
    """Return the plan of --floorplan and the start of --start; print warnings about the plan on stderr.

    Failure is raised when the plan cannot be used, or when a walk cannot start at --start."""
    from ...floorplan.checks import find_warnings
    from ...floorplan.importers.reading import read_floorplan
    from ...floorplan.index import IndexedPlan
    from ...floorplan.plan import FloorPlanError
    from ...place.placing import start_error

    start = None if options.start is None else start_of(options.start)
    if options.floorplan is None:
        if start is not None:
            raise Failure("--start is a place on a floor plan: give --floorplan, too")
        return None, None
    try:
        plan = read_floorplan(options.floorplan)
        indexed = IndexedPlan(plan)
    except FloorPlanError as error:
        raise Failure(str(error)) from None
    for sentence in find_warnings(plan, has_start=start is not None and start.place is not None):
        note(f"{options.floorplan}: {sentence}")
    if start is not None and (problem := start_error(indexed, start)) is not None:
        raise Failure(f"{options.floorplan}: {problem}")
    return indexed, start


def start_of(text: str) -> Start:
    """Return the start of LEVEL,X,Y, LEVEL,X,Y,HEADING or heading=DEGREES: plan frame, m and degrees.

    Raises Failure for other text.

    The name of the level may contain commas."""
    from ...floorplan.plan import Start
    from ...types.checking import find_fault

    only = _finite(text.removeprefix("heading=")) if text.startswith("heading=") else None
    if only is not None and abs(only) <= 360.0:
        return Start(heading=radians(only))
    for count in (3, 2):
        level, *numbers = text.rsplit(",", count)
        values = [_finite(number) for number in numbers]
        if len(values) == count and level.strip() and None not in values:
            x, y, *heading = [value for value in values if value is not None]
            if heading and not abs(heading[0]) <= 360.0:
                raise Failure(f"--start {printable(text, 80)}: a heading can be -360 to 360 degrees")
            start = Start(level.strip(), (x, y), radians(heading[0]) if heading else None)
            problem = find_fault(start, Start)
            if problem is not None:
                raise Failure(f"--start {printable(text, 80)}: {problem}")
            return start
    raise Failure(
        f"--start {printable(text, 80)} is not LEVEL,X,Y, LEVEL,X,Y,HEADING or heading=DEGREES, as in 0,12.5,3,90"
    )


def _finite(text: str) -> float | None:
    try:
        value = nan if "_" in text else float(text)  # Python reads 1_0 as ten
    except ValueError:
        return None
    return value if isfinite(value) else None
