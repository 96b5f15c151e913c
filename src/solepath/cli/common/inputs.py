"""Reads the inputs of a command: the recording and its foot, the calibration, the floor plan and the start on it."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...calibration import Calibration
from ...link.kinds import DeviceKinds, make_kinds
from ...recording import RecordingError, Source, TableMapping, open_source, printable
from ...recording.errors import finite
from ...types import Foot, Sample
from ...types.registry import TABLE
from .closest import unknown
from .failure import Failure, note, parse_degrees, parse_offset, parse_span
from .parser import Option, one_of, option, together

if TYPE_CHECKING:
    from ...floorplan.index import IndexedPlan
    from ...floorplan.plan import FloorPlan, Start
    from ...link.driver import Driver
    from ...recipes import Recipe
    from ...recording.btsnoop import BtsnoopLog
    from ...recording.errors import Report
    from ...walk.walk import Remark


START_FORMS = "LEVEL,X,Y, a place, LEVEL and a place, each with ,HEADING or without it, or heading=DEGREES"
"""What --start can be."""
MAX_WARNINGS = 3
"""Largest number of warnings about a floor plan that a command prints; chosen by hand."""
LARGE_SHARE = 0.1
"""Share of damaged rows from which on they must be mended; chosen by hand."""


def recipe_option(what: str = "how to compute", **more: Any) -> Option:
    """Return --recipe; `what` says what the recipe is for."""
    given = {"default": "default", "help": f"{what} (default: default)"} | more
    return option("--recipe", metavar="NAME", choices=list(TABLE["recipe"]), **given)


add_heading = option(
    "--heading",
    metavar="DEGREES",
    type=parse_degrees,
    help="where the wearer looks at the start, to the left of x of the world that all sensors share (for most "
    "suits, north); for walking-modes with body sensors (default: the first steps say)",
)
"""--heading, for `recipes_of`."""


def recipes_of(options: Namespace) -> list[Recipe]:
    """Return the recipes of --recipe, with --heading; raise Failure for one that takes no heading."""
    from ...recipes import by_name

    names = [options.recipe] if isinstance(options.recipe, str) else options.recipe or ["default"]
    recipes = [by_name(name) for name in names]
    if options.heading is None:
        return recipes
    try:
        return [recipe.with_heading(options.heading) for recipe in recipes]
    except (LookupError, ValueError) as error:
        raise Failure(f"--heading: {error}") from None


add_clocks = one_of(
    option(
        "--clock-offset",
        metavar="S",
        type=parse_offset,
        help="feet recorded with separate clocks: seconds to add to the times of the right foot",
    ),
    option(
        "--shared-event",
        metavar="START,END",
        type=partial(parse_span, "START,END"),
        help="the same, with the offset from a lift ride or a jump from both feet between these times, s; the recording"
        " must be of samples",
    ),
)
"""--clock-offset or --shared-event."""


def undo_clocks(source: Source, options: Namespace) -> None:
    """Correct the times of the right foot by --clock-offset or --shared-event.

    The offset of a shared event is printed. Failure and RecordingError are raised when it cannot be found."""
    source.clock_offset = options.clock_offset or 0.0
    if options.shared_event is None:
        return
    if source.samples is None:
        raise Failure(f"--shared-event: {source.path} holds packets, not samples")
    from ...recording.samples.shared_event import shared_offset

    source.clock_offset, sigma = shared_offset(source.samples, *options.shared_event)
    note(f"{1000.0 * source.clock_offset:+.0f} ms (+-{1000.0 * sigma:.0f}) are added to the times of the right foot")


def source_of(
    files: Path | Sequence[Path],
    foot: Foot | Sequence[Foot] | None = None,
    mapping: TableMapping | None = None,
    own: Iterable[Driver] = (),
    report: Report = note,
) -> Source:
    """Open a recording and `report` its flaws; raise RecordingError when it cannot be used.

    Packets of devices of one's `own` become samples, for what computes with the built-in devices only."""
    from ...show.tables.progress import progress_bar

    names = [Path(file).name for file in ([files] if isinstance(files, Path) else files)]
    with progress_bar(f"reading {printable(names[0])}"):
        source = open_source(files, foot, mapping=mapping, report=report)
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


def remarks_on(source: Source) -> list[Remark]:
    """Return what reading a recording to its end showed: rows that are left out, and a foot that is assumed."""
    from ...walk.walk import Remark

    rows, found = source.bad_rows, list[Remark]()
    if rows is not None and rows.count:
        found.append(Remark("rows_damaged", rows.words, rows.count > LARGE_SHARE * (rows.count + rows.good)))
    if (assumed := assumed_foot(source)) is not None:
        found.append(Remark("foot_assumed", assumed))
    return found


def check_pressure(recipe: Recipe, source: Source, own: Iterable[Driver] = ()) -> None:
    """Raise Failure when the recipe needs pressure cells and the recording has none.

    `own` are the drivers of devices of one's own."""
    if recipe.needs_pressure and not _has_pressure(source, make_kinds(own)):
        raise Failure(f"recipe {recipe.name} needs pressure cells; {source.path} has none")


