"""A btsnoop log as a recording of packets: every value of a known device's channel, at the site of the device.

The log is read twice: once to identify devices and channels, which may be possible only late in the log or not at all,
and once for the packets, so that an hour of a phone's log need not fit into memory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

from attrs import define

from ...types import Packet, Site
from ...wire.receiver import ConnectionFrame, build_connected
from ..errors import RecordingError, Report, printable, warn
from .att import AttOperation
from .devices import CHANNELS, Handles, LoggedDevice, assign_site, explain_unused, name_attributes, with_article
from .evidence import ValueEvidence
from .hci import LinkChange
from .records import reject_pipe
from .values import Value, ValueListener


@define
class BtsnoopLog:
    """The usable content of a btsnoop log. Iterating gives its packets in order of arrival.

    `started_at`: us since 1970 of the first record, which is `t` = 0 s of the packets. `total`, `done`: bytes.
    Iterating raises RecordingError where the log is damaged, after everything before that."""

    path: Path
    devices: dict[str, LoggedDevice]
    started_at: int
    total: int
    done: int = 0

    @property
    def header(self) -> dict[str, Any]:
        """Header for a recording: the time of day of its start, where the logger's clock had it."""
        try:
            moment = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(microseconds=self.started_at)
        except OverflowError:
            return {"source": "btsnoop"}
        return {"began": moment.isoformat().replace("+00:00", "Z"), "began_t": 0.0, "source": "btsnoop"}

    def __iter__(self) -> Iterator[Packet]:
        listener = ValueListener(self.path, lambda _: None)  # flaws were reported by open_btsnoop
        for item in listener.listen(partial(setattr, self, "done")):
            match item:
                case Value():
                    device, data = self.devices.get(item.device), item.att_value.value
                    channel = (
                        None
                        if device is None
                        else device.channels.get((item.att_value.handle, item.att_value.operation))
                    )
                case LinkChange():
                    device = self.devices.get(item.link.peer)
                    # the log does not show how the host found the device, so there is neither name nor signal
                    channel = "receiver/connected" if item.connected else "receiver/disconnected"
                    data = build_connected(ConnectionFrame("", None)) if item.connected else b""
            if device is not None and device.site is not None and channel is not None:
                yield Packet((item.t - self.started_at) / 1e6, device.site, channel, data, device.address)


def open_btsnoop(
    path: Path | str, *, sites: Mapping[str, Site] | None = None, handles: Handles | None = None, report: Report = warn
) -> BtsnoopLog:
    """Return the usable content of a btsnoop log.

    `sites`: site of each device, by address; insoles report their foot themselves. `handles`: channels of attributes
    whose discovery the log does not hold, because the host knew them from earlier. `report` gets one sentence about
    each thing that is left out. RecordingError for a file that is no btsnoop log, or has no packets of a device whose
    site is known, or not what `sites` and `handles` name; ValueError for a channel that no device has."""
    path = Path(path)
    reject_pipe(path)
    handles = {(device.upper(), handle): channel for (device, handle), channel in (handles or {}).items()}
    for channel in handles.values():
        if channel not in CHANNELS:
            raise ValueError(f"no device has a channel {channel!r}")
    places = {device.upper(): site for device, site in (sites or {}).items()}
    listener, devices, started_at = ValueListener(path, report), dict[str, LoggedDevice](), None
    damage: RecordingError | None = None
    try:
        for item in listener.listen():
            started_at = item.t if started_at is None else started_at
            if isinstance(item, Value):
                device = devices.setdefault(item.device, LoggedDevice(item.device))
                device.seen.setdefault(item.att_value.handle, ValueEvidence()).add_value(
                    item.att_value.operation, item.att_value.value
                )
    except RecordingError as error:
        damage = error  # the iteration raises it again, after the packets before it
    used: set[tuple[str, int]] = set()
    for device in devices.values():
        used |= name_attributes(device, listener.types.get(device.address, {}), handles)
        assign_site(device, places)
    left_out = list(_describe_left_out(list(devices.values()), listener.types))
    left_out += [f"{what}: {count}" for what, count in listener.flaws.items()]
    usable = any(device.site is not None and device.count for device in devices.values())
    if damage is not None and not usable:
        raise damage
    for hint in [hint for hint in handles if hint not in used]:
        raise RecordingError(path, explain_unused(hint, handles[hint], devices, listener.types))
    if not usable:
        raise RecordingError(path, "; ".join(["holds no packets of a device whose place is known", *left_out[:5]]))
    unknown = [address for address in sites or {} if address.upper() not in map(str.upper, devices)]
    if unknown:
        there = ", ".join(device.address for device in devices.values() if device.channels)
        raise RecordingError(path, f"holds no device {unknown[0]} that could be used; there is {there}")
    for sentence in left_out:
        report(f"{printable(str(path))}: {sentence}")
    return BtsnoopLog(path, devices, started_at or 0, path.stat().st_size)


def _describe_left_out(devices: list[LoggedDevice], types: Mapping[str, Mapping[int, str]]) -> Iterator[str]:
    """Yield one sentence about each thing that does not become packets, or that a session will not take."""
    others = 0
    for device in devices:
        known = types.get(device.address, {})
        address = device.address or "the host itself"
        nameless = {
            handle: evidence
            for handle, evidence in device.seen.items()
            if evidence.count and (handle, AttOperation.NOTIFIED) not in device.channels and handle not in known
        }
        if nameless:
            count = sum(evidence.count for evidence in nameless.values())
            handles = _describe_handles(nameless)
            yield f"{_count_text(count, 'value')} of {address} left out: no discovery says what is {handles}"
        if device.site is None and device.count:
            kind = "a device" if device.profile is None else with_article(device.profile.name)
            yield f"{_count_text(device.count, 'value')} of {address}, {kind}, left out: nobody says where it was worn"
        others += not device.channels and any(handle in known for handle in device.seen)
    if others:
        yield f"{_count_text(others, 'other device')} left out"
    for site in Site:
        there = [device.address for device in devices if device.site is site and device.count]
        if len(there) > 1:
            yield f"{' and '.join(there)} are at the {site.value}; a session listens to the first alone"


def _count_text(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _describe_handles(attributes: Mapping[int, ValueEvidence]) -> str:
    """Return the handles with the lengths of their values, a few of them."""
    texts = [
        f"{handle:#06x} ({', '.join(map(str, sorted(evidence.lengths)[:3]))} bytes)"
        for handle, evidence in list(attributes.items())[:4]
    ]
    return ", ".join(texts) + (" ..." if len(attributes) > len(texts) else "")
