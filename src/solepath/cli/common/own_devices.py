"""Loads devices of one's own (--driver FILE.py), and says which packets of a recording no device explains."""

from __future__ import annotations

import argparse
import os
import sys
import traceback
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import redirect_stdout
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import TYPE_CHECKING

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
"""Share of a site's packets from which on unknown channels are mentioned; chosen by hand."""
MAX_NAMED = 3
"""Largest number of channels that a sentence names; chosen by hand."""
MAX_CHANNELS = 100
"""Largest number of unknown channels of a site that are remembered by name; chosen by hand."""
NO_DEVICE = ("device", "receiver")
"""Prefixes of channels that belong to no kind of device."""
ADVICE = "a device of your own needs its driver: --driver FILE.py (docs/extending.md)"


def add_own_devices(command: argparse.ArgumentParser) -> None:
    """Add --driver to a command."""
    command.add_argument(
        "--driver",
        metavar="FILE.py",
        dest="driver_files",
        type=Path,
        action="append",
        default=[],
        help="a device of your own: a Python program whose variables hold its Driver (docs/extending.md); it is run;"
        " may be given again",
    )


def drivers_of(options: argparse.Namespace) -> tuple[Driver, ...]:
    """Return the drivers of all files of --driver; raise Failure for a file without one, or that cannot be run."""
    drivers: list[Driver] = []
    for path in getattr(options, "driver_files", []):
        drivers += load_drivers(path)
        try:
            make_kinds(drivers)
        except ValueError as error:
            raise Failure(f"--driver {printable(str(path))}: {error}") from None
    return tuple(drivers)


def load_drivers(path: Path) -> list[Driver]:
    """Run a Python file and return each Driver that a variable of it holds, except the built-in ones.

    What the file prints goes to stderr. Failure is raised for a file that raises, or that has no driver."""
    from ...link.catalogue import DECLARED
    from ...link.driver import Driver

    name = f"--driver {printable(str(path))}"
    spec = spec_from_file_location(f"solepath_device_{path.stem}", path) if path.suffix == ".py" else None
    if spec is None or spec.loader is None:
        raise Failure(f"{name}: is no Python file (.py)")
    module, fault = module_from_spec(spec), ""
    sys.modules[spec.name] = module
    try:
        with redirect_stdout(sys.stderr):
            spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        if isinstance(error, OSError) and error.filename == os.path.abspath(path):
            fault = file_error_text(error, path)
        else:
            fault = f"{printable(str(path))}: {_describe(error, path)}"
    if fault:  # raised here, so that no error of the system in the file takes the place of this sentence
        raise Failure(f"--driver {fault}")
    found = {id(value): value for value in vars(module).values() if isinstance(value, Driver)}
    drivers = [driver for driver in found.values() if not any(driver is one for one in DECLARED)]
    if not drivers:
        raise Failure(f"{name}: no variable of it holds a Driver (docs/extending.md)")
    return drivers


def _describe(error: BaseException, path: Path) -> str:
    """Return the line of the file at which the error was raised, its type and its text."""
    if isinstance(error, SyntaxError) and error.filename == os.path.abspath(path):
        line: int | None = error.lineno
    else:
        lines = [number for frame, number in traceback.walk_tb(error.__traceback__) if _is_of(frame, path)]
        line = lines[-1] if lines else None
    where = "" if line is None else f"line {line}: "
    text = error.msg if isinstance(error, SyntaxError) else str(error)
    return f"{where}{type(error).__name__}{f': {text}' if text else ''}"


def _is_of(frame: object, path: Path) -> bool:
    return getattr(getattr(frame, "f_code", None), "co_filename", "") == os.path.abspath(path)


@define
class UnusedPackets:
    """The packets of each site, and which of them no device explains or cannot be used, in bounded memory."""

    kinds: DeviceKinds = BUILT_IN_KINDS
    count: Counter[Site] = field(factory=Counter)
    """Number of packets of devices, those of the receiver left out."""
    unknown: dict[Site, Counter[str]] = field(factory=dict)
    """Number of packets of channels that no device has, by site and channel."""
    rejected: dict[Site, Counter[str]] = field(factory=dict)
    """Number of packets that were rejected for another reason, by site and reason."""

    def take(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """Add an item that the session was fed, and the events that it returned."""
        if not isinstance(item, Packet) or item.channel.partition("/")[0] in NO_DEVICE:
            return
        self.count[item.site] += 1
        for event in events:
            if isinstance(event, PacketRejected):
                if event.reason is Rejection.UNKNOWN_CHANNEL and not self._is_known(item.channel):
                    channels = self.unknown.setdefault(item.site, Counter())
                    channels[item.channel if item.channel in channels or len(channels) < MAX_CHANNELS else ""] += 1
                else:
                    self.rejected.setdefault(item.site, Counter())[event.reason.value] += 1

    def _is_known(self, channel: str) -> bool:
        kind = self.kinds.get(channel.partition("/")[0])
        return kind is not None and channel in kind.profile.channel_names

    def sentences(self) -> list[str]:
        """Return a sentence for each site with many packets of unknown channels, or of which no packet was used."""
        return [text for site in Site if site in self.count for text in self._sentences(site)]

    def _sentences(self, site: Site) -> Iterable[str]:
        count, unknown = self.count[site], self.unknown.get(site, Counter())
        total, others = unknown.total(), self.rejected.get(site, Counter())
        if total > LARGE_SHARE * count:
            names = [printable(name, 80) for name, _ in unknown.most_common(MAX_NAMED) if name]
            more = " and others" if len(unknown) > len(names) else ""
            yield (
                f"{site.words}: {total} of {count} packets are of a channel that no known device has "
                f"({', '.join(names)}{more}): {ADVICE}"
            )
        elif total + others.total() >= count:
            reasons = ", ".join(f"{reason} {number}" for reason, number in sorted(others.items()))
            yield f"{site.words}: none of its {count} packets can be used ({reasons})"

    @property
    def is_all(self) -> bool:
        """True if there were packets and none of any device was used."""
        unused = sum([one.total() for one in (*self.unknown.values(), *self.rejected.values())])
        return 0 < self.count.total() <= unused
