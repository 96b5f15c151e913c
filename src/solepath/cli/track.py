"""`solepath track FILE`: runs a recording through a session, prints a summary and writes files."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..calibration import Calibration
from ..recording import RecordingError, Source, printable
from ..types import Packet, Sample
from .common.failure import note
from .common.files import REPORT, OutputFile, add_force, check_outputs, check_writable, files_of_track
from .common.inputs import (
    add_calibration,
    add_clocks,
    add_floorplan,
    add_recipe,
    assumed_foot,
    calibration_of,
    check_pressure,
    floorplan_of,
    recipes_of,
    source_of,
    undo_clocks,
)
from .common.outcomes import add_outcomes, band_files_of, has_outcomes, outcomes_of
from .common.own_devices import UnusedPackets, add_own_devices, drivers_of
from .common.report import add_report, check_report_options, report_of
from .common.run_file import Run, given_options, inputs_of
from .common.tables import add_tables, feet_of, mapping_of
from .common.view import PageAddress, add_speed, add_view, compute_rest, need_page, page_address_of, play, speed_of

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..link.driver import Driver
    from ..recipes import Recipe
    from ..session import Session
    from ..show.report import Report
    from .common.results import Results


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "track",
        help="run a recording and print a summary",
        description="Run a recording of packets (JSON Lines) or of samples (text tables, Excel, Parquet, .npz) and"
        " print a summary.",
        epilog="example: solepath track walk.csv --report walk.html\n"
        "solepath track left.csv right.csv --units g,deg/s,ms --out walk\n"
        "solepath track walk.jsonl --recipe default --recipe kupt-dfpc",
    )
    add_tables(command)
    add_own_devices(command)
    add_recipe(command, several=True)
    add_calibration(command)
    add_floorplan(command)
    add_clocks(command)
    command.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="write events.jsonl, track.csv, strides.csv and gait_cycles.csv into it, with a floor plan places.csv and "
        "plan.svg too, once they are whole",
    )
    add_report(command)
    add_outcomes(command)
    add_force(command)
    add_view(command, command, "play it")
    add_speed(command, "1, on the page")
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the recording; return the exit status."""
    from ..link.kinds import make_kinds
    from ..session import Session
    from .common.loop import stop_signals_raise
    from .common.results import Results

    recipe, *others = recipes_of(options)
    if others:
        from .several_recipes import track_with_each

        return track_with_each(options, [recipe, *others])
    outcomes = outcomes_of(options)
    check_report_options(options)
    outputs = _check_outputs(options)
    calibration, drivers = calibration_of(options), drivers_of(options)
    need_page(options, options.view is not None)
    address = page_address_of(options)
    pace = 1.0 if address is None else speed_of(options, 1.0)
    source = source_of(options.files, feet_of(options), mapping_of(options))
    undo_clocks(source, options)
    check_pressure(recipe, source, drivers)
    plan, start = floorplan_of(options)
    session = Session(
        recipe,
        calibration=calibration,
        poses=True,
        pressures=address is not None or options.report is not None,
        profiles=drivers,
        floorplan=plan,
        start=start,
    )
    before = None if options.compare is None else _before(options, recipe, calibration, drivers)
    recording = _Recording(source)
    results = Results(
        f"{printable(source.name)}, recipe {recipe.name}",
        options.out,
        options.report,
        contents=report_of(
            options, source, recipe=recipe.name, plan=None if plan is None else plan.plan, before=before
        ),
        plan=None if plan is None else plan.plan,
        outputs=outputs,
        outcomes=outcomes,
        unused=UnusedPackets(make_kinds(drivers)),
        run=Run(recipe, inputs_of(options), given_options(options)),
    )
    seconds, shown = 0.0, False
    with stop_signals_raise(), results:
        if address is None:
            seconds = _run_directly(recording, session, results)
        else:
            shown = _run_on_page(recording, session, results, plan, calibration, address, pace)
        if recording.failure is None or results.walk.item_count:
            results.write_and_print(seconds)
    if recording.failure is None:
        if (sentence := assumed_foot(source)) is not None:
            note(sentence)
        return 0
    if shown:
        return 2  # the reason was already printed
    raise recording.failure


def _check_outputs(options: argparse.Namespace) -> list[OutputFile]:
    """Return the files of --out and --report; raise Failure or OSError when one must not, or cannot, be written."""
    has_plan = options.floorplan is not None
    outputs = files_of_track(options.out, places=has_plan, plan=has_plan, outcomes=has_outcomes(options), run=True)
    if options.report is not None:
        outputs.append(OutputFile(options.report, REPORT))
    compared = [*(options.compare or ()), *band_files_of(options)]
    check_outputs(outputs, [*inputs_of(options), *compared], force=options.force)
    if options.report is not None:
        check_writable(options.report, made=options.out)
    return outputs


def _before(
    options: argparse.Namespace, recipe: Recipe, calibration: Calibration | None, drivers: tuple[Driver, ...]
) -> Report | None:
    """Run the earlier recording with which this one is compared; return its report."""
    from ..session import Session

    source = source_of(options.compare, feet_of(options), mapping_of(options))
    check_pressure(recipe, source, drivers)
    session = Session(recipe, calibration=calibration, poses=True, pressures=True, profiles=drivers)
    report, recording = report_of(options, source, recipe=recipe.name, before=None), _Recording(source)
    for item in recording:
        events = session.feed(item)
        if report is not None:
            report.take(item, events)
    if recording.failure is not None:
        raise recording.failure
    if report is not None:
        report.take(None, session.finish())
    return report


class _Recording:
    """The packets or samples of a recording up to the first fault, which `failure` then holds."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.failure: RecordingError | None = None

    def __iter__(self) -> Iterator[Packet | Sample]:
        from ..show.tables.progress import progress_bar

        source = self.source
        with progress_bar(printable(source.name), source.total) as show:
            try:
                for item in source:
                    yield item
                    show(source.done)
            except RecordingError as error:
                self.failure = error


def _run_directly(recording: _Recording, session: Session, results: Results) -> float:
    """Run the recording through the session without a page; return the wall time that it took, s."""
    from time import perf_counter

    start = perf_counter()
    for item in recording:
        results.open_files()
        results.add(item, session.feed(item))
    if recording.failure is None:
        results.open_files()  # for a recording without items
    # the items before a fault count as a whole walk
    results.add(None, session.finish())
    return perf_counter() - start


def _run_on_page(
    recording: _Recording,
    session: Session,
    results: Results,
    plan: IndexedPlan | None,
    calibration: Calibration | None,
    address: PageAddress,
    pace: float,
) -> bool:
    """Play the recording on a page; return whether there was anything to play.

    The results are those of `_run_directly`, whatever was played: `results` gets every item once and in order, those
    that were not played at the end."""
    from ..show.page.player.packed_items import PackedItems
    from ..show.page.player.player import Player
    from ..show.page.scene.scales import newtons_of
    from ..show.page.scene.scene import Scene

    items = PackedItems(recording)
    shown, fault = len(items) > 0, "" if recording.failure is None else str(recording.failure)
    if shown or not fault:
        results.open_files()
    scene = Scene(
        printable(recording.source.name),
        session.recipe.name,
        "recording",
        plan=None if plan is None else plan.plan,
        newtons=newtons_of(calibration),
    )
    player = Player(items, session, scene, plan, fault=fault, on_events=results.add)
    if shown:
        if fault:
            note(fault)
        play(player, address, pace)
    compute_rest(player, "recording")
    return shown
