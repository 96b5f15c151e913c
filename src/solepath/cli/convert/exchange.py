"""The part of `solepath convert` that runs a session: storage files of OpenSim, and Motion-BIDS datasets."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from ...recording import RecordingError, printable
from ..common.failure import Failure, parse_whole_number
from ..common.files import RECORDING, OutputFile, check_outputs
from ..common.inputs import add_calibration, add_recipe, calibration_of, check_pressure, recipe_of
from ..common.inputs import source_of as open_recording
from ..common.own_devices import drivers_of
from ..common.tables import feet_of, mapping_of
from .validating import need_validator, validate_dataset, validate_storage

if TYPE_CHECKING:
    from ...events import Event
    from ...recording import Source
    from ...recording.posed import PosedSample

STORAGE = ".sto"
"""End of the name of a storage file of OpenSim."""


def add_exchange(command: argparse.ArgumentParser) -> None:
    """Add the options of OpenSim and of Motion-BIDS to a command."""
    command.add_argument(
        "--positions", action="store_true", help="of the sensors instead of their attitudes, for OpenSim (.sto)"
    )
    command.add_argument(
        "--subject", metavar="LABEL", help="who walked: writes into the Motion-BIDS dataset in the folder OUT"
    )
    command.add_argument("--session", metavar="LABEL", default="", help="the visit, in the dataset")
    command.add_argument(
        "--task", metavar="LABEL", default="walk", help="what was done, in the dataset (default: walk)"
    )
    command.add_argument(
        "--run",
        metavar="N",
        dest="repetition",
        type=parse_whole_number,
        default=0,
        help="the repetition, in the dataset",
    )
    command.add_argument(
        "--validate",
        action="store_true",
        help="have the official validator of BIDS, or OpenSim, read the result (extras bids and opensim)",
    )
    add_recipe(command)
    add_calibration(command)


def convert_computed(options: argparse.Namespace) -> int:
    """Run the recording through a session and write what OUT or --subject says; return the exit status."""
    if options.sites or options.handles:
        raise Failure("--site and --handle are for btsnoop logs: convert the log to a recording (.jsonl) first")
    if options.validate:
        need_validator(dataset=options.subject is not None)
    return _to_dataset(options) if options.subject is not None else _to_storage(options)


def _source(options: argparse.Namespace) -> Source:
    return open_recording(options.files, feet_of(options), mapping_of(options))


def _to_storage(options: argparse.Namespace) -> int:
    from ...saving.files import replace_whole
    from ...show.opensim import OpensimWriter, Quantity

    output = OutputFile(options.out, RECORDING)
    check_outputs([output], [*options.files, options.mapping, options.calibration], force=options.force)
    writer = OpensimWriter(Quantity.POSITIONS if options.positions else Quantity.ATTITUDES)

    def add(samples: Iterable[PosedSample], _: Iterable[Event]) -> None:
        for posed in samples:
            writer.add(posed)

    damage = _run(options, _source(options), add)
    rows: list[int] = []
    replace_whole(options.out, lambda path: rows.append(writer.write(path)), lambda _: output.check_again())
    print(f"{rows[0]} rows written to {printable(str(options.out))}")
    _raise(damage)
    return validate_storage(options.out, positions=options.positions) if options.validate else 0


def _to_dataset(options: argparse.Namespace) -> int:
    from ...recording.bids.names import Entities
    from ...recording.bids.writer import MotionWriter

    try:
        entities = Entities(options.subject, options.task, options.session, options.repetition)
    except ValueError as error:
        raise Failure(str(error)) from None
    source = _source(options)
    try:
        writer = MotionWriter(options.out, entities, source.header, replace=options.force)
    except RecordingError as error:
        raise Failure(f"{error}; --force replaces it" if "already" in error.what else str(error)) from None
    damage = _run(options, source, writer.add)
    written = writer.write()
    print(f"{len(written)} files written to {printable(str(options.out / entities.folder))}")
    _raise(damage)
    return validate_dataset(options.out) if options.validate else 0


def _run(
    options: argparse.Namespace, source: Source, add: Callable[[Iterable[PosedSample], Iterable[Event]], None]
) -> RecordingError | None:
    """Run the recording, and pass samples and events to `add`; return the error that ended the recording, if any."""
    from ...recording.posed import PosedSession
    from ...session import Session
    from ...show.tables.progress import progress_bar

    recipe = recipe_of(options)
    calibration, drivers = calibration_of(options), drivers_of(options)
    check_pressure(recipe, source, drivers)
    posed = PosedSession(Session(recipe, calibration=calibration, poses=True, profiles=drivers))
    damage: RecordingError | None = None
    try:
        with progress_bar(printable(source.name), source.total) as show:
            for item in source:
                events = posed.session.feed(item)
                add(posed.take(), events)
                show(source.done)
    except RecordingError as error:
        damage = error
    events = posed.session.finish()
    add(posed.take(), events)
    return damage


def _raise(damage: RecordingError | None) -> None:
    """Raise what ended the recording early, if anything did."""
    if damage is not None:
        raise damage
