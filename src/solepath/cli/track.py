"""`solepath track FILE`: runs a recording through a session, prints a summary and writes files."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from ..calibration import Calibration
from ..recording import printable
from .common.failure import Failure, note, reject_options
from .common.files import RECORDING, REPORT, WAY_KINDS, OutputFile, add_force, check_outputs, files_of_track
from .common.inputs import (
    Recording,
    add_calibration,
    add_clocks,
    add_floorplan,
    add_heading,
    calibration_of,
    check_pressure,
    floorplan_of,
    recipe_option,
    recipes_of,
    remarks_on,
    source_of,
    undo_clocks,
)
from .common.outcomes import add_outcomes, has_outcomes, outcomes_before, outcomes_of
from .common.own_devices import drivers_of
from .common.parser import command, option
from .common.report import DETAILS, add_report, report_of
from .common.tables import feet_of, mapping_of, source_named, table_options
from .common.view import PageAddress, add_no_browser, page_address_of, play, speed_of, speed_option, view_option

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import Start
    from ..link.driver import Driver
    from ..recipes import Recipe
    from ..session import Session
    from .common.results import Results


OF_ONE_RECIPE = (
    "report", "title", "subject", "date", "device", "compare", "reference", "view", "no_browser", "speed", "export",
)  # fmt: skip
"""Options of the report, the page and the way, which show one walk, so that they go with one recipe."""


def run(options: Namespace) -> int:
    """Run the recording, with several recipes through a session for each at once; return the exit status."""
    from ..link.kinds import make_kinds
    from ..session import Session
    from ..show.export import way_error
    from .common.loop import stop_signals_raise
    from .common.results import Results

    recipes = recipes_of(options)
    is_one = len(recipes) == 1
    if not is_one:
        _check_comparison(options, recipes)
    outcomes, of_before = outcomes_of(options), outcomes_before(options)
    if options.report is None:
        reject_options(options, (*DETAILS, "compare"), "goes with --report")
    outputs = _outputs(options, recipes)
    calibration, drivers = calibration_of(options), drivers_of(options)
    address = page_address_of(options)
    pace = speed_of(options, 1.0)
    source = source_named(options)
    undo_clocks(source, options)
    for recipe in recipes:
        check_pressure(recipe, source, drivers)
    plan, start = floorplan_of(options)
    floor = None if plan is None else plan.plan
    if options.export is not None and (error := way_error(options.export.suffix.lower(), floor)) is not None:
        raise Failure(f"--export {options.export}: {error}")
    has_cells = address is not None or options.report is not None

    def new_session(recipe: Recipe, plan: IndexedPlan | None = None, start: Start | None = None) -> Session:
        return Session(
            recipe,
            calibration=calibration,
            poses=True,
            pressures=has_cells,
            losses=True,
            profiles=drivers,
            floorplan=plan,
            start=start,
        )

    before, kinds = None, make_kinds(drivers)
    if options.compare is not None:
        earlier = source_of(options.compare, feet_of(options, options.compare), mapping_of(options))
        check_pressure(recipes[0], earlier, drivers)
        before = report_of(options, earlier, recipe=recipes[0].name, before=None)
        _run(
            [Results(new_session(recipes[0]), "", contents=before, outcomes=of_before, kinds=kinds)],
            recording := Recording(earlier),
        )
        if recording.failure is not None:
            raise recording.failure
    recording = Recording(source)
    runs = [
        Results(
            new_session(recipe, plan, start),
            f"{recording.name}, recipe {recipe.name}",
            options.out if is_one else _folder(options, recipe),
            options.report,
            report_of(options, source, recipe=recipe.name, plan=floor, before=before),
            floor,
            outputs,
            outcomes,
            options,
            options.export,
            kinds,
            start,
        )
        for recipe in recipes
    ]
    shown = False
    with stop_signals_raise(), ExitStack() as stack:
        for one in runs:
            stack.enter_context(one)
        if address is None:
            _run(runs, recording)
        else:
            shown = _run_on_page(recording, runs[0], plan, calibration, drivers, address, pace)
        if recording.failure is None or runs[0].walk.item_count:
            for one in runs:
                one.walk.remarks = remarks_on(source)
            lines = [one.write() for one in runs]
            print("\n".join(lines[0] if is_one else _comparison(options, recording.name, runs)))
            for sentence in runs[0].urgent_links():
                note(sentence)
    if recording.failure is None:
        return 0
    if shown:
        return 2  # the reason was already printed
    raise recording.failure


def _folder(options: Namespace, recipe: Recipe) -> Path | None:
    """Return the folder of the files of one of several recipes."""
    return None if options.out is None else Path(options.out, recipe.name)


def _check_comparison(options: Namespace, recipes: Sequence[Recipe]) -> None:
    """Raise Failure for a recipe that is given twice, and for options that go with one recipe."""
    names = [recipe.name for recipe in recipes]
    if twice := [name for name in names if names.count(name) > 1]:
        raise Failure(f"--recipe {twice[0]} was given twice")
    why = "is for one walk: give one --recipe with it, or leave it out to compare recipes"
    reject_options(options, OF_ONE_RECIPE, why)
    if has_outcomes(options):
        raise Failure("clinical outcomes are of one walk: give one --recipe with them")


def _outputs(options: Namespace, recipes: Sequence[Recipe]) -> list[OutputFile]:
    """Return the files of --out, --report and --export; raise Failure or OSError when one must not be written."""
    has_plan, outcomes = options.floorplan is not None, has_outcomes(options)
    outputs = files_of_track(options.out, places=has_plan, plan=has_plan, outcomes=outcomes)
    if len(recipes) > 1:
        folders = [_folder(options, recipe) for recipe in recipes]
        outputs = [one for out in folders for one in files_of_track(out, places=has_plan, plan=has_plan)]
    if options.report is not None:
        outputs.append(OutputFile(options.report, REPORT))
    if options.export is not None:
        outputs.append(OutputFile(options.export, WAY_KINDS.get(options.export.suffix.lower(), RECORDING)))
    check_outputs(options, outputs)
    return outputs


def _run(runs: Sequence[Results], recording: Recording) -> None:
    """Run the recording through all sessions; the items before a fault count as a whole walk."""
    for item in recording:
        for run in runs:
            run.feed(item)
    if recording.failure is None or runs[0].walk.item_count:
        for run in runs:
            run.feed(None)


def _comparison(options: Namespace, name: str, runs: Sequence[Results]) -> list[str]:
    """Return the table of several recipes."""
    from ..show.tables.recipes import RecipeRun, recipe_lines

    rows = [RecipeRun(run.session.recipe.name, run.walk, run.seconds) for run in runs]
    written = ", ".join(printable(str(run.out)) for run in runs)
    return [*recipe_lines(f"{name}, {len(rows)} recipes", rows), *([f"written to {written}"] if options.out else [])]


def _run_on_page(
    recording: Recording,
    results: Results,
    plan: IndexedPlan | None,
    calibration: Calibration | None,
    drivers: Sequence[Driver],
    address: PageAddress,
    pace: float,
) -> bool:
    """Play the recording on a page; return whether there was anything to play.

    The results are those of `_run`, whatever was played: `results` gets every item once and in order, those that were
    not played at the end."""
    from ..show.page.player.packed_items import PackedItems
    from ..show.page.player.player import Player
    from ..show.page.scene.scales import newtons_of
    from ..show.page.scene.scene import Scene

    items = PackedItems(recording)
    shown, fault = len(items) > 0, str(recording.failure or "")
    if fault and not shown:
        return False
    session = results.session
    scene = Scene(recording.name, session.recipe.name, "recording", plan=results.plan, newtons=newtons_of(calibration))
    player = Player(items, session, scene, plan, drivers, fault=fault, on_events=results.add)
    if fault:
        note(fault)
    play(player, address, pace, "recording")
    return shown


add_track = command(
    "track",
    "Run a recording of packets (JSON Lines) or of samples (text tables, Excel, Parquet, .npz) and print a summary.",
    "solepath track walk.csv --report walk.html\n"
    "solepath track left.csv right.csv --units g,deg/s,ms --out walk\n"
    "solepath track walk.jsonl --recipe default --recipe kupt-dfpc",
    table_options(),
    recipe_option(
        action="append",
        default=None,
        help="how to compute (default: default); given again, one table with a column for each recipe",
    ),
    add_heading,
    add_calibration,
    add_floorplan,
    add_clocks,
    option(
        "--out",
        metavar="DIR",
        type=Path,
        help="write events.jsonl, track.csv, strides.csv, gait_cycles.csv and run.json into it, with a floor plan "
        "places.csv and plan.svg too, once they are whole",
    ),
    option(
        "--export",
        metavar="FILE",
        type=Path,
        help="write the way for a map: .geojson, .gpx or .kml, the latter two on a floor plan with an anchor",
    ),
    add_report,
    add_outcomes,
    add_force,
    view_option("play it"),
    add_no_browser,
    speed_option("1, on the page"),
    run=run,
)
