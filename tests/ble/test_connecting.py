"""Links that are hard to make: devices that are gone or taken when they are connected to, or lost over and over."""

from __future__ import annotations

import asyncio
from itertools import pairwise

import pytest
from airs import hear, in_virtual_time, memory
from belts import RATE, STRAP, address, asked
from strap import Strap

from solepath.ble import Backend, Devices, Wanted
from solepath.emulate import Route
from solepath.emulate.devices.attributes import AttError
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import Fault, What, parse_faults
from solepath.types import Site
from solepath.wire.fields import parse_text


def test_a_device_that_left_before_it_was_connected_is_soon_looked_for_again():
    bench = Bench(Route().stand(5.0), faults=parse_faults("0.005 left_foot vanish 300"))

    async def main():
        async with memory(bench) as backend, Devices([Wanted(None, "solepath L")], backend=backend) as devices:
            return await hear(devices, 60.0)

    troubles = [(p.t, parse_text(p.data)) for p in in_virtual_time(main) if p.channel == "receiver/trouble"]
    (connecting, unanswered), (searching, unheard) = troubles
    assert unanswered.startswith("the device does not answer: bring it near") and connecting == pytest.approx(10.0)
    assert unheard.startswith("no device 'solepath L' is heard") and 20.0 < searching < 30.0


def test_a_device_that_is_heard_and_does_not_answer_is_told_when_patience_ends_not_some_attempts_later():
    """As when another program holds it, on systems that go on telling of it."""
    beneath = asked(Strap("strap 1", address(1))).backend

    class Client(beneath.client):
        async def connect(self, pair, **more):
            await asyncio.Event().wait()

    async def main():
        wanted = [Wanted(Site.PELVIS, address(1), STRAP)]
        async with Devices(wanted, backend=Backend(Client, beneath.scanner), patience=7.0) as devices:
            return await hear(devices, 55.0)

    [told] = [packet for packet in in_virtual_time(main) if packet.channel == "receiver/trouble"]
    assert told.t == pytest.approx(7.0, abs=0.1)
    assert told.data.decode().endswith("see that no other program or phone holds it")


def test_attempts_that_fail_do_not_begin_patience_anew():
    """The device refuses its stream for a while, then is heard no more."""
    device = Odd("strap 1", address(1), faults=parse_faults("5 * vanish"))

    async def main():
        async with Devices([Wanted(Site.PELVIS, address(1), STRAP)], backend=asked(device).backend) as devices:
            return await hear(devices, 30.0)

    told = [(p.t, p.data.decode()) for p in in_virtual_time(main) if p.channel == "receiver/trouble"]
    unheard = [t for t, words in told if words.startswith("no strap")]
    assert told[0][0] < 1.0 and len(unheard) == 1 and unheard[0] == pytest.approx(10.5, abs=2.0)


class Odd(Strap):
    """Its stream cannot be subscribed."""

    def subscribe(self, channel, on, now):
        raise AttError(0x80)


def weak(every, seconds):
    """What is heard over a link that breaks so often, s."""
    cuts = [Fault(1.0 + every * k, Site.PELVIS, What.DISCONNECT) for k in range(int(seconds / every))]

    async def main():
        device = Strap("strap 1", address(1), faults=cuts)
        async with Devices([Wanted(Site.PELVIS, address(1), STRAP)], backend=asked(device).backend) as devices:
            return await hear(devices, seconds)

    return in_virtual_time(main)


@pytest.mark.parametrize(("every", "share"), [(1.0, 0.5), (2.0, 0.75)])
def test_a_link_that_breaks_every_second_is_made_again_each_time(every, share):
    packets = weak(every, 60.0)
    beats = [packet for packet in packets if packet.channel == "strap/beat"]
    assert len(beats) > share * 60.0 * RATE
    assert max(b.t - a.t for a, b in pairwise(beats)) < 1.5
