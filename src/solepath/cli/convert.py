"""`solepath convert IN OUT`: makes a recording of a Bluetooth log, and MCAP, OpenSim or Motion-BIDS of recordings."""

from __future__ import annotations

import json
import subprocess
import sys
from argparse import ArgumentTypeError, Namespace
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from string import hexdigits
from typing import TYPE_CHECKING, Any, TypeVar

from ..recording import PacketWriter, RecordingError, printable
from ..types import Site
from .common.closest import unknown
from .common.failure import Failure, note, parse_whole_number, require
from .common.files import RECORDING as RECORDING_KIND
from .common.files import OutputFile, add_force, check_outputs
from .common.inputs import (
    Recording,
    add_calibration,
    add_heading,
    calibration_of,
    check_pressure,
    recipe_option,
    recipes_of,
)
from .common.own_devices import drivers_of
from .common.parser import command, option
from .common.tables import source_named, table_options

if TYPE_CHECKING:
    from ..events import Event
    from ..link.driver import Driver
    from ..recording import Source
    from ..recording.btsnoop import BtsnoopLog
    from ..recording.mcap import McapWriter
    from ..recording.posed import PosedSample

RECORDING, MCAP, STORAGE = ".jsonl", ".mcap", ".sto"
TARGETS = f"a recording is converted to {MCAP} or {STORAGE} or, with --subject, into a Motion-BIDS dataset"
DIGITS_OF_ADDRESS = 12
"""Number of hexadecimal digits of a Bluetooth address."""
BIDS_PROGRAM = "from bids_validator_deno import cli; cli()"
"""Program that runs the official validator of BIDS, which the package brings with its own runtime."""
MAX_ISSUES = 10
"""Largest number of issues that are printed."""
_Key = TypeVar("_Key")
_Value = TypeVar("_Value")


def _spelt(address: str) -> str:
    """Return an address as logs have it, however it was written."""
    from ..link.setup.config import plain_address

    plain = plain_address(address)
    is_digits = len(plain) == DIGITS_OF_ADDRESS and set(plain) <= set(hexdigits)
    return ":".join([plain[i : i + 2] for i in range(0, DIGITS_OF_ADDRESS, 2)]) if is_digits else plain


def _site(text: str) -> tuple[str, Site]:
    address, equals, name = text.rpartition("=")
    try:
        if not equals:
            raise ValueError
        return _spelt(address), Site(name)
    except ValueError:
        raise ArgumentTypeError(f"{text!r} is not ADDRESS=SITE") from None


def _handle(text: str) -> tuple[tuple[str, int], str]:
    left, _, channel = text.partition("=")
    device, _, number = left.rpartition("/")
    try:
        handle = int(number, 0)
    except ValueError:
        handle = 0
    if not 0 < handle <= 0xFFFF or not channel:
        raise ArgumentTypeError(f"{text!r} is not [ADDRESS/]HANDLE=CHANNEL")
    return (_spelt(device), handle), channel


def run(options: Namespace) -> int:
    """Convert the file; return the exit status."""
    is_dataset, is_storage = options.subject is not None, options.out.suffix.lower() == STORAGE
    if not is_dataset and not is_storage:
        return _to_packets(options)
    if options.sites or options.handles:
        raise Failure("--site and --handle are for Bluetooth logs: convert the log to a recording (.jsonl) first")
    if options.validate:
        package = ("bids", "bids_validator_deno") if is_dataset else ("opensim", "opensim")
        require("--validate needs", *package)
    return _to_dataset(options) if is_dataset else _to_storage(options)


