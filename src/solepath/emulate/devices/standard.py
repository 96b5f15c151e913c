"""What every device has: attributes as its profile lists them, Device Information and a battery that empties."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil, floor, inf

from attrs import frozen

from ...link.profile import Profile
from ...wire.device import build_battery, build_firmware
from .attributes import Characteristic, Service, standard

READ = frozenset({"read"})
NOTIFY = frozenset({"notify"})
WRITE = frozenset({"write"})

DRAIN = 600.0
"""s in which the battery loses one percent."""

_INFORMATION = {"manufacturer": 0x2A29, "model": 0x2A24, "hardware": 0x2A27, "software": 0x2A28}
_DEVICE_INFORMATION = 0x180A


def services(
    profile: Profile,
    properties: Mapping[str, frozenset[str]],
    more: Sequence[tuple[str, Characteristic]] = (),
    information: Sequence[str] = (),
) -> tuple[Service, ...]:
    """The services of a device: the profile's channels with their `properties`, `more` (service, characteristic), and
    what else Device Information tells (of manufacturer, model, hardware and software)."""
    table = [(c.service, Characteristic(c.characteristic, c.name, properties[c.name])) for c in profile.channels]
    table += more
    for name in information:
        what = Characteristic(standard(_INFORMATION[name]), f"device/{name}", READ)
        table.append((standard(_DEVICE_INFORMATION), what))
    found: dict[str, list[Characteristic]] = {}
    for service, characteristic in table:
        found.setdefault(service, []).append(characteristic)
    return tuple(Service(uuid, tuple(characteristics)) for uuid, characteristics in found.items())


def information(firmware: str, **more: str) -> dict[str, bytes]:
    """What Device Information says, by channel."""
    said = {"device/firmware": build_firmware(firmware)}
    return said | {f"device/{name}": text.encode() for name, text in more.items()}


@frozen
class Battery:
    """A Source: the level changes every `DRAIN` s of the walk, from `percent` at its beginning."""

    percent: int

    def level(self, t: float) -> bytes:
        return build_battery(max(0, self.percent - max(0, floor(t / DRAIN))))

    def after(self, t: float) -> int:
        return max(1, ceil(t / DRAIN))

    def due(self, number: int) -> float:
        return number * DRAIN if number <= self.percent else inf

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (self.level(number * DRAIN),)
