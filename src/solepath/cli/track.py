"""`solepath track FILE`: runs a recording through a session, prints a summary and writes files."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..calibration import Calibration
from ..recording import RecordingError, Source, printable, read_header, read_start_time
from ..session import Session
from ..types import Packet, Sample
from .common.failure import note, recipe_named
from .common.inputs import (
    add_calibration,
    add_floorplan,
    add_foot,
    calibration_of,
    check_pressure,
    floorplan_of,
    foot_of,
    source_of,
)
from .common.view import View, add_speed, add_view, need_page, newtons_of, pace_of, play, run_rest, view_of

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from .common.results import Results

LONG = 4_000_000
"""Size of a recording of packets from which on there is a progress bar, bytes."""
LONG_SAMPLES = 40_000
"""Number of samples from which on there is a progress bar: about a second of computing."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "track",
        help="run a recording and print a summary",
        description="Run a recording of packets (JSON Lines) or of samples (.npz, .csv) and print a summary.",
    )
    command.add_argument("file", metavar="FILE", type=Path, help="the recording")
    command.add_argument("--recipe", metavar="NAME", default="default", help="how to compute (default: default)")
    add_calibration(command)
    add_floorplan(command)
    add_foot(command)
    command.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="write events.jsonl, track.csv, strides.csv and gait_cycles.csv into it, with a floor plan places.csv and "
        "plan.svg too, once they are whole",
    )
    command.add_argument(
        "--report", metavar="FILE", type=Path, help="write figures and the gait table into one HTML file, to be mailed"
    )
    add_view(command, command, "play it")
    add_speed(command, "1, on the page")
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the recording; return the exit status."""
    from .common.loop import stop_signals_raise
    from .common.results import Results

    recipe = recipe_named(options.recipe)
    calibration = calibration_of(options)
    need_page(options, options.view is not None)
    view = view_of(options)
    pace = 1.0 if view is None else pace_of(options, 1.0)
    source = source_of(options.file, foot_of(options))
    check_pressure(recipe, source)
    plan, start = floorplan_of(options)
    session = Session(
        recipe,
        calibration=calibration,
        poses=True,
        pressures=view is not None or options.report is not None,
        floorplan=plan,
        start=start,
    )
    reading = _Reading(source)
    results = Results(
        f"{printable(options.file.name)}, recipe {recipe.name}",
        options.out,
        options.report,
        plan=None if plan is None else plan.plan,
        recipe=recipe.name,
        when=_when(source),
    )
    seconds, shown = 0.0, False
    with stop_signals_raise(), results:
        if view is None:
            seconds = _straight(reading, session, results)
        else:
            shown = _played(reading, session, results, plan, calibration, view, pace)
        if reading.failure is None or results.observer.item_count:
            results.print(seconds)
    if reading.failure is None:
        return 0
    if shown:
        return 2  # the reason was already printed
    raise reading.failure


def _when(source: Source) -> str:
    """Return when the recording started, as text; "" when it does not say."""
    if source.samples is not None:
        return ""
    try:
        moment = read_start_time(read_header(source.path))
    except RecordingError:
        return ""  # the run itself reports what is wrong with it
    return "" if moment is None else f"{moment[0]:%Y-%m-%d %H:%M} UTC"


class _Reading:
    """The items of a recording up to a fault in it, with a progress bar for a long one.

    `failure` is the fault."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.failure: RecordingError | None = None

    def __iter__(self) -> Iterator[Packet | Sample]:
        from ..show.tables.progress import progress_bar

        source = self.source
        long = source.total > (LONG if source.samples is None else LONG_SAMPLES)
        with progress_bar(printable(source.path.name), source.total, enabled=long) as show:
            try:
                for item in source:
                    yield item
                    show(source.done)
            except RecordingError as error:
                self.failure = error


def _straight(reading: _Reading, session: Session, results: Results) -> float:
    """Run the recording through the session item by item; return how long that took, s."""
    from time import perf_counter

    start = perf_counter()
    for item in reading:
        results.open_files()
        results.add(item, session.feed(item))
    if reading.failure is None:
        results.open_files()  # for a recording without items
    # items before a fault in the file are a walk of their own: it is finished and written like any other
    results.add(None, session.finish())
    return perf_counter() - start


def _played(
    reading: _Reading,
    session: Session,
    results: Results,
    plan: IndexedPlan | None,
    calibration: Calibration | None,
    view: View,
    pace: float,
) -> bool:
    """Run the recording by a player on a page; return whether there was anything to play.

    The player passes on every item once and in order, whatever is done on the page, and what nobody has watched is
    computed at the end. The result is that of `_straight`."""
    from ..show.page.player.packed_items import PackedItems
    from ..show.page.player.player import Player
    from ..show.page.scene.scene import Scene

    items = PackedItems(reading)
    shown, fault = len(items) > 0, "" if reading.failure is None else str(reading.failure)
    if shown or not fault:
        results.open_files()
    scene = Scene(
        printable(reading.source.path.name),
        session.recipe.name,
        "recording",
        plan=None if plan is None else plan.plan,
        newtons=newtons_of(calibration),
    )
    player = Player(items, session, scene, plan, fault=fault, on_events=results.add)
    if shown:
        if fault:
            note(fault)
        play(player, view, pace)
    run_rest(player, "recording")
    return shown
