"""A wearer and the virtual devices on the feet, as GATT peripherals."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ...types import SITE_OF_FOOT, Foot, Site
from ..routes.route import Route
from ..sensors.device import Device, foot_of
from ..sensors.insole_device import Insole
from ..sensors.sensortags import SensorTag
from ..wearers.gait import Wearer
from ..wearers.truth import Truth
from ..wearers.walker import Walker
from .faults import Fault
from .insole import InsolePeripheral
from .peripheral import Peripheral, Placement
from .tag import Tag


class Bench:
    """Virtual devices of a wearer on `route`; by default the insoles "solepath L" and "solepath R".

    Two SensorTags of one model have the same name, so only their addresses distinguish them. In the order of Site, the
    first site with a device has the address F0:5E:00:00:00:01, the next one :02. The walk starts at `started_at`, s, on
    the clock of the event loop. `mtu` is the largest ATT MTU of an insole, bytes. A Dot raises ValueError, as does any
    device above the ankle."""

    def __init__(
        self,
        route: Route,
        *,
        devices: Mapping[Site, Device] | None = None,
        wearer: Wearer | None = None,
        seed: int = 1,
        mtu: int = 247,
        started_at: float = 0.0,
        faults: Iterable[Fault] = (),
    ) -> None:
        if devices is None:
            devices = {SITE_OF_FOOT[foot]: Insole() for foot in Foot}
        self.walker = Walker(route, wearer, seed)
        self.devices = {site: devices[site] for site in Site if site in devices}
        script = tuple(faults)
        self.peripherals: tuple[Peripheral, ...] = tuple(
            _peripheral(
                device, self.walker, seed, Placement(site, f"F0:5E:00:00:00:{number:02X}", mtu, started_at, script)
            )
            for number, (site, device) in enumerate(self.devices.items(), 1)
        )

    def __getitem__(self, site: Site) -> Peripheral:
        return {peripheral.site: peripheral for peripheral in self.peripherals}[site]

    def walk_from(self, started_at: float) -> None:
        """Restart the walk at this time of the event loop, s."""
        for peripheral in self.peripherals:
            peripheral.walk_from(started_at)

    def prepare(self) -> None:
        """Compute the signals of all devices now, before a host has to wait for them."""
        for peripheral in self.peripherals:
            peripheral.prepare()

    def truth(self) -> Truth:
        """Return the ground truth of the walk; its times count from the start of the walk."""
        return self.walker.truth({foot_of(site): device.mounting for site, device in self.devices.items()})


def _peripheral(device: Device, walker: Walker, seed: int, placement: Placement) -> Peripheral:
    if isinstance(device, Insole):
        return InsolePeripheral(device, walker, seed, placement)
    if isinstance(device, SensorTag):
        return Tag(device, walker, seed, placement)
    raise ValueError(f"no peripheral is known for {type(device).__name__}")
