"""Mutated notifications of all devices: bytes, fields with a right checksum, times, channels, sites, order."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from random import Random
from typing import Any

import walks
from attrs import evolve
from changes import changed_bytes, changed_value
from checks import Checked

from solepath import Packet, Session, Site, recipes
from solepath.link.catalogue import PROFILES
from solepath.link.devices import cc2650, dot, dot_orientation, orphe, thingy
from solepath.wire.envelope import CRC_SIZE, seal
from solepath.wire.fields import build_whole, parse_whole
from solepath.wire.insole import build_frame, parse_frame
from solepath.wire.insole_info import build_info, parse_info

CHANNELS = sorted({channel.name for profile in PROFILES for channel in profile.channels})
FORMATS = {
    channel: definition
    for module in (cc2650, dot, dot_orientation, orphe, thingy)
    for channel, definition in module.DRIVER.formats.items()
}
"""Construct of the values of each channel of a declared device."""
TIME_STEPS = (0.0, 1e-9, -1e-9, 1e-3, -1e-3, -0.5, 1.0, 20.0, 1e4, -1e4, 1e9, float("nan"), float("inf"), -1e300)
"""Changes of an arrival time, s."""
PACKETS = 500
"""Number of packets of a round."""
MUTATED_SHARE = 0.6
"""Share of the packets that are mutated; the others keep a walk going."""


@cache
def streams() -> dict[str, tuple[Packet, ...]]:
    """Return the packets of emulated walks of all devices."""
    return walks.packets()


def run(seed: int) -> tuple[int, int]:
    """Feed a session mutated packets; return their number and the number of events."""
    random = Random(seed)
    name = random.choice(list(streams()))
    recipe = recipes.by_name(random.choice(("default", "default", "default", *recipes.NAMES)))
    session = Session(recipe, poses=random.random() < 0.5, pressures=random.random() < 0.2)
    checked, mutated = Checked(session, recipe, random), 0
    for packet, is_mutated in mutations(streams()[name], random):
        checked.feed(packet)
        mutated += is_mutated
        if random.random() < 0.002:
            checked.advance(random.choice((packet.t, packet.t + 5.0)) if abs(packet.t) < 1e9 else 0.0)
    checked.finish()
    return mutated, checked.events


def mutations(packets: tuple[Packet, ...], random: Random) -> Iterator[tuple[Packet, bool]]:
    """Yield packets of a walk from a random one on, and whether each is mutated; mutated times are not kept."""
    start = random.randrange(len(packets))
    for number in range(start, start + PACKETS):
        packet = packets[number % len(packets)]
        packet = evolve(packet, t=packet.t + (packets[-1].t + 1.0) * (number // len(packets)))
        if random.random() > MUTATED_SHARE:
            yield packet, False
            continue
        kind = random.randrange(100)
        if kind < 40:
            others = [random.choice(packets).data, random.choice(random.choice(list(streams().values()))).data]
            yield evolve(packet, data=changed_bytes(packet.data, random, others)), True
        elif kind < 80:
            yield evolve(packet, data=_changed_fields(packet, random)), True
        elif kind < 85:
            yield _changed_envelope(packet, random), True
        elif kind < 97:  # again, or another one in its place
            yield evolve(random.choice(packets[max(0, number - 5) : number + 5] or packets[:1]), t=packet.t), True
        else:
            yield evolve(packet, t=packet.t + random.choice(TIME_STEPS)), True
            yield packet, False


def _changed_envelope(packet: Packet, random: Random) -> Packet:
    """Return the packet with another channel, site or device."""
    kind = random.randrange(3)
    if kind == 0:
        return evolve(packet, channel=random.choice((*CHANNELS, "receiver/connected", "toaster/crumbs", "", "/")))
    if kind == 1:
        return evolve(packet, site=random.choice(list(Site)))
    return evolve(packet, device=random.choice(("", "AA:BB:CC:DD:EE:FF", "\ud800", "x" * 1000, "a\0b")))


def _changed_fields(packet: Packet, random: Random) -> bytes:
    """Return the data with a changed field and a right checksum, if its format has fields and the value fits it."""
    data, channel = packet.data, packet.channel
    if channel.startswith("insole/") and random.random() < 0.3:  # any header, with a right checksum
        return seal(changed_bytes(data[:-CRC_SIZE], random)[:500])
    try:
        value: Any
        if channel == "insole/frame":
            value = parse_frame(data)
            return build_frame(changed_value(value, random))
        if channel == "insole/info":
            return build_info(changed_value(parse_info(data), random))
        if channel in FORMATS:
            value = parse_whole(FORMATS[channel], data)
            return build_whole(FORMATS[channel], changed_value(value, random))
    except (ValueError, TypeError, AttributeError, OverflowError, KeyError):
        pass  # the value does not fit its format: bytes are changed instead
    return changed_bytes(data, random)
