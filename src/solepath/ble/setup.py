"""What is read from a device and written to it before it is listened to, by its profile."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from bleak import BleakClient
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.exc import BleakDBusError, BleakError, BleakGATTProtocolError

from ..link.profile import Access, Channel, Profile
from ..types import SITE_OF_FOOT, Packet, Site
from ..wire.error import WireError
from ..wire.insole_info import parse_info
from .inbox import Emitter
from .trouble import calling, sentence
from .wanted import says_its_site

ANSWER = 5.0
"""s for which an answer is waited for; TimeoutError after that, and the connection is begun anew."""

INFO = "insole/info"
"""The channel that tells where a device is worn."""

Hearer = Callable[[BleakGATTCharacteristic, bytearray], None]


class Unfit(Exception):
    """This device is not the one that is wanted, or not of the kind that it seemed to be."""


def characteristic(client: BleakClient, channel: Channel) -> BleakGATTCharacteristic | None:
    """The channel's characteristic; None when this device does not have it. Of several alike it is the first."""
    services = [service for service in client.services if service.uuid == channel.service]
    found = (service.get_characteristic(channel.characteristic) for service in services)
    return next((one for one in found if one is not None), None)


def speaking(client: BleakClient, channel: Channel) -> BleakGATTCharacteristic | None:
    """The same, when it can be subscribed: some devices let their battery be read only."""
    one = characteristic(client, channel)
    return one if one is not None and {"notify", "indicate"} & {*one.properties} else None


def lacking(client: BleakClient, profile: Profile) -> str | None:
    """The first of the streams that the device cannot send, by the channel's name."""
    channels = (profile.channel(stream) for stream in profile.streams)
    return next((channel.name for channel in channels if speaking(client, channel) is None), None)


async def ask_info(client: BleakClient, profile: Profile) -> bytes | None:
    """What a device holds that says where it is worn; None when it says nothing. FAILURES."""
    info = characteristic(client, profile.channel(INFO)) if says_its_site(profile) else None
    if info is None:
        return None
    async with calling(ANSWER):
        return bytes(await client.read_gatt_char(info))


def site_in(info: bytes, name: str) -> Site:
    """Where the device `name` says that it is worn. Unfit when nobody understands it."""
    try:
        return SITE_OF_FOOT[parse_info(info).foot]
    except WireError as error:
        raise Unfit(
            f"the INFO record of {name} cannot be read ({error.detail}): switch it off and on, "
            "or update its firmware; it is looked at again in a minute"
        ) from error


def refused(error: BleakError, client: BleakClient) -> bool:
    """Was this request refused, while the connection stands? Not every system says it with an ATT error: Windows has
    "Access Denied", BlueZ its own names. What D-Bus itself says, that BlueZ is gone or silent, is no refusal."""
    if isinstance(error, BleakDBusError) and error.dbus_error.startswith("org.freedesktop.DBus."):
        return False
    return isinstance(error, BleakGATTProtocolError) or client.is_connected


@asynccontextmanager
async def asking(client: BleakClient, emitter: Emitter, failure: str) -> AsyncIterator[None]:
    """The context of one request to a device. A refusal is reported, as `failure` and the reason, and the setup goes
    on; anything else that goes wrong is raised (FAILURES)."""
    try:
        async with calling(ANSWER):
            yield
    except BleakError as error:
        if not refused(error, client):
            raise
        emitter.complain(f"{failure}: {sentence(error)}")


async def read(client: BleakClient, channel: Channel, emitter: Emitter) -> None:
    """Say what the channel holds, where the device has it and tells."""
    one = characteristic(client, channel)
    if one is not None:
        async with asking(client, emitter, f"{channel.name} cannot be read"):
            emitter.say(channel.name, bytes(await client.read_gatt_char(one)))


async def subscribe(client: BleakClient, profile: Profile, hearer: Callable[[str], Hearer], emitter: Emitter) -> None:
    """Let `hearer`'s callbacks hear whatever the device can say. What it refuses beside its streams is told and passed
    over."""
    for channel in profile.channels:
        if channel.access is not Access.NOTIFY or (one := speaking(client, channel)) is None:
            continue
        failure = f"{channel.name} cannot be subscribed"
        async with calling(ANSWER) if channel.name in profile.streams else asking(client, emitter, failure):
            await client.start_notify(one, hearer(channel.name))


async def write_setup(client: BleakClient, profile: Profile, emitter: Emitter) -> list[Packet]:
    """Make the writes of the profile; what was written, as it was said.

    What the device does not have (old SensorTags have no periods) or refuses is told and passed over: a stream that
    does not begin for it is the watchdog's business.
    """
    written = []
    for write in profile.setup:
        one = characteristic(client, profile.channel(write.channel))
        if one is None:
            emitter.complain(f"{write.channel} is not there to be set: the device keeps to its own")
            continue
        said: Packet | None = None
        async with asking(client, emitter, f"{write.channel} was not set to {write.value.hex()}"):
            await client.write_gatt_char(one, write.value)  # with a response, where it gives one
            said = emitter.say(write.channel, write.value)
        if said is not None:
            written.append(said)
            for name in write.then_read:
                await read(client, profile.channel(name), emitter)
    return written