def _to_packets(options: Namespace) -> int:
    """Write a recording of packets, of a log, or MCAP, of either."""
    from ..recording import Source, open_source
    from ..recording.btsnoop import is_log
    from ..recording.btsnoop.records import reject_pipe

    path, out, drivers = options.files[0], options.out, drivers_of(options)
    open_writer = _writer_class(out, drivers)
    if len(options.files) > 1:
        raise Failure(f"{out}: is made of one log or recording, not of {len(options.files)}")
    output = OutputFile(out, RECORDING_KIND)
    check_outputs(options, [output])
    source: Source | BtsnoopLog
    if is_log(path):
        source = _open_log(options, drivers)
    elif options.sites or options.handles:
        raise Failure("--site and --handle are for Bluetooth logs; a recording knows its sites and channels")
    elif out.suffix.lower() == RECORDING:
        reject_pipe(path)
        raise Failure(f"{path}: is no Bluetooth log; {TARGETS}")
    else:
        source = open_source(path, report=note)
        if source.samples is not None:
            raise Failure(f"{path}: holds samples, and {MCAP} is made of packets")
    recording = Recording(source)

    def write(temporary: Path) -> int:
        try:
            with open_writer(temporary, source.header) as writer:
                for packet in recording:
                    writer.write(packet)
        except RecordingError as error:
            if isinstance(error.__cause__, OSError):
                raise error.__cause__ from None
            raise Failure(f"{out}: {error.what}") from None
        if recording.failure is not None and not writer.count:
            raise recording.failure
        return writer.count

    count = output.replace(write)
    if not isinstance(source, Source):
        for device in source.devices.values():
            if device.site is not None and device.count:
                kind = "" if device.profile is None else f", {device.profile.name}"
                print(f"{printable(device.address)}  {device.site.value}{kind}: {device.count} notifications")
    return _ended(recording, f"{count} packets written to {printable(str(out))}")


def _ended(recording: Recording, sentence: str) -> int:
    """Print what was written; raise what ended the recording early, if anything did, or return 0."""
    print(sentence)
    if recording.failure is not None:
        raise recording.failure
    return 0


def _open_log(options: Namespace, own: Iterable[Driver]) -> BtsnoopLog:
    from ..recording.btsnoop import open_btsnoop
    from ..recording.btsnoop.devices import known_devices

    sites, handles = _by_key("--site", options.sites), _by_key("--handle", options.handles)
    known = known_devices(own).channel_names
    for name in handles.values():
        if name not in known:
            raise Failure(unknown("channel", name, sorted(known)))
    return open_btsnoop(options.files[0], sites=sites, handles=handles, profiles=own, report=note)


def _by_key(option: str, pairs: Sequence[tuple[_Key, _Value]]) -> dict[_Key, _Value]:
    """Return the values of an option by their keys; raise Failure when a key is given twice."""
    values = dict(pairs)
    if len(values) < len(pairs):
        raise Failure(f"{option} is given twice for the same device")
    return values


OpenWriter = Callable[[Path, Mapping[str, Any]], "PacketWriter | McapWriter"]


def _writer_class(out: Path, own: Iterable[Driver]) -> OpenWriter:
    """Return what opens a writer of a file of this name; raise Failure when there is none."""
    suffix = out.suffix.lower()
    if suffix == RECORDING:
        return PacketWriter
    if suffix != MCAP:
        raise Failure(
            f"{out}: ends neither in {RECORDING} nor in {MCAP} nor in {STORAGE}, which says "
            "what to write; --subject writes a Motion-BIDS dataset"
        )
    require("writing MCAP needs the package", "mcap", "mcap")
    from ..recording.mcap import McapWriter

    return partial(McapWriter, profiles=own)


def _to_storage(options: Namespace) -> int:
    from ..show.opensim import OpensimWriter, Quantity
    from .common.run_file import made_by

    output = OutputFile(options.out, RECORDING_KIND)
    check_outputs(options, [output])
    quantity = Quantity.POSITIONS if options.positions else Quantity.ATTITUDES
    writer = OpensimWriter(quantity, made_by(recipes_of(options)[0], options))

    def add(samples: Iterable[PosedSample], _: Iterable[Event]) -> None:
        for posed in samples:
            writer.add(posed)

    recording = _run(options, source_named(options), add)
    _ended(recording, f"{output.replace(writer.write)} rows written to {printable(str(options.out))}")
    return validate_storage(options.out, positions=options.positions) if options.validate else 0


def _to_dataset(options: Namespace) -> int:
    from ..recording.bids.names import Entities
    from ..recording.bids.writer import MotionWriter
    from .common.run_file import made_by

    try:
        entities = Entities(options.subject, options.task, options.session, options.repetition)
    except ValueError as error:
        raise Failure(str(error)) from None
    source = source_named(options)
    try:
        made = made_by(recipes_of(options)[0], options)
        writer = MotionWriter(options.out, entities, source.header, replace=options.force, made_by=made)
    except RecordingError as error:
        raise Failure(f"{error}; --force replaces it" if "already" in error.what else str(error)) from None
    recording = _run(options, source, writer.add)
    _ended(recording, f"{len(writer.write())} files written to {printable(str(options.out / entities.folder))}")
    return validate_dataset(options.out) if options.validate else 0


