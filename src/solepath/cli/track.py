"""`solepath track FILE`: a recording through a session, summed up and written out."""

from __future__ import annotations

import argparse
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .calibrated import add_calibration, calibration_of, check_pressure
from .failure import Failure, check_writable, known_recipe, note
from .floorplan import add_floorplan, floorplan_of

if TYPE_CHECKING:
    from ..events import Event

LONG = 4_000_000
"""Bytes of packets from which on there is a progress bar ..."""
LONG_SAMPLES = 40_000
"""... or samples: a second or so of computing."""


def add_to(commands: Any) -> None:
    command: argparse.ArgumentParser = commands.add_parser(
        "track",
        help="run a recording and print a summary",
        description="Run a recording of packets (JSON Lines) or of samples (.npz, .csv) and print a summary.",
    )
    command.add_argument("file", metavar="FILE", type=Path, help="the recording")
    command.add_argument("--recipe", metavar="NAME", default="default", help="how to compute (default: default)")
    add_calibration(command)
    add_floorplan(command)
    command.add_argument(
        "--foot",
        choices=["left", "right"],
        help="whose the samples of a recording of one foot are (default: right); of other recordings, the foot to use",
    )
    command.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="write events.jsonl, track.csv, steps.csv and gait.csv into it, with a floor plan places.csv and "
        "plan.svg too",
    )
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    from time import perf_counter

    from .. import recipes
    from ..output import PLAN, TrackFiles
    from ..recording import RecordingError
    from ..session import Session
    from ..source import open_source
    from ..tally import Tally
    from ..types import Foot, Sample
    from ..view.placed import Places
    from ..view.plan import PlanPicture
    from ..view.progress import progress_bar
    from ..view.summary import summary

    recipe = recipes.BY_NAME[known_recipe(options.recipe, list(recipes.BY_NAME))]
    calibration = calibration_of(options)
    try:
        source = open_source(options.file, Foot(options.foot) if options.foot else None, report=note)
    except RecordingError as error:
        raise Failure(str(error)) from None
    check_pressure(recipe, source)
    plan, start = floorplan_of(options)
    session = Session(recipe, calibration=calibration, poses=True, floorplan=plan, start=start)
    tally, places = Tally(), Places()
    picture = None if plan is None else PlanPicture(plan.plan)
    failure: Failure | None = None
    began = perf_counter()
    with ExitStack() as stack:
        files: TrackFiles | None = None

        def opened() -> TrackFiles:
            made = stack.enter_context(TrackFiles(options.out, places=plan is not None))
            if plan is not None:
                check_writable(options.out / PLAN)  # it is written last
            return made

        def told(event: Event) -> None:
            tally.add(event)
            if files is not None:
                files.write(event)
            if picture is not None:
                places.add(event)
                picture.add(event)

        long = source.total > (LONG if source.samples is None else LONG_SAMPLES)
        show = stack.enter_context(progress_bar(options.file.name, source.total, wanted=long))
        try:
            for item in source:
                # not before: a file that cannot be used must not replace what an earlier run wrote
                if files is None and options.out:
                    files = opened()
                if isinstance(item, Sample):
                    tally.fed_sample(item)
                else:
                    tally.fed_packet(item)
                for event in session.feed(item):
                    told(event)
                show(source.done)
        except RecordingError as error:
            failure = Failure(str(error))
        if files is None and options.out and failure is None:
            files = opened()  # of a recording of nothing
        # what came before a fault in the file is a walk of its own: it is finished and written like any other
        for event in session.finish():
            told(event)
    if failure is None or tally.first is not None:
        title = f"{options.file.name}, recipe {recipe.name}"
        print(summary(tally, title=title, seconds=perf_counter() - began))
        if picture is not None:
            print("\n".join(places.lines()))
            if options.out:
                picture.write(options.out / PLAN, title)
        if options.out:
            print(f"written to {options.out}")
    if failure is not None:
        raise failure
    return 0
