"""Measures the cost of the Bluetooth adapter: `python tests/bench/bluetooth.py`.

It prints the processor time that the adapter adds to plain bleak for a packet, with an in-memory backend. Then it
prints the latency from a notification to its events in real time, with that backend and with virtual controllers.
"""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path
from statistics import median, quantiles
from time import perf_counter, process_time

import looptime
from bleak import BleakClient, BleakScanner

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers" / "radio"))

from airs import TIERS, memory  # noqa: E402

from solepath import FootMoved, Session  # noqa: E402
from solepath.ble import DeviceConfig, Devices  # noqa: E402
from solepath.emulate.devices.bench import Bench  # noqa: E402
from solepath.emulate.routes.route import Route  # noqa: E402
from solepath.link.devices.insole import PROFILE as INSOLE  # noqa: E402

WALK = Route().stand(2.0).walk(20.0).stop(2.0)
VIRTUAL_TIME = 30.0
"""Time of the virtual event loop over which processor time is counted, s."""
REAL_TIME = 10.0
"""Real time over which latency is measured, s."""
ROUNDS = 5


def make_bench() -> Bench:
    bench = Bench(WALK)
    bench.prepare()
    return bench


async def measure_plain(bench: Bench) -> tuple[float, int]:
    """Return the processor time, s, and the number of notifications of plain bleak with a callback that only counts."""
    count = 0

    def on_notification(_: object, data: bytearray) -> None:
        nonlocal count
        count += 1

    async with memory(bench) as backend:
        found = await BleakScanner.discover(1.0, backend=backend.scanner)
        clients = [BleakClient(device, backend=backend.client) for device in found]
        for client in clients:
            await client.connect()
            await client.start_notify(INSOLE.channel("insole/frame").characteristic, on_notification)
            await client.write_gatt_char(INSOLE.channel("insole/control").characteristic, b"\x01", response=True)
        count, started_at = 0, process_time()
        await asyncio.sleep(VIRTUAL_TIME)
        spent = process_time() - started_at
        for client in clients:
            await client.disconnect()
    return spent, count


async def measure_adapted(bench: Bench) -> tuple[float, int]:
    """Return the processor time, s, and the number of notifications of Devices, from which every packet is taken."""
    async with (
        memory(bench) as backend,
        Devices([DeviceConfig(None, profile=INSOLE), DeviceConfig(None, profile=INSOLE)], backend=backend) as devices,
    ):
        loop = asyncio.get_running_loop()
        count, started_at, until = 0, 0.0, float("inf")
        async for packet in devices:
            if not started_at and packet.channel == "insole/frame":
                started_at, until = process_time(), loop.time() + VIRTUAL_TIME
            if packet.t >= until:
                break
            count += packet.channel == "insole/frame"
        return process_time() - started_at, count


async def measure_delays(tier: str) -> tuple[list[float], list[float]]:
    """Return the delays from the link to the packet's time stamp, and from the stamp to its events, s."""
    bench = make_bench()
    session = Session(poses=True)
    transport_delays, processing_delays = [], []
    loop = asyncio.get_running_loop()
    async with (
        TIERS[tier](bench) as backend,
        Devices([DeviceConfig(None, profile=INSOLE), DeviceConfig(None, profile=INSOLE)], backend=backend) as devices,
    ):
        started_at = loop.time() + 1.0
        bench.walk_from(started_at)
        end = started_at + REAL_TIME
        sent = {peripheral.site: 0.0 for peripheral in bench.peripherals}
        for peripheral in bench.peripherals:
            poll = peripheral.poll

            def poll_and_note(now: float, peripheral=peripheral, poll=poll):  # type: ignore[no-untyped-def]
                sent[peripheral.site] = loop.time()
                return poll(now)

            peripheral.poll = poll_and_note  # type: ignore[method-assign]
        async for packet in devices:
            moved = any([isinstance(event, FootMoved) for event in session.feed(packet)])
            done = loop.time()
            if moved and packet.t > started_at:
                transport_delays.append(packet.t - sent[packet.site])
                processing_delays.append(done - packet.t)
            if packet.t > end:
                break
    return transport_delays, processing_delays


def format_delays(values: list[float]) -> str:
    return f"median {1e3 * median(values):5.2f} ms, p99 {1e3 * quantiles(values, n=100)[98]:5.2f} ms"


def main() -> None:
    times: dict[str, list[float]] = {"plain": [], "adapted": []}
    for _ in range(ROUNDS):
        for name, run in (("plain", measure_plain), ("adapted", measure_adapted)):
            with asyncio.Runner(loop_factory=looptime.new_event_loop) as runner:
                spent, count = runner.run(run(make_bench()))
            times[name].append(1e6 * spent / count)
    bare, whole = min(times["plain"]), min(times["adapted"])  # a disturbance only makes a run slower
    print(f"Python {sys.version.split()[0]}; the best of {ROUNDS}; two insoles of 96 cells at 100 Hz, in memory\n")
    print(f"plain bleak, the emulated devices included   {bare:6.1f} us a notification")
    print(f"the same through Devices                     {whole:6.1f} us")
    print(f"the adapter's own                            {whole - bare:6.1f} us\n")
    for tier in TIERS:
        started_at = perf_counter()
        transport_delays, processing_delays = asyncio.run(measure_delays(tier))
        if perf_counter() - started_at < REAL_TIME:
            raise SystemExit(f"{tier}: the devices fell silent")
        print(f"{tier}: from the device to the stamp   {format_delays(transport_delays)}")
        print(f"{tier}: from the stamp to the events   {format_delays(processing_delays)}")
        total_delays = [a + b for a, b in zip(transport_delays, processing_delays, strict=True)]
        print(f"{tier}: from notification to event     {format_delays(total_delays)}")


if __name__ == "__main__":
    main()