def _run(
    options: Namespace, source: Source, add: Callable[[Iterable[PosedSample], Iterable[Event]], None]
) -> Recording:
    """Run the recording up to its first fault, and pass samples and events to `add`; return it."""
    from ..recording.posed import PosedSession
    from ..session import Session

    (recipe,), drivers = recipes_of(options), drivers_of(options)
    check_pressure(recipe, source, drivers)
    recording = Recording(source)
    posed = PosedSession(Session(recipe, calibration=calibration_of(options), poses=True, profiles=drivers))
    for item in chain(recording, [None]):
        events = posed.session.finish() if item is None else posed.session.feed(item)
        add(posed.take(), events)
    return recording


def validate_dataset(root: Path) -> int:
    """Run the official validator over the whole dataset and print what it found; return 1 for an error, else 0."""
    words = [sys.executable, "-c", BIDS_PROGRAM, str(root), "--json"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    try:
        report: dict[str, Any] = json.loads(done.stdout)
        issues = report["issues"]["issues"]
    except (ValueError, KeyError, TypeError):
        last = (done.stderr.strip().splitlines() or ["no output"])[-1]
        raise Failure(f"the validator of BIDS failed: {printable(last)}") from None
    errors = [issue for issue in issues if issue.get("severity") == "error"]
    for issue in errors[:MAX_ISSUES]:
        print(
            f"  {issue.get('code')} {issue.get('subCode') or ''} {printable(str(issue.get('location') or ''))}".rstrip()
        )
    print(f"the validator of BIDS: {len(errors)} errors, {len(issues) - len(errors)} warnings")
    return 1 if errors else 0


def validate_storage(path: Path, *, positions: bool) -> int:
    """Read a storage file with OpenSim and print what it found; return the exit status."""
    import opensim

    opensim.Logger.setLevelString("Off")
    table = (opensim.TimeSeriesTableVec3 if positions else opensim.TimeSeriesTableQuaternion)(str(path))
    labels = ", ".join(table.getColumnLabels())
    print(f"OpenSim {opensim.GetVersion()} reads {table.getNumRows()} rows of {labels}")
    return 0


add_convert = command(
    "convert",
    "Convert a log of Bluetooth (an Android phone's HCI snoop log or bug report, Apple's PacketLogger, btmon, .pcap, "
    ".pcapng) to a recording of packets, or either to MCAP, which opens in Foxglove; or any recording to a storage "
    "file of OpenSim or, with --subject, into a Motion-BIDS dataset. The name of OUT chooses the format: .jsonl, "
    ".mcap or .sto.",
    "solepath convert btsnoop_hci.log walk.jsonl --site F0:5E:00:00:00:01=left_foot",
    table_options("IN"),
    option(
        "out",
        metavar="OUT",
        type=Path,
        help="what to write: FILE.jsonl, FILE.mcap, FILE.sto, or with --subject the folder of a dataset",
    ),
    option(
        "--site",
        metavar="ADDRESS=SITE",
        dest="sites",
        type=_site,
        action="append",
        default=[],
        help="where a device of the log was worn: " + ", ".join(site.value for site in Site) + " (insoles say "
        "themselves of which foot they are, unless this says otherwise); may be given again",
    ),
    option(
        "--handle",
        metavar="[ADDRESS/]HANDLE=CHANNEL",
        dest="handles",
        type=_handle,
        action="append",
        default=[],
        help="what an attribute is whose discovery is not in the log, for instance 0x002b=cc2650/movement; may be "
        "given again",
    ),
    option("--positions", action="store_true", help="of the sensors instead of their attitudes, for OpenSim (.sto)"),
    option("--subject", metavar="LABEL", help="who walked: writes into the Motion-BIDS dataset in the folder OUT"),
    option("--session", metavar="LABEL", default="", help="the visit, in the dataset"),
    option("--task", metavar="LABEL", default="walk", help="what was done, in the dataset (default: walk)"),
    option(
        "--run",
        metavar="N",
        dest="repetition",
        type=parse_whole_number,
        default=0,
        help="the repetition, in the dataset",
    ),
    option(
        "--validate",
        action="store_true",
        help="have the official validator of BIDS, or OpenSim, read the result (extras bids and opensim)",
    ),
    recipe_option(),
    add_heading,
    add_calibration,
    add_force,
    run=run,
)
