"""The part of `solepath track` that runs one recording through several recipes, and prints a table of them."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from ..recording import RecordingError, printable
from ..types import Packet, Sample
from .common.failure import Failure, note
from .common.files import OutputFile, check_outputs, files_of_track
from .common.inputs import assumed_foot, calibration_of, check_pressure, floorplan_of, source_of, undo_clocks
from .common.outcomes import has_outcomes
from .common.own_devices import UnusedPackets, drivers_of
from .common.run_file import Run, given_options, inputs_of
from .common.tables import feet_of, mapping_of

if TYPE_CHECKING:
    from ..recipes import Recipe

OF_ONE_RECIPE = ("report", "title", "subject", "date", "device", "compare", "reference", "view", "no_browser", "speed")
"""Options of the report and of the page, which show one walk, so that they go with one recipe."""


def track_with_each(options: argparse.Namespace, recipes: Sequence[Recipe]) -> int:
    """Run the recording through a session for each recipe at once, and print the table; return the exit status.

    With --out DIR the files of each recipe are written into the folder of its name in DIR."""
    from ..link.kinds import make_kinds
    from ..session import Session
    from ..show.tables.progress import progress_bar
    from ..show.tables.recipes import RecipeRun, recipe_lines
    from .common.loop import stop_signals_raise
    from .common.results import Results

    _check_options(options, recipes)
    outputs = _check_outputs(options, recipes)
    calibration, drivers = calibration_of(options), drivers_of(options)
    source = source_of(options.files, feet_of(options), mapping_of(options))
    undo_clocks(source, options)
    for recipe in recipes:
        check_pressure(recipe, source, drivers)
    plan, start = floorplan_of(options)
    name = printable(source.name)
    rows, runs = list[RecipeRun](), list[tuple[RecipeRun, Session, Results]]()
    failure: RecordingError | None = None
    with stop_signals_raise(), ExitStack() as stack:
        for recipe in recipes:
            session = Session(
                recipe, calibration=calibration, poses=True, profiles=drivers, floorplan=plan, start=start
            )
            results = stack.enter_context(
                Results(
                    f"{name}, recipe {recipe.name}",
                    _folder(options.out, recipe),
                    plan=None if plan is None else plan.plan,
                    outputs=outputs,
                    unused=UnusedPackets(make_kinds(drivers)),
                    run=Run(recipe, inputs_of(options), given_options(options)),
                )
            )
            rows.append(RecipeRun(recipe.name, results.walk))
            runs.append((rows[-1], session, results))

        def feed(item: Packet | Sample | None) -> None:
            for row, session, results in runs:
                start_time = perf_counter()
                events = session.finish() if item is None else session.feed(item)
                results.open_files()
                results.add(item, events)
                row.seconds += perf_counter() - start_time

        with progress_bar(name, source.total) as show:
            try:
                for item in source:
                    feed(item)
                    show(source.done)
            except RecordingError as error:
                failure = error
        if failure is None or rows[0].walk.item_count:
            feed(None)
            for _, _, results in runs:
                results.write_files()
            print("\n".join(recipe_lines(f"{name}, {len(rows)} recipes", rows)))
            if options.out is not None:
                print(f"written to {', '.join(printable(str(_folder(options.out, recipe))) for recipe in recipes)}")
    if failure is not None:
        raise failure
    for sentence in (*runs[0][2].unused.sentences(), assumed_foot(source)):
        if sentence is not None:
            note(sentence)
    return 0


def _folder(out: Path | None, recipe: Recipe) -> Path | None:
    return None if out is None else out / recipe.name


def _check_options(options: argparse.Namespace, recipes: Sequence[Recipe]) -> None:
    """Raise Failure for a recipe that is given twice, and for options that go with one recipe."""
    names = [recipe.name for recipe in recipes]
    if twice := [name for name in names if names.count(name) > 1]:
        raise Failure(f"--recipe {twice[0]} was given twice")
    for option in OF_ONE_RECIPE:
        if getattr(options, option, None) not in (None, False):
            name = option.replace("_", "-")
            raise Failure(f"--{name} is for one walk: give one --recipe with it, or leave it out to compare recipes")
    if has_outcomes(options):
        raise Failure("clinical outcomes are of one walk: give one --recipe with them")


def _check_outputs(options: argparse.Namespace, recipes: Sequence[Recipe]) -> list[OutputFile]:
    """Return the files of --out of all recipes; raise Failure or OSError when one must not be written."""
    files_of_track(options.out, places=False)
    has_plan = options.floorplan is not None
    outputs = [
        output
        for recipe in recipes
        for output in files_of_track(_folder(options.out, recipe), places=has_plan, plan=has_plan, run=True)
    ]
    check_outputs(outputs, inputs_of(options), force=options.force)
    return outputs
