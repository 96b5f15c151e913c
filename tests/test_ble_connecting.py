"""A device that advertised, and is gone when it is connected to."""

from __future__ import annotations

from airs import hear, in_virtual_time, memory
from solepath.ble import Devices, Wanted
from solepath.loopback.bench import Bench
from solepath.loopback.faults import parse_faults
from solepath.sim import Route
from solepath.wire.receiver import parse_words


def test_a_device_that_left_before_it_was_connected_is_soon_looked_for_again():
    bench = Bench(Route().stand(5.0), faults=parse_faults("0.005 left_foot vanish 300"))

    async def main():
        async with memory(bench) as backend, Devices([Wanted(None, "solepath L")], backend=backend) as devices:
            return await hear(devices, 60.0)

    troubles = [(p.t, parse_words(p.data)) for p in in_virtual_time(main) if p.channel == "receiver/trouble"]
    (connecting, gave_up), (searching, unheard) = troubles
    assert gave_up == "the device did not answer in time" and connecting < 30.0
    assert unheard.startswith("no device 'solepath L' is heard") and searching < connecting + 15.0
