"""Loads devices of one's own (--driver FILE.py), and says which packets of a recording no device explains."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import redirect_stdout
from pathlib import Path
from runpy import run_path
from traceback import extract_tb
from typing import TYPE_CHECKING, Any

from attrs import define, field

from ...events import Event, PacketRejected, Rejection
from ...link.kinds import BUILT_IN_KINDS, DeviceKinds, make_kinds
from ...recording import printable
from ...types import Packet, Sample, Site
from .failure import Failure
from .os_errors import file_error_text

if TYPE_CHECKING:
    from ...link.driver import Driver

LARGE_SHARE = 0.1
"""Share of a site's packets from which on those that are not used are named; chosen by hand.

The radio of `solepath demo` (3 in 100 lost, 5 in 1000 damaged) rejects 0.6 in 100, duplicates not counted, and one that
damages 5 in 100 rejects 5. A tenth is twice that: a wrong layout, a small MTU or a full queue. Only where an insole's
frames come in fragments can a radio alone reach it, since each lost or damaged fragment costs a frame: 13 in 100 at an
MTU of 104 with 10 in 100 lost and 5 damaged. The sentence then names the fragments."""
MAX_NAMED = 3
"""Largest number of channels that a sentence names; chosen by hand."""
MAX_CHANNELS = 100
"""Largest number of unknown channels of a site that are remembered by name; chosen by hand."""
NO_DEVICE = ("device", "receiver")
"""Prefixes of channels that belong to no kind of device."""
_RUN: set[str] = set()
"""Files of devices of one's own that were run."""
CAUSES = {
    Rejection.TRUNCATED: "shorter than the layout of its channel: the layout (of a driver, its Struct) does not fit "
    "these bytes, they are cut on the way (by a small MTU), or a fragment of an insole's frame got lost or came too "
    "late",
    Rejection.OVERSIZED: "longer than the layout of its channel: the layout (of a driver, its Struct) does not fit "
    "these bytes, or two packets are joined",
    Rejection.CHECKSUM: "the checksum does not fit the bytes: they are damaged on the way, or of another firmware",
    Rejection.MALFORMED: "a field holds what its layout does not allow: the layout does not fit these bytes, or they "
    "are damaged on the way",
    Rejection.UNKNOWN_CHANNEL: "no known device, or not the one at this site, has this channel: check its name, and "
    "whether its driver is there",
    Rejection.WRONG_SITE: "of another site than the one it came for: check which device is where",
    Rejection.WRONG_LAYOUT: "another number of pressure cells than the insole's layout has: check its firmware",
    Rejection.DUPLICATE: "it came twice: nothing is missing, but look for what sends twice",
    Rejection.LATE: "an older one came after a newer: check your queue, or what else changes the order",
    Rejection.NOT_FINITE: "a value or a time is infinite or no number: check what computes it",
    Rejection.ABSURD: "a value or a time that no sensor gives: check its unit and layout",
    Rejection.TIME_BACKWARDS: "its time is earlier than the one before: check the order, and that there is one clock",
    Rejection.WRONG_DEVICE: "another device sends for this site: check which is where (Session.bind lets it)",
}
"""The likely causes, in words, of each reason for which a packet or a sample is rejected (docs/events.md)."""
ADVICE = "a device of your own needs its driver: --driver FILE.py (docs/device.md)"


def add_own_devices(command: ArgumentParser) -> None:
    """Add --driver to a command."""
    command.add_argument(
        "--driver",
        metavar="FILE.py",
        dest="driver_files",
        type=Path,
        action="append",
        default=[],
        help="a device of your own: a Python program whose variables hold its Driver (docs/device.md); it is"
        " run; may be given again",
    )


def drivers_of(options: Namespace) -> tuple[Driver, ...]:
    """Return the drivers of all files of --driver; raise Failure for a file without one, or that cannot be run."""
    drivers: list[Driver] = []
    for path in getattr(options, "driver_files", []):
        drivers += load_drivers(path)
        try:
            make_kinds(drivers)
        except ValueError as error:
            raise Failure(f"--driver {path}: {error}") from None
    return tuple(drivers)


