"""For a box without a screen in a hall or beside a bed: two insoles in, one row of a database for each event.

    python examples/edge_box.py box.db LEFT RIGHT [tcp:127.0.0.1:9735]    addresses of `solepath scan` [or `emulate`]
    sqlite3 box.db "select time, fields from rows where event = 'StrideTaken'"

edge_box.service starts it with the machine and after every end. Once a second new rows and session are saved in one
transaction: a kill costs a second of walking, no row is missing or there twice. Nobody has tried it with a radio."""

import asyncio
import json
import os
import socket
import sqlite3
import sys
from contextlib import nullcontext, suppress
from pathlib import Path

from solepath import Event, Packet, Session, Site, SnapshotError
from solepath.ble import NATIVE, DeviceConfig, Devices

SYSTEMD = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
BOOT = Path("/proc/sys/kernel/random/boot_id").read_text()  # the clock of the packets restarts with the machine
TABLES = """create table if not exists rows (row integer primary key, time, event, fields);
create table if not exists saved (id integer primary key, boot, session);"""


class Box:
    def __init__(self, file: str, now: float) -> None:
        self.database, self.session, self.events, self.save_at = sqlite3.connect(file), Session(), list[Event](), now
        self.database.executescript(TABLES)
        for boot, session in self.database.execute("select boot, session from saved"):
            with suppress(SnapshotError):  # another version of solepath saved it: the track starts again
                self.session = Session.unpack(session)
                self.events = self.session.restart_clock(now) if boot != BOOT else []

    def receive(self, packet: Packet) -> None:
        self.events += self.session.feed(packet)
        if packet.t >= self.save_at:
            rows = [(type(event).__name__, json.dumps(event.to_dict())) for event in self.events]
            with self.database:  # one transaction
                self.database.executemany("insert into rows (time, event, fields) values (datetime('now'), ?, ?)", rows)
                self.database.execute("replace into saved values (0, ?, ?)", [BOOT, self.session.pack()])
            self.events, self.save_at = [], packet.t + 1.0
            if address := os.environ.get("NOTIFY_SOCKET"):  # systemd restarts the box when this stops
                SYSTEMD.sendto(b"READY=1\nWATCHDOG=1", address.replace("@", "\0", 1))


async def main(file: str, left: str, right: str, via: str = "") -> None:
    if via:
        from solepath.emulate import reach
    box = Box(file, asyncio.get_running_loop().time())
    configs = [DeviceConfig(Site.LEFT_FOOT, left), DeviceConfig(Site.RIGHT_FOOT, right)]
    async with reach(via) if via else nullcontext(NATIVE) as backend, Devices(configs, backend=backend) as devices:
        async for packet in devices:  # of a sensor, or at least four times a second a tick
            box.receive(packet)


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
