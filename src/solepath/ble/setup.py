"""Reads, subscriptions and writes that the profile prescribes before a device is listened to."""

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
from .config import reports_site
from .inbox import Emitter
from .trouble import bleak_call, describe_error

ANSWER_TIMEOUT = 5.0
"""Time limit for the answer of a device, s; then TimeoutError is raised and the connection is made again."""

INFO_CHANNEL = "insole/info"
"""Channel of the record that holds the site of a device."""

NotifyCallback = Callable[[BleakGATTCharacteristic, bytearray], None]


class WrongDevice(Exception):
    """Raised for a device that is not the configured one, or not of the kind that it seemed to be."""


def find_characteristic(client: BleakClient, channel: Channel) -> BleakGATTCharacteristic | None:
    """Return the channel's characteristic, the first of several; None when the device does not have it."""
    services = [service for service in client.services if service.uuid == channel.service]
    characteristics = (service.get_characteristic(channel.characteristic) for service in services)
    return next((characteristic for characteristic in characteristics if characteristic is not None), None)


def find_notifying(client: BleakClient, channel: Channel) -> BleakGATTCharacteristic | None:
    """Return the channel's characteristic if it can notify, else None: some battery levels can only be read."""
    found = find_characteristic(client, channel)
    return found if found is not None and {"notify", "indicate"} & {*found.properties} else None


def find_missing_stream(client: BleakClient, profile: Profile) -> str | None:
    """Return the channel name of the first stream that the device cannot send; None when it has all."""
    channels = (profile.channel(stream) for stream in profile.streams)
    return next((channel.name for channel in channels if find_notifying(client, channel) is None), None)


async def read_info(client: BleakClient, profile: Profile) -> bytes | None:
    """Return the record that holds the device's site; None when it has none. Raises FAILURES."""
    info = find_characteristic(client, profile.channel(INFO_CHANNEL)) if reports_site(profile) else None
    if info is None:
        return None
    async with bleak_call(ANSWER_TIMEOUT):
        return bytes(await client.read_gatt_char(info))


def parse_site(info: bytes, name: str) -> Site:
    """Return the site that the device `name` reports. Raises WrongDevice when the record cannot be read."""
    try:
        return SITE_OF_FOOT[parse_info(info).foot]
    except WireError as error:
        raise WrongDevice(
            f"the INFO record of {name} cannot be read ({error.detail}): switch it off and on, "
            "or update its firmware; it is looked at again in a minute"
        ) from error


def is_rejection(error: BleakError, client: BleakClient) -> bool:
    """Return whether the device rejected a request while the connection stands.

    Not every system reports this as an ATT error: Windows reports "Access Denied", BlueZ its own D-Bus errors. An error
    of D-Bus itself (BlueZ is absent or does not answer) is no rejection."""
    if isinstance(error, BleakDBusError) and error.dbus_error.startswith("org.freedesktop.DBus."):
        return False
    return isinstance(error, BleakGATTProtocolError) or client.is_connected


@asynccontextmanager
async def device_request(client: BleakClient, emitter: Emitter, failure: str) -> AsyncIterator[None]:
    """Wrap one request to a device.

    A rejection is reported, as `failure` and the reason, and the setup continues. Other failures are raised (FAILURES).
    """
    try:
        async with bleak_call(ANSWER_TIMEOUT):
            yield
    except BleakError as error:
        if not is_rejection(error, client):
            raise
        emitter.report_trouble(f"{failure}: {describe_error(error)}")


async def read(client: BleakClient, channel: Channel, emitter: Emitter) -> None:
    """Read the channel, if the device has it, and emit its value or report a rejection."""
    characteristic = find_characteristic(client, channel)
    if characteristic is not None:
        async with device_request(client, emitter, f"{channel.name} cannot be read"):
            emitter.emit(channel.name, bytes(await client.read_gatt_char(characteristic)))


async def subscribe(
    client: BleakClient, profile: Profile, make_callback: Callable[[str], NotifyCallback], emitter: Emitter
) -> None:
    """Subscribe to every channel that notifies; raise the rejection of a stream, report that of any other channel."""
    for channel in profile.channels:
        if channel.access is not Access.NOTIFY or (characteristic := find_notifying(client, channel)) is None:
            continue
        failure = f"{channel.name} cannot be subscribed"
        async with (
            bleak_call(ANSWER_TIMEOUT) if channel.name in profile.streams else device_request(client, emitter, failure)
        ):
            await client.start_notify(characteristic, make_callback(channel.name))


async def write_setup(client: BleakClient, profile: Profile, emitter: Emitter) -> list[Packet]:
    """Write the values that the profile prescribes, and return the packets of those that were written.

    A channel that the device does not have (old SensorTags have no channel for periods), or a write that it rejects, is
    reported and skipped: the watchdog detects a stream that does not start because of it."""
    written = []
    for write in profile.setup:
        characteristic = find_characteristic(client, profile.channel(write.channel))
        if characteristic is None:
            emitter.report_trouble(f"{write.channel} is not there to be set: the device keeps to its own")
            continue
        packet: Packet | None = None
        async with device_request(client, emitter, f"{write.channel} was not set to {write.value.hex()}"):
            await client.write_gatt_char(characteristic, write.value)  # with response, where the device supports it
            packet = emitter.emit(write.channel, write.value)
        if packet is not None:
            written.append(packet)
            for name in write.then_read:
                await read(client, profile.channel(name), emitter)
    return written
