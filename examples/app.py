"""For the developer of an app: all that it does with sensors over Bluetooth, in one file.

    solepath emulate                                                      first terminal: two emulated insoles
    python examples/app.py walk "solepath L" "solepath R" tcp:127.0.0.1:9735      second terminal

Without the last word it uses this machine's Bluetooth, with names or addresses of your sensors (`solepath scan`). You
see connections, batteries and strides. Kill it, also with kill -9: started again, it goes on with the same walk.
"""

import asyncio
import json
import sys
from contextlib import AsyncExitStack, suppress
from itertools import islice
from pathlib import Path

import solepath as sp
from solepath.ble import NATIVE, BluetoothError, DeviceConfig, Devices, record
from solepath.emulate import reach
from solepath.recording import RecordingError, read_packets

SAVED_EVERY = 5.0
"""Time between two snapshots, s: so much is fed again after a kill."""


def show(event: sp.Event) -> None:
    match event:
        case sp.StrideTaken(foot=foot, number=number, length=length, final=True):
            print(f"{foot}: stride {number} of {length:.2f} m", flush=True)
        case sp.BatteryLevel(site=site, level=level):
            print(f"{site.value}: battery {100 * level:.0f} %", flush=True)
        case sp.Connected() | sp.Disconnected() | sp.StreamStale() | sp.StreamResumed():
            print(f"{event.site.value}: {type(event).__name__}", flush=True)
        case sp.LinkTrouble(site=site, what=what):
            print(f"{site.value}: {what}", flush=True)


def resume(folder: Path) -> sp.Session:
    """Return the session of the newest snapshot after the packets that were recorded since."""
    session, newest, used = sp.Session(), "", 0
    with suppress(OSError, ValueError, TypeError, KeyError):  # there is none yet, or no whole one: all is fed again
        saved = json.loads((folder / "state.json").read_text())
        session, newest, used = sp.Session.restore(saved["session"]), saved["recording"], saved["packets"]
    for path in sorted(one for one in folder.glob("walk-*.jsonl") if one.name >= newest):
        try:
            for packet in islice(read_packets(path), used if path.name == newest else 0, None):
                session.feed(packet)
        except RecordingError as error:  # an empty file, or one without a whole header: no packet is in it
            print(error, file=sys.stderr)
    return session


async def main(folder: Path, left: str, right: str, via: str = "") -> None:
    session, packets, saved_at = resume(folder), 0, 0.0
    recording = folder / f"walk-{len([*folder.glob('walk-*.jsonl')]) + 1:04}.jsonl"
    async with AsyncExitStack() as stack:
        backend = await stack.enter_async_context(reach(via)) if via else NATIVE
        configs = [DeviceConfig(sp.Site.LEFT_FOOT, left), DeviceConfig(sp.Site.RIGHT_FOOT, right)]
        devices = await stack.enter_async_context(Devices(configs, backend=backend))
        async for packet in record(devices, recording):  # also ticks while no sensor sends
            packets += 1
            for event in session.feed(packet):
                show(event)
            if packet.t - saved_at >= SAVED_EVERY:
                state = {"recording": recording.name, "packets": packets, "session": session.snapshot()}
                sp.write_whole(folder / "state.json", json.dumps(state))
                saved_at = packet.t


try:
    Path(sys.argv[1]).mkdir(exist_ok=True)
    asyncio.run(main(Path(sys.argv[1]), *sys.argv[2:]))
except (BluetoothError, KeyboardInterrupt) as error:
    sys.exit(str(error))
