"""Agreement of profiles with the tables of protocol/*.md, and of setup writes with the decoder."""

from __future__ import annotations

import re

import pytest
from here import PROTOCOL

from solepath.link.catalogue import PROFILES
from solepath.link.devices.cc2541 import PROFILE_20HZ as CC2541_20HZ
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.profile import Profile, Write


def short(uuid: str) -> str:
    return uuid[4:8].upper()


def table(document: str, first_header: str) -> list[list[str]]:
    """Return the rows of the table whose header starts with `first_header`."""
    lines = (PROTOCOL / document).read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(f"| {first_header} |"))
    rows = []
    for line in lines[start + 2 :]:
        if not line.startswith("|"):
            break
        rows.append([cell.strip() for cell in line.strip("|").split("|")])
    return rows


def documented_channels() -> dict[str, str]:
    """Return the short number of each channel's characteristic, from protocol/README.md."""
    channel_numbers: dict[str, str] = {}
    for names, characteristics, *_ in table("README.md", "channel"):
        if characteristics == "none":
            continue  # a channel of the receiver
        whole, *others = re.findall(r"`([^`]+)`", names)
        channels = [whole] + [other if "/" in other else whole + other for other in others]
        numbers = re.findall(r"\b([0-9A-F]{4})\b", characteristics)
        assert len(channels) == len(numbers), names
        channel_numbers.update(zip(channels, numbers, strict=True))
    return channel_numbers


def document(profile: Profile) -> str:
    return f"{profile.name.removesuffix('-20hz')}.md"


def test_the_channels_of_all_profiles_are_those_of_the_protocol_with_their_numbers_and_services() -> None:
    numbers = documented_channels()
    assert numbers.keys() == {channel.name for profile in PROFILES for channel in profile.channels}
    for profile in PROFILES:
        text = (PROTOCOL / document(profile)).read_text("utf-8")
        base = re.search(r"`(\w{4})xxxx(-[\w-]{27})`", text)
        for channel in profile.channels:
            service, number = short(channel.service), short(channel.characteristic)
            assert number == numbers[channel.name].zfill(4), channel.name
            for uuid in (channel.service, channel.characteristic):
                assert (
                    uuid in (f"0000{uuid[4:8]}-0000-1000-8000-00805f9b34fb",)
                    or uuid in text
                    or (base is not None and uuid == f"{base[1]}{uuid[4:8]}{base[2]}".lower())
                ), channel.name
            lines = [line for line in text.splitlines() if number in line or channel.characteristic in line]
            named = any(service in one or channel.service in one for one in lines)
            assert named or profile is INSOLE or channel.name.startswith(("device/", "cc2541/barometer-")), channel.name
        assert profile is not INSOLE or {channel.service for channel in profile.channels[:3]} == {*profile.services}


@pytest.mark.parametrize(
    ("profile", "document"),
    [(profile, f"{profile.name.removesuffix('-20hz')}.md") for profile in PROFILES],
    ids=[profile.name for profile in PROFILES],
)
def test_setup_is_the_table_of_the_document_write_for_write(profile: Profile, document: str) -> None:
    documented_numbers = []
    for number, (order, channel, value, then_read, meaning) in enumerate(table(document, "order"), 1):
        values = re.findall(r"`([0-9a-f]+)`", value)
        assert order == str(number) and values and meaning
        written = bytes.fromhex(values[-1] if profile is CC2541_20HZ else values[0])
        documented_numbers.append(Write(channel.strip("`"), written, tuple(re.findall(r"`([^`]+)`", then_read))))
    assert tuple(documented_numbers) == profile.setup
