"""This machine's own Bluetooth and a real device: only where there are both.

SOLEPATH_RADIO=ADDRESS python -m pytest -m radio tests/ble/test_radio.py

ADDRESS is that of a sensor nearby, as `solepath scan` shows it; SOLEPATH_RADIO_PROFILE the name of its profile, where
its advertisement does not tell.
"""

from __future__ import annotations

import asyncio
import os

import pytest
from airs import collect

from solepath import Disconnected, FootMoved, PacketRejected, Session
from solepath.ble import DeviceConfig, Devices, scan
from solepath.link.catalogue import DEVICES
from solepath.link.health import is_sample_channel
from solepath.types import Packet, Site

ADDRESS, PROFILE = os.environ.get("SOLEPATH_RADIO", ""), os.environ.get("SOLEPATH_RADIO_PROFILE", "")
LISTENING_TIME = 5.0
"""Time of listening after the first packet of samples, s."""
PATIENCE = 30.0
"""Time limit for finding, connecting and setting up, s."""

pytestmark = [
    pytest.mark.radio,
    pytest.mark.skipif(
        not ADDRESS, reason="needs a sensor: SOLEPATH_RADIO=ADDRESS (as solepath scan shows it) runs it"
    ),
]


async def receive() -> list[Packet]:
    """Return the packets from the connection to LISTENED s after the first samples."""
    found = [one for one in await scan(10.0) if one.address.upper() == ADDRESS.upper()]
    assert found, f"{ADDRESS} is not heard: switch it on, bring it near"
    profile = DEVICES[PROFILE] if PROFILE else found[0].profile
    assert profile is not None, "what this is its advertisement does not tell: SOLEPATH_RADIO_PROFILE=NAME"
    # an insole says itself whose it is
    config = DeviceConfig(None if profile.name == "insole" else Site.RIGHT_FOOT, ADDRESS, profile)
    packets: list[Packet] = []
    async with Devices([config]) as devices:
        async with asyncio.timeout(PATIENCE):
            async for packet in devices:
                packets.append(packet)
                if is_sample_channel(packet.channel):
                    break
        return packets + await collect(devices, LISTENING_TIME)


def test_a_real_device_is_found_connected_set_up_and_read_in_order() -> None:
    packets = asyncio.run(receive())
    frames = [packet for packet in packets if is_sample_channel(packet.channel)]
    assert all(a.t <= b.t for a, b in zip(packets, packets[1:], strict=False))
    rate = len(frames) / LISTENING_TIME
    assert rate > 5.0, f"{rate:.1f} packets of samples a second"
    assert {packet.device.upper() for packet in frames} == {ADDRESS.upper()}
    session = Session(poses=True)
    events = session.feed(packets)
    assert not [event for event in events if isinstance(event, PacketRejected | Disconnected)]
    times = [event.t for event in events if isinstance(event, FootMoved)]
    assert len(times) > 20 and all(a < b for a, b in zip(times, times[1:], strict=False))
