"""Reading of a btsnoop log as a recording of packets, one for each value of a known device's channel.

The log is read twice. The first reading identifies devices and channels, which may be possible only at the end of the
log. The second reading makes the packets, so that an hour of a phone's log need not fit into memory."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

from attrs import define

from ...link.driver import Driver
from ...types import Packet, Site
from ...wire.receiver import ConnectionFrame, build_connected
from ..errors import RecordingError, Report, printable, warn
from ..unpacking import size_of
from .devices import Handles, LoggedDevice, explain_unused, known_devices
from .records import reject_pipe
from .values import CUT_SHORT, ValueListener

MAX_NAMED = 4
"""Largest number of unknown attributes of a device that are named."""
WHOLE_PACKETS = "capture whole packets: the snoop log of an Android phone Enabled, not Filtered; `tcpdump -s 0`"
"""What to do when a capture has only the start of its packets."""


@define
class BtsnoopLog:
    """The usable content of a btsnoop log; iterating gives its packets in order of arrival.

    Damage raises RecordingError after all packets before it."""

    path: Path
    devices: dict[str, LoggedDevice]
    started_at: int
    """Time of the first record, us since 1970, at which the packets' `t` is 0."""
    total: int
    """Size of the log, bytes; 0 of one that is compressed."""
    done: int = 0
    """Number of bytes that were iterated."""

    @property
    def header(self) -> dict[str, Any]:
        """Header for a recording, with the start time if the logger's clock had a possible one."""
        try:
            moment = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(microseconds=self.started_at)
        except OverflowError:
            return {"source": "btsnoop"}
        return {"began": moment.isoformat().replace("+00:00", "Z"), "began_t": 0.0, "source": "btsnoop"}

    def __iter__(self) -> Iterator[Packet]:
        listener = ValueListener(self.path, lambda _: None)  # flaws were reported by open_btsnoop
        for item in listener.listen(partial(setattr, self, "done")):
            device = self.devices.get(item.connection.peer)
            if device is None or device.site is None:
                continue
            # the log does not show how the host found the device, so name and signal are unknown
            channel: str | None = "receiver/connected" if item.connected else "receiver/disconnected"
            data = build_connected(ConnectionFrame("", None)) if item.connected else b""
            if item.value is not None:
                attribute, data = device.attributes.get(item.value.handle), item.value.value
                channel = None if attribute is None else attribute.channels.get(item.value.operation)
            if channel is not None:
                yield Packet((item.t - self.started_at) / 1e6, device.site, channel, data, device.address)


def open_btsnoop(
    path: Path | str,
    *,
    sites: Mapping[str, Site] | None = None,
    handles: Handles | None = None,
    profiles: Iterable[Driver] = (),
    report: Report = warn,
) -> BtsnoopLog:
    """Return the usable content of a capture: btsnoop, PacketLogger, pcap or pcapng, or an Android bug report with one.

    `sites`: site of each device, by address; an insole reports its foot itself. `handles`: channels of attributes whose
    discovery is not in the log, because the host knew them before. `profiles`: an app's own devices, as for Session.
    `report` receives one sentence about each thing that is left out. RecordingError for a file that is no capture, that
    has no packets of a device whose site is known, or that does not have what `sites` and `handles` name.
    ValueError for a channel name that no device has."""
    path, known = Path(path), known_devices(profiles)
    reject_pipe(path)
    handles = {(device.upper(), handle): channel for (device, handle), channel in (handles or {}).items()}
    for channel in handles.values():
        if channel not in known.channel_names:
            raise ValueError(f"no device has a channel {channel!r}")
    listener, started_at = ValueListener(path, report), None
    damage: RecordingError | None = None
    try:
        for item in listener.listen():
            started_at = item.t if started_at is None else started_at
            if item.value is not None:
                attribute = listener.devices[item.connection.peer].attribute(item.value.handle, listener.flaws)
                attribute.add_value(item.value.operation, item.value.value)
    except RecordingError as error:
        damage = error  # iterating the result raises it again, after the packets before it
    devices, site_by_address = listener.devices, {address.upper(): site for address, site in (sites or {}).items()}
    unused = dict(handles)
    for device in devices.values():
        device.site = site_by_address.get(device.address.upper())
        for hint in device.identify(known, handles):
            unused.pop(hint, None)
    cut_short = listener.flaws.pop(CUT_SHORT, 0)
    omissions = [f"{CUT_SHORT}: {cut_short}"] if cut_short else []
    omissions += _describe_omissions(list(devices.values()))
    omissions += [f"{what}: {count}" for what, count in listener.flaws.items()]
    usable = any(device.site is not None and device.count for device in devices.values())
    if damage is not None and not usable:
        raise damage
    for hint, channel in unused.items():
        raise RecordingError(path, explain_unused(hint, channel, devices.values()))
    if not usable and cut_short:
        raise RecordingError(path, f"holds nothing that can be used; {omissions[0]}", repair=WHOLE_PACKETS)
    if not usable:
        raise RecordingError(path, "; ".join(["holds no packets of a device whose place is known", *omissions[:5]]))
    for address in site_by_address:
        if address not in map(str.upper, devices):
            there = ", ".join([device.address for device in devices.values() if device.count])
            raise RecordingError(path, f"holds no device {address} that could be used; there is {there}")
    for sentence in omissions:
        report(f"{printable(str(path))}: {sentence}")
    return BtsnoopLog(path, devices, started_at or 0, size_of(path))


def _describe_omissions(devices: Sequence[LoggedDevice]) -> Iterator[str]:
    """Yield one sentence about each thing that gives no packets, or packets that a session rejects."""
    others = 0
    for device in devices:
        valued = {handle: one for handle, one in device.attributes.items() if one.has_values}
        unknown = {handle: one for handle, one in valued.items() if one.count and not one.channels and not one.uuid}
        if unknown:
            values = _count_text(sum([one.count for one in unknown.values()]), "value")
            texts = [
                f"{handle:#06x} ({', '.join(map(str, sorted(one.lengths)[:3]))} bytes)"
                for handle, one in unknown.items()
            ]
            which = ", ".join(texts[:MAX_NAMED]) + (" ..." if len(texts) > MAX_NAMED else "")
            yield f"{values} of {device.address} left out: no discovery says what is {which}"
        if device.site is None and device.count:
            values = _count_text(device.count, "value")
            how = f"--site {device.address}=left_foot"
            yield f"{values} of {device.address}, {device.noun}, left out: nobody says where it was worn: {how}"
        others += any(one.uuid for one in valued.values()) and not any(one.channels for one in valued.values())
    if others:
        yield f"{_count_text(others, 'other device')} left out"
    for site in Site:
        there = [device.address for device in devices if device.site is site and device.count]
        if len(there) > 1:
            yield f"{' and '.join(there)} are at the {site.value}; a session listens to the first alone"


def _count_text(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"
