"""`solepath check FILE`: tells what is wrong with a recording, in sentences."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..body.checks.axes import SETTLED_STRIDES
from ..events import DefectFound, Event
from ..recording import RecordingError, open_file, printable
from ..session import Session
from ..types import Packet, Sample
from .common.failure import recipe_named
from .common.inputs import add_calibration, add_foot, assumed_foot, calibration_of, foot_of, source_of

UNSEEN = (
    "an accelerometer with all three axes reversed, which turns left into right",
    "an accelerometer turned by a few degrees against the gyroscope",
    "a gyroscope whose scale is wrong by a few percent",
    "clocks of the feet that are apart, of a wearer who limps",
)
"""Defects that no check can see."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "check",
        help="say what is wrong with a recording",
        description="Say what is wrong with a recording of packets (JSON Lines) or of samples (.npz, .csv), in"
        " sentences. The exit status is 1 if something must be mended. Axes need about 20 s of walking, clocks 60 s.",
    )
    command.add_argument("file", metavar="FILE", type=Path, help="the recording")
    command.add_argument("--recipe", metavar="NAME", default="default", help="how to compute (default: default)")
    add_calibration(command)
    add_foot(command)
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Check the recording and print the verdict; return 1 if something must be mended, else 0."""
    from ..show.observer import Observer
    from ..show.tables.summary import link_health, wear_lines

    recipe, calibration = recipe_named(options.recipe), calibration_of(options)
    open_file(options.file).close()
    session, observer = Session(recipe, calibration=calibration, poses=True), Observer()
    must: list[str] = []
    may: list[str] = []

    def take(item: Packet | Sample | None, events: list[Event]) -> None:
        observer.take(item, events)
        for event in events:
            if isinstance(event, DefectFound):
                (must if event.needs_action else may).append(f"{event.site.words}: {event.what}")

    try:
        source = source_of(options.file, foot_of(options))
        may += filter(None, [assumed_foot(source)])
        for item in source:
            take(item, session.feed(item))
    except RecordingError as error:
        must.append(str(error))
    take(None, session.finish())
    must += [*wear_lines(observer), *observer.troubles]
    may += [*observer.limitations, *link_health(observer)]
    strides = {foot: counts.strides for foot, counts in observer.feet.items() if counts.strides}
    walked = ", ".join(f"{foot} foot {count} strides" for foot, count in strides.items()) or "no stride"
    print(f"{printable(options.file.name)}: {observer.covered_time.total:.1f} s, {walked}")
    _print_list("must be mended", must)
    _print_list("worth knowing", may)
    if not must:
        print("nothing must be mended")
    if min(strides.values(), default=0) < SETTLED_STRIDES:
        print(f"too little walking: axes need {SETTLED_STRIDES} strides of a foot, and clocks of the feet a minute")
    _print_list("no check sees", UNSEEN)
    return 1 if must else 0


def _print_list(title: str, sentences: Sequence[str]) -> None:
    if sentences:
        print("\n  ".join([f"{title}:", *map(printable, sentences)]))
