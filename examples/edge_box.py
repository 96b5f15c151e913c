"""A box without a screen: two insoles, and one row of JSON for each event, in a file for each day (UTC).

    python examples/edge_box.py FOLDER LEFT RIGHT                       two addresses from `solepath scan`
    python examples/edge_box.py FOLDER LEFT RIGHT tcp:127.0.0.1:9735    the same from `solepath emulate`

examples/edge_box.service starts it with the machine and after every end: it may be killed at any moment. Every packet
is recorded before it is used. Each minute the session is saved and the next recording is started, so a restart reads
the last save and a minute of packets at most. They give the same rows as before, and rows that a file has are not
written again. On a full disk it ends, and measures nothing until there is space. Tried with emulated insoles; nobody
has tried it on a box with a radio.
"""

import asyncio
import json
import os
import socket
import sys
import time
from contextlib import AsyncExitStack, suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path

from solepath import Event, Packet, Session, Site, SnapshotError
from solepath.ble import NATIVE, DeviceConfig, Devices
from solepath.recording import PacketWriter, RecordingError, read_header, read_packets, read_start_time
from solepath.saving.files import write_whole

SAVE_INTERVAL = 60.0  # s
KEEP_RECORDINGS = False  # True also keeps those that were saved; a day of two insoles has about 7 GB
BOOT = Path("/proc/sys/kernel/random/boot_id").read_text().strip()  # time.monotonic() restarts with the machine


class Box:
    """The session and its files. `number` counts the rows since the first start, `written` those that files have."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.session, self.number, self.recording = folder, Session(), 0, 0
        self.boot, self.writer = "", None  # the boot in which the newest packet came
        with suppress(FileNotFoundError, ValueError, KeyError):  # never saved, or a file that something damaged
            saved = json.loads((folder / "state.json").read_text())
            self.number, self.recording, self.boot = saved["number"], saved["recording"], saved["boot"]
            with suppress(SnapshotError):  # another version of solepath saved it: the track starts again
                self.session = Session.restore(saved["session"])
        self.written = max([self.number, *map(newest_number, folder.glob("rows-*.jsonl"))])
        for path in sorted(folder.glob("packets-*.jsonl")):
            if path.name > self.path().name:
                self.recording = int(path.stem.removeprefix("packets-"))
                with suppress(RecordingError):  # one without a whole header: killed before its first packet
                    self.use_header(read_header(path))
                    for packet in read_packets(path):
                        self.use(packet)
        self.number = max(self.number, self.written)
        self.save()

    def path(self) -> Path:
        return self.folder / f"packets-{self.recording:08}.jsonl"

    def use_header(self, header: dict[str, str | float]) -> None:
        """Use what a recording says of its clock: the date and time at a time of its packets, s, and the boot."""
        self.started_at, self.t_start = read_start_time(header)
        self.recorded_boot = header["boot"]

    def save(self) -> None:
        """Save the session and start the next recording; a restart does not need the earlier ones any more."""
        if self.writer is not None:
            self.writer.close()
        os.sync()  # the rows, before the packets that they came from are deleted
        state = {"recording": self.recording, "number": self.number, "boot": self.boot}
        write_whole(self.folder / "state.json", json.dumps({**state, "session": self.session.snapshot()}))
        for path in self.folder.glob("packets-*.jsonl") if not KEEP_RECORDINGS else ():
            path.unlink()
        self.recording += 1
        header = {"began": datetime.now(UTC).isoformat(), "began_t": time.monotonic(), "boot": BOOT}
        self.writer, self.save_at = PacketWriter(self.path(), header), header["began_t"] + SAVE_INTERVAL
        self.use_header(header)

    def receive(self, packet: Packet) -> None:
        self.writer.write(packet)
        self.use(packet)
        if packet.t >= self.save_at:
            self.save()

    def use(self, packet: Packet) -> None:
        """Feed the session a packet that a recording has, and write the rows that no file has."""
        events = self.session.restart_clock(packet.t) if self.recorded_boot != self.boot else []
        self.boot = self.recorded_boot
        for event in events + self.session.feed(packet):
            self.number += 1
            if self.number > self.written:
                self.write(event, self.started_at + timedelta(seconds=packet.t - self.t_start))

    def write(self, event: Event, now: datetime) -> None:
        row = {"row": self.number, "time": now.isoformat(timespec="milliseconds"), **event.to_dict()}
        with open(self.folder / f"rows-{now:%Y-%m-%d}.jsonl", "ab", buffering=0) as file:
            file.write(json.dumps(row).encode() + b"\n")


def newest_number(path: Path) -> int:
    """Return the number of the last whole row of a file; half a row after it, at which it was killed, is cut off."""
    with path.open("r+b") as file:
        file.seek(max(0, path.stat().st_size - 100_000))
        *whole, torn = file.read().split(b"\n")
        file.truncate(file.tell() - len(torn))
    for line in reversed(whole):
        with suppress(ValueError, KeyError, TypeError):
            return json.loads(line)["row"]
    return 0


def notify(state: bytes) -> None:
    """Report to systemd that the program is ready or alive."""
    if address := os.environ.get("NOTIFY_SOCKET"):
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as systemd:
            systemd.sendto(state, address.replace("@", "\0", 1))


async def main(folder: Path, left: str, right: str, via: str = "") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    box, notify_at, backend = Box(folder), 0.0, NATIVE
    async with AsyncExitStack() as stack:
        if via:
            from solepath.emulate.controllers import reach

            backend = await stack.enter_async_context(reach(via))
        configs = [DeviceConfig(Site.LEFT_FOOT, left), DeviceConfig(Site.RIGHT_FOOT, right)]
        devices = await stack.enter_async_context(Devices(configs, backend=backend))
        notify(b"READY=1")
        async for packet in devices:  # of a sensor, or at least four times a second a tick
            box.receive(packet)
            if packet.t >= notify_at:
                notify(b"WATCHDOG=1")
                notify_at = packet.t + 1.0


if __name__ == "__main__":
    asyncio.run(main(Path(sys.argv[1]), *sys.argv[2:]))
