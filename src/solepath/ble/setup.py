"""What is read from a device and written to it before it is listened to, by its profile."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from bleak import BleakClient
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.exc import BleakGATTProtocolError

from ..link.profile import Channel, Profile
from ..types import SITE_OF_FOOT, Packet, Site
from ..wire.error import WireError
from ..wire.insole_info import parse_info
from .trouble import sentence
from .wanted import says_its_site

ANSWER = 5.0
"""s for which an answer is waited for; TimeoutError after that, and the connection is begun anew."""

Say = Callable[[str, bytes], Packet]
Complain = Callable[[str], None]


class Unfit(Exception):
    """This device is not the one that is wanted, or not of the kind that it seemed to be."""


def characteristic(client: BleakClient, channel: Channel) -> BleakGATTCharacteristic | None:
    """The channel's characteristic; None when this device does not have it."""
    service = client.services.get_service(channel.service)
    return None if service is None else service.get_characteristic(channel.characteristic)


def lacking(client: BleakClient, profile: Profile) -> str | None:
    """The first of the streams that the device cannot send, by the channel's name."""
    channels = (profile.channel(stream) for stream in profile.streams)
    return next((channel.name for channel in channels if characteristic(client, channel) is None), None)


async def site_of(client: BleakClient, profile: Profile) -> Site | None:
    """Where the device says that it is worn; None when it says nothing. Unfit when nobody understands it."""
    if not says_its_site(profile):
        return None
    info = characteristic(client, profile.channel("insole/info"))
    if info is None:
        return None
    async with asyncio.timeout(ANSWER):
        data = await client.read_gatt_char(info)
    try:
        return SITE_OF_FOOT[parse_info(bytes(data)).foot]
    except WireError as error:
        raise Unfit(f"its INFO record cannot be read: {error.detail}") from error


async def read(client: BleakClient, channel: Channel, say: Say, complain: Complain) -> None:
    """Say what the channel holds, where the device has it."""
    one = characteristic(client, channel)
    if one is None:
        return
    try:
        async with asyncio.timeout(ANSWER):
            data = await client.read_gatt_char(one)
    except BleakGATTProtocolError as error:
        complain(f"{channel.name} cannot be read: {sentence(error)}")
        return
    say(channel.name, bytes(data))


async def write_setup(client: BleakClient, profile: Profile, say: Say, complain: Complain) -> list[Packet]:
    """Make the writes of the profile; what was written, as it was said.

    What the device does not have (old SensorTags have no periods) or refuses is told and passed over: a stream that
    does not begin for it is the watchdog's business.
    """
    written = []
    for write in profile.setup:
        one = characteristic(client, profile.channel(write.channel))
        if one is None:
            complain(f"{write.channel} is not there to be set: the device keeps to its own")
            continue
        try:
            async with asyncio.timeout(ANSWER):
                await client.write_gatt_char(one, write.value, response=True)
        except BleakGATTProtocolError as error:
            complain(f"{write.channel} was not set to {write.value.hex()}: {sentence(error)}")
            continue
        written.append(say(write.channel, write.value))
        for name in write.then_read:
            await read(client, profile.channel(name), say, complain)
    return written
