"""Reading of a btsnoop log as a recording of packets, one for each value of a known device's channel.

The log is read twice. The first reading identifies devices and channels, which may be possible only at the end of the
log. The second reading makes the packets, so that an hour of a phone's log need not fit into memory."""

from __future__ import annotations

from collections import Counter
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
from .att import AttOperation
from .devices import Handles, LoggedDevice, assign_site, explain_unused, known_devices, name_attributes
from .evidence import ValueEvidence
from .records import reject_pipe
from .values import LoggedValue, ValueListener

MOST_ATTRIBUTES = 10_000
"""Largest number of attributes of a log, of all devices, whose values are examined: twenty of each, chosen by hand."""


@define
class BtsnoopLog:
    """The usable content of a btsnoop log; iterating gives its packets in order of arrival.

    Damage raises RecordingError after all packets before it."""

    path: Path
    devices: dict[str, LoggedDevice]
    started_at: int
    """Time of the first record, us since 1970, at which the packets' `t` is 0."""
    total: int
    """Size of the log, bytes."""
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
            if isinstance(item, LoggedValue):
                device, data = self.devices.get(item.device), item.att_value.value
                key = item.att_value.handle, item.att_value.operation
                channel = None if device is None else device.channels.get(key)
            else:
                device = self.devices.get(item.connection.peer)
                # the log does not show how the host found the device, so name and signal are unknown
                channel = "receiver/connected" if item.connected else "receiver/disconnected"
                data = build_connected(ConnectionFrame("", None)) if item.connected else b""
            if device is not None and device.site is not None and channel is not None:
                yield Packet((item.t - self.started_at) / 1e6, device.site, channel, data, device.address)


def open_btsnoop(
    path: Path | str,
    *,
    sites: Mapping[str, Site] | None = None,
    handles: Handles | None = None,
    profiles: Iterable[Driver] = (),
    report: Report = warn,
) -> BtsnoopLog:
    """Return the usable content of a btsnoop log.

    `sites`: site of each device, by address; an insole reports its foot itself. `handles`: channels of attributes whose
    discovery is not in the log, because the host knew them before. `profiles`: an app's own devices, as for Session.
    `report` receives one sentence about each thing that is left out. RecordingError for a file that is no btsnoop log,
    that has no packets of a device whose site is known, or that does not have what `sites` and `handles` name.
    ValueError for a channel name that no device has."""
    path, known = Path(path), known_devices(profiles)
    reject_pipe(path)
    handles = {(device.upper(), handle): channel for (device, handle), channel in (handles or {}).items()}
    for channel in handles.values():
        if channel not in known.channel_names:
            raise ValueError(f"no device has a channel {channel!r}")
    listener, devices, started_at = ValueListener(path, report), dict[str, LoggedDevice](), None
    damage: RecordingError | None = None
    try:
        for item in listener.listen():
            started_at = item.t if started_at is None else started_at
            if isinstance(item, LoggedValue):
                _add_evidence(devices, item, listener.flaws)
    except RecordingError as error:
        damage = error  # iterating the result raises it again, after the packets before it
    used_handles: set[tuple[str, int]] = set()
    for device in devices.values():
        device.types = listener.types.get(device.address, {})
        used_handles |= name_attributes(device, known, handles)
        assign_site(device, known, {address.upper(): site for address, site in (sites or {}).items()})
    omissions = list(_describe_omissions(list(devices.values())))
    omissions += [f"{what}: {count}" for what, count in listener.flaws.items()]
    usable = any(device.site is not None and device.count for device in devices.values())
    if damage is not None and not usable:
        raise damage
    for hint in [hint for hint in handles if hint not in used_handles]:
        raise RecordingError(path, explain_unused(hint, handles[hint], devices))
    if not usable:
        raise RecordingError(path, "; ".join(["holds no packets of a device whose place is known", *omissions[:5]]))
    for address in sites or {}:
        if address.upper() not in map(str.upper, devices):
            there = ", ".join([device.address for device in devices.values() if device.channels])
            raise RecordingError(path, f"holds no device {address} that could be used; there is {there}")
    for sentence in omissions:
        report(f"{printable(str(path))}: {sentence}")
    return BtsnoopLog(path, devices, started_at or 0, path.stat().st_size)


def _add_evidence(devices: dict[str, LoggedDevice], value: LoggedValue, flaws: Counter[str]) -> None:
    """Add a value to what is known of its attribute, if it is one of the first MOST_ATTRIBUTES."""
    device = devices.setdefault(value.device, LoggedDevice(value.device))
    handle = value.att_value.handle
    if handle not in device.evidence_by_handle:
        if sum([len(one.evidence_by_handle) for one in devices.values()]) >= MOST_ATTRIBUTES:
            flaws[f"values of more than {MOST_ATTRIBUTES:,} attributes, left out"] += 1
            return
        device.evidence_by_handle[handle] = ValueEvidence()
    device.evidence_by_handle[handle].add_value(value.att_value.operation, value.att_value.value)


def _describe_omissions(devices: Sequence[LoggedDevice]) -> Iterator[str]:
    """Yield one sentence about each thing that gives no packets, or packets that a session rejects."""
    others = 0
    for device in devices:
        address = device.address or "the host itself"
        unnamed = {
            handle: one
            for handle, one in device.evidence_by_handle.items()
            if one.count and (handle, AttOperation.NOTIFIED) not in device.channels and handle not in device.types
        }
        if unnamed:
            values = _count_text(sum([one.count for one in unnamed.values()]), "value")
            yield f"{values} of {address} left out: no discovery says what is {_describe_handles(unnamed)}"
        if device.site is None and device.count:
            values = _count_text(device.count, "value")
            yield f"{values} of {address}, {device.noun}, left out: nobody says where it was worn"
        others += not device.channels and any(handle in device.types for handle in device.evidence_by_handle)
    if others:
        yield f"{_count_text(others, 'other device')} left out"
    for site in Site:
        there = [device.address for device in devices if device.site is site and device.count]
        if len(there) > 1:
            yield f"{' and '.join(there)} are at the {site.value}; a session listens to the first alone"


def _count_text(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _describe_handles(attributes: Mapping[int, ValueEvidence]) -> str:
    """Return a text with the first four handles and the lengths of their values."""
    texts = [
        f"{handle:#06x} ({', '.join(map(str, sorted(evidence.lengths)[:3]))} bytes)"
        for handle, evidence in list(attributes.items())[:4]
    ]
    return ", ".join(texts) + (" ..." if len(attributes) > len(texts) else "")
