"""`solepath convert IN OUT`: converts a btsnoop log to a recording, and recordings to MCAP, OpenSim or Motion-BIDS."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ...recording import PacketWriter, RecordingError, printable
from ...recording.packets import open_packets
from ...types import Packet, Site
from ...types.extras import install_hint
from ..common.closest import unknown
from ..common.failure import Failure, note
from ..common.files import RECORDING as RECORDING_KIND
from ..common.files import OutputFile, add_force, check_outputs, replacements
from ..common.os_errors import file_error_text
from ..common.own_devices import add_own_devices, drivers_of
from ..common.tables import add_tables
from .exchange import STORAGE, add_exchange, convert_computed

if TYPE_CHECKING:
    from ...link.driver import Driver
    from ...recording.btsnoop import BtsnoopLog
    from ...recording.mcap import McapWriter

RECORDING, MCAP = ".jsonl", ".mcap"
TARGETS = f"a recording is converted to {MCAP} or {STORAGE} or, with --subject, into a Motion-BIDS dataset"


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "convert",
        help="import a phone's btsnoop log; export to MCAP, OpenSim or Motion-BIDS",
        description="Convert a btsnoop log (an Android phone's HCI snoop log, btmon) to a recording of packets, or "
        "either to MCAP, which opens in Foxglove; or any recording to a storage file of OpenSim or, with --subject, "
        "into a Motion-BIDS dataset. The name of OUT chooses the format: .jsonl, .mcap or .sto.",
        epilog="example: solepath convert btsnoop_hci.log walk.jsonl --site F0:5E:00:00:00:01=left_foot",
    )
    add_tables(command, "IN")
    add_own_devices(command)
    command.add_argument(
        "out",
        metavar="OUT",
        type=Path,
        help="what to write: FILE.jsonl, FILE.mcap, FILE.sto, or with --subject the folder of a dataset",
    )
    command.add_argument(
        "--site",
        metavar="ADDRESS=SITE",
        dest="sites",
        type=_site,
        action="append",
        default=[],
        help="where a device of the log was worn: " + ", ".join(site.value for site in Site) + " (insoles say "
        "themselves of which foot they are, unless this says otherwise); may be given again",
    )
    command.add_argument(
        "--handle",
        metavar="[ADDRESS/]HANDLE=CHANNEL",
        dest="handles",
        type=_handle,
        action="append",
        default=[],
        help="what an attribute is whose discovery is not in the log, for instance 0x002b=cc2650/movement; may be "
        "given again",
    )
    add_exchange(command)
    add_force(command)
    command.set_defaults(run=run)


def _site(text: str) -> tuple[str, Site]:
    address, equals, name = text.rpartition("=")
    try:
        if not equals:
            raise ValueError
        return address.upper(), Site(name)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not ADDRESS=SITE") from None


def _handle(text: str) -> tuple[tuple[str, int], str]:
    left, _, channel = text.partition("=")
    device, _, number = left.rpartition("/")
    try:
        handle = int(number, 0)
    except ValueError:
        handle = 0
    if not 0 < handle <= 0xFFFF or not channel:
        raise argparse.ArgumentTypeError(f"{text!r} is not [ADDRESS/]HANDLE=CHANNEL")
    return (device.upper(), handle), channel


_Key = TypeVar("_Key", str, tuple[str, int])
_Value = TypeVar("_Value")


def run(options: argparse.Namespace) -> int:
    """Convert the file; return the exit status."""
    from ...recording.btsnoop import is_btsnoop
    from ...recording.btsnoop.records import reject_pipe
    from ...show.tables.progress import progress_bar

    source, out = options.files[0], options.out
    if options.subject is not None or out.suffix.lower() == STORAGE:
        return convert_computed(options)
    drivers = drivers_of(options)
    open_writer = _writer_class(out, drivers)
    if len(options.files) > 1:
        raise Failure(f"{printable(str(out))}: is made of one log or recording, not of {len(options.files)}")
    output = OutputFile(out, RECORDING_KIND)
    check_outputs([output], [source], force=options.force)
    log: BtsnoopLog | None = None
    packets: Iterable[Packet]
    total = source.stat().st_size if source.is_file() else 0
    with progress_bar(printable(source.name), total) as show:
        if is_btsnoop(source):
            log = _open_log(options, drivers)
            packets, header = _with_progress(log, show), log.header
        elif options.sites or options.handles:
            raise Failure("--site and --handle are for btsnoop logs; a recording knows its sites and channels")
        elif out.suffix.lower() == RECORDING:
            reject_pipe(source)
            raise Failure(f"{printable(str(source))}: is no btsnoop log; {TARGETS}")
        else:
            opened = open_packets(source, report=note, progress=show)
            packets, header = opened.packets, opened.header
        count, damage = _write(packets, header, open_writer, output)
    for device in [] if log is None else log.devices.values():
        if device.site is not None and device.count:
            kind = "" if device.profile is None else f", {device.profile.name}"
            print(f"{printable(device.address)}  {device.site.value}{kind}: {device.count} notifications")
    print(f"{count} packets written to {printable(str(out))}")
    if damage is not None:
        raise damage
    return 0


def _open_log(options: argparse.Namespace, own: Iterable[Driver]) -> BtsnoopLog:
    from ...recording.btsnoop import open_btsnoop
    from ...recording.btsnoop.devices import known_devices

    sites, handles = _by_key("--site", options.sites), _by_key("--handle", options.handles)
    known = known_devices(own).channel_names
    for name in handles.values():
        if name not in known:
            raise Failure(unknown("channel", name, sorted(known)))
    return open_btsnoop(options.files[0], sites=sites, handles=handles, profiles=own, report=note)


def _by_key(option: str, pairs: Iterable[tuple[_Key, _Value]]) -> dict[_Key, _Value]:
    """Return the values of an option by their keys; raise Failure when a key is given twice."""
    values: dict[_Key, _Value] = {}
    for key, value in pairs:
        if key in values:
            name = key if isinstance(key, str) else f"{key[0]}/{key[1]:#06x}".removeprefix("/")
            raise Failure(f"{option} is given twice for {name}")
        values[key] = value
    return values


def _with_progress(log: BtsnoopLog, show: Callable[[int], None]) -> Iterator[Packet]:
    for packet in log:
        show(log.done)
        yield packet


OpenWriter = Callable[[Path, Mapping[str, Any]], "PacketWriter | McapWriter"]


def _writer_class(out: Path, own: Iterable[Driver]) -> OpenWriter:
    """Return what opens a writer of a file of this name; raise Failure when there is none."""
    suffix = out.suffix.lower()
    if suffix == RECORDING:
        return PacketWriter
    if suffix != MCAP:
        raise Failure(
            f"{printable(str(out))}: ends neither in {RECORDING} nor in {MCAP} nor in {STORAGE}, which says "
            "what to write; --subject writes a Motion-BIDS dataset"
        )
    try:
        from ...recording.mcap import McapWriter
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != "mcap":
            raise
        raise Failure(f"writing MCAP needs the package mcap: {install_hint('mcap')}") from None
    return partial(McapWriter, profiles=own)


def _write(
    packets: Iterable[Packet], header: Mapping[str, Any], open_writer: OpenWriter, output: OutputFile
) -> tuple[int, RecordingError | None]:
    """Write the packets to `output`; return their number and, if the source is damaged, the error that ended them.

    If the source is damaged before its first packet, or a packet cannot be written, it stays as it was."""
    damage: RecordingError | None = None
    with _replacement(output) as path:
        try:
            writer = open_writer(path, header)
            try:
                for packet in _until_damage(packets):
                    if isinstance(packet, RecordingError):
                        damage = packet
                        break
                    writer.write(packet)
            finally:
                writer.close()
        except RecordingError as error:
            cause = error.__cause__
            if isinstance(cause, OSError):
                raise Failure(file_error_text(cause, output.path)) from None
            raise Failure(f"{printable(str(output.path))}: {error.what}") from None
        if damage is not None and not writer.count:
            raise damage
    return writer.count, damage


def _until_damage(packets: Iterable[Packet]) -> Iterator[Packet | RecordingError]:
    """Yield the packets, then the error that stopped the reading, if any, so that it differs from errors of writing."""
    try:
        yield from packets
    except RecordingError as error:
        yield error


@contextmanager
def _replacement(output: OutputFile) -> Iterator[Path]:
    """Yield the path of a temporary file, which replaces `output` at the end, or is removed after an exception."""
    files = replacements([output])
    try:
        yield files.temporary_path(output.path, read_only=True)
        files.move_to_targets()
    except OSError as error:
        raise Failure(file_error_text(error, output.path)) from None
    finally:
        files.discard()