def load_drivers(path: Path) -> list[Driver]:
    """Run a Python file and return each Driver that a variable of it holds, except the built-in ones.

    What the file prints goes to stderr. Failure is raised for a file that raises, or that has no driver."""
    from ...link.catalogue import DECLARED
    from ...link.driver import Driver

    file = str(path.absolute())  # as Python names the file in errors
    if path.suffix != ".py":
        raise Failure(f"--driver {path}: is no Python file (.py)")
    _RUN.add(file)
    values, fault = dict[str, Any](), ""
    try:
        with redirect_stdout(sys.stderr):
            values = run_path(file)
    except (Exception, SystemExit) as error:
        fault = f"{path}: {_describe(error, file)}"
        if isinstance(error, OSError) and error.filename == file:
            fault = file_error_text(error, path)
    if fault:  # raised here, so that no error of the system in the file takes the place of this sentence
        raise Failure(f"--driver {fault}")
    found = {id(value): value for value in values.values() if isinstance(value, Driver)}
    drivers = [driver for driver in found.values() if not any(driver is one for one in DECLARED)]
    if not drivers:
        raise Failure(f"--driver {path}: no variable of it holds a Driver (docs/device.md)")
    return drivers


def own_fault(error: BaseException) -> str | None:
    """Return file, line and text of an error that a function of a device of one's own raised; None for any other."""
    files = _RUN.intersection(frame.filename for frame in extract_tb(error.__traceback__))
    return next((f"--driver {printable(Path(file).name)}: {_describe(error, file)}" for file in files), None)


def _describe(error: BaseException, file: str) -> str:
    """Return the line of the file that led to the error, type and text, and the place where other code raised it."""
    frames = [(frame.filename, frame.lineno) for frame in extract_tb(error.__traceback__)]
    text = str(error)
    if isinstance(error, SyntaxError):
        frames, text = [*frames, (error.filename or "", error.lineno)], error.msg
    lines = [number for name, number in frames if name == file]
    where = f"line {lines[-1]}: " if lines else ""
    raised = f" (raised at {frames[-1][0]}:{frames[-1][1]})" if lines and frames[-1][0] != file else ""
    return f"{where}{type(error).__name__}{f': {text}' if text else ''}{raised}"


@define
class UnusedPackets:
    """The packets of each site, and which of them no device explains or cannot be used, in bounded memory."""

    kinds: DeviceKinds = BUILT_IN_KINDS
    count: Counter[Site] = field(factory=Counter)
    """Number of packets of devices, those of the receiver left out."""
    unknown: dict[Site, Counter[str]] = field(factory=dict)
    """Number of packets of channels that no device has, by site and channel."""
    rejected: dict[Site, Counter[Rejection]] = field(factory=dict)
    """Number of packets that were rejected for another reason, by site and reason."""
    has_used: bool = False
    """Flag: a packet of a stream, which holds samples, was used."""

    def take(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """Add an item that the session was fed, and the events that it returned."""
        if not isinstance(item, Packet) or item.channel.partition("/")[0] in NO_DEVICE:
            return
        site, kind = item.site, self.kinds.get(item.channel.partition("/")[0])
        self.count[site] += 1
        is_known = kind is not None and item.channel in kind.profile.channel_by_name
        reasons = [event.reason for event in events if isinstance(event, PacketRejected)]
        for reason in reasons:
            if reason is Rejection.UNKNOWN_CHANNEL and not is_known:
                channels = self.unknown.setdefault(site, Counter())
                channels[item.channel if item.channel in channels or len(channels) < MAX_CHANNELS else ""] += 1
            else:
                self.rejected.setdefault(site, Counter())[reason] += 1
        self.has_used |= not reasons and kind is not None and item.channel in kind.profile.streams

    def sentences(self) -> list[str]:
        """Return a sentence for each site of which no packet or many packets were not used, with the likely cause."""
        return [text for site in Site if site in self.count for text in self._sentences(site)]

    def _sentences(self, site: Site) -> Iterable[str]:
        count, unknown = self.count[site], self.unknown.get(site, Counter())
        total, others = unknown.total(), self.rejected.get(site, Counter())
        missing = others.total() - others[Rejection.DUPLICATE]  # whose first copy was used
        if total > LARGE_SHARE * count:
            names = [printable(name, 80) for name, _ in unknown.most_common(MAX_NAMED) if name]
            more = " and others" if len(unknown) > len(names) else ""
            yield (
                f"{site.words}: {total} of {count} packets are of a channel that no known device has "
                f"({', '.join(names)}{more}): {ADVICE}"
            )
        if missing > LARGE_SHARE * count:
            reasons = ", ".join(sorted(f"{reason.value} {number}" for reason, number in others.items()))
            share = f"none of its {count} packets" if missing >= count else f"only {count - missing} of {count} packets"
            chief = max(others, key=lambda one: others[one] * (one is not Rejection.DUPLICATE))
            yield f"{site.words}: {share} can be used ({reasons}); {chief.value} means {CAUSES[chief]}"

    @property
    def is_all(self) -> bool:
        """True if packets were not used, and none that holds samples was used."""
        return bool(self.unknown or self.rejected) and not self.has_used