def _has_pressure(source: Source, kinds: DeviceKinds) -> bool:
    """Return whether the recording has pressure; True if it cannot be read."""
    from ...recording.decoded import decode

    if source.samples is not None:
        return any("pressure" in table.columns for table in source.samples.tables)
    try:
        for one in decode(source.look_ahead(), kinds):
            if isinstance(one, Sample) and one.pressure and source.foot in (None, one.site.foot):
                return True
    except RecordingError:
        return True  # the run itself reports what is wrong with it
    return False


add_calibration = option(
    "--calibration",
    metavar="FILE",
    type=Path,
    help="what is known of wearer, shoes and insoles, as `solepath calibrate` writes it",
)
"""--calibration."""


def calibration_of(options: Namespace) -> Calibration | None:
    """Return the calibration of --calibration, None without it; raise CalibrationError when the file is malformed."""
    from ...calibration.file import read_calibration

    return None if options.calibration is None else read_calibration(options.calibration)


def floorplan_of(options: Namespace) -> tuple[IndexedPlan | None, Start | None]:
    """Return the plan of --floorplan and the start of --start; print warnings about the plan on stderr.

    Failure is raised when the plan cannot be used, or when a walk cannot start at --start."""
    from ...floorplan.findings import find_warnings
    from ...floorplan.importers.reading import read_floorplan
    from ...floorplan.index import IndexedPlan
    from ...place.placing import start_error

    if options.floorplan is None:
        if options.start is not None:
            raise Failure("--start is a place on a floor plan: give --floorplan, too")
        return None, None
    plan = read_floorplan(options.floorplan)
    indexed = IndexedPlan(plan)
    start = None if options.start is None else start_of(options.start, plan)
    warnings = find_warnings(plan, has_start=start is not None and start.place is not None)
    for sentence in warnings[:MAX_WARNINGS]:
        note(f"{options.floorplan}: {sentence}")
    if len(warnings) > MAX_WARNINGS:
        note(f"{options.floorplan}: {len(warnings) - MAX_WARNINGS} more: solepath plan {options.floorplan}")
    if start is not None and (problem := start_error(indexed, start)) is not None:
        raise Failure(f"{options.floorplan}: {problem}")
    return indexed, start


def start_of(text: str, plan: FloorPlan) -> Start:
    """Return the start of a text of --start, START_FORMS, on a plan: m and degrees, plan frame.

    Raises Failure for other text, and for a place that is on several levels. The names of levels and places may contain
    commas."""
    from ...floorplan.plan import FloorPlanError, Start
    from ...types.checking import find_fault

    if text.startswith("heading="):
        with suppress(ValueError):
            return Start(heading=_heading(text.removeprefix("heading=")))
    for count in (3, 2):
        with suppress(ValueError):
            level, *numbers = text.rsplit(",", count)
            x, y, *heading = numbers
            if not level.strip():
                break
            start = Start(level.strip(), (finite(x), finite(y)), _heading(*heading) if heading else None)
            if (problem := find_fault(start, Start)) is not None:
                raise Failure(f"--start {printable(text, 80)}: {problem}")
            return start
    names = {one.id: [name for found in plan.places(one.id).values() for name in found] for one in plan.levels}
    wholes: list[tuple[str, float | None]] = [(text, None)]
    with suppress(ValueError):
        place, heading_text = text.rsplit(",", 1)
        wholes.append((place, _heading(heading_text)))
    readings = [
        (at, name, angle)
        for whole, angle in wholes
        for at, name in [(None, whole), *[(one, whole[len(one) + 1 :]) for one in names if whole.startswith(f"{one},")]]
    ]
    for at, name, angle in readings:
        if any(name.strip() in found for level, found in names.items() if at in (None, level)):
            try:
                return plan.start(name.strip(), at, angle)
            except FloorPlanError as error:
                raise Failure(f"--start {printable(text, 80)}: {error}; put the level before it") from None
    at, name, _ = readings[-1]
    known = [one for level, found in names.items() for one in found if at in (None, level)]
    why = unknown("place", name.strip(), known)
    raise Failure(f"--start {printable(text, 80)}{'' if why.endswith('?') else f' is not {START_FORMS}'}: {why}")


def _heading(text: str) -> float:
    """Return a heading in rad, of text in degrees; raise ValueError for other text, and Failure beyond a turn."""
    if abs(finite(text)) > 360.0:
        raise Failure(f"--start: a heading can be -360 to 360 degrees, not {text}")
    return radians(finite(text))


add_floorplan = together(
    option(
        "--floorplan",
        metavar="FILE",
        type=Path,
        help="find the wearer on this plan: GeoJSON, an IMDF archive or OpenStreetMap indoor tagging",
    ),
    option(
        "--start",
        metavar="PLACE[,HEADING]",
        help="where on it the wearer sets out: a room, stairs, a lift or a door (solepath plan lists them), LEVEL and"
        " such a place, or LEVEL,X,Y in m of the plan's frame; then the first heading in degrees, anticlockwise from"
        " the plan's x axis; or heading=DEGREES alone; without a place it is known after stairs or a lift",
    ),
)
"""--floorplan and --start."""
