"""For an app with asyncio: two sensors over Bluetooth.

    python examples/bluetooth.py LEFT RIGHT   addresses of `solepath scan`
    python examples/bluetooth.py              two emulated insoles, through virtual Bluetooth controllers

You see connections and strides. The emulated wearer walks 4 m.
"""

import asyncio
import sys

from solepath import Connected, Disconnected, LinkTrouble, Session, Site, StrideTaken
from solepath.ble import NATIVE, Backend, BluetoothError, DeviceConfig, Devices
from solepath.emulate import Bench, Route
from solepath.emulate.controllers import virtual_link


async def listen(left: str, right: str, backend: Backend = NATIVE, seconds: float = 600.0) -> None:
    session = Session()
    configs = [DeviceConfig(Site.LEFT_FOOT, left), DeviceConfig(Site.RIGHT_FOOT, right)]
    end = asyncio.get_running_loop().time() + seconds
    async with Devices(configs, backend=backend) as devices:
        async for packet in devices:
            for event in session.feed(packet):
                match event:
                    case StrideTaken(foot=foot, length=length):
                        print(f"{foot.value} stride of {length:.2f} m")
                    case Connected(site=site, name=name):
                        print(f"{site.value}: connected to {name}")
                    case Disconnected(site=site):
                        print(f"{site.value}: lost, and sought")
                    case LinkTrouble(site=site, what=what):
                        print(f"{site.value}: {what}")
            if packet.t > end:
                break


async def emulated() -> None:
    bench = Bench(Route().stand(2.0).walk(4.0, speed=1.3).stop(1.0))
    bench.prepare()
    left, right = (peripheral.address for peripheral in bench.peripherals)
    async with virtual_link(bench.peripherals) as backend:
        bench.walk_from(asyncio.get_running_loop().time() + 1.0)
        await listen(left, right, backend, 8.0)


try:
    asyncio.run(listen(*sys.argv[1:]) if len(sys.argv) == 3 else emulated())
except BluetoothError as error:
    sys.exit(str(error))
