"""Agreement of profiles with the tables of protocol/*.md, and of setup writes with the decoder."""

from __future__ import annotations

import re

import pytest
from here import PROTOCOL

from solepath.link.catalogue import BY_NAME, PROFILES
from solepath.link.decoder import Decoder
from solepath.link.devices import cc2541, cc2650, dot, dot_orientation, orphe, thingy
from solepath.link.devices.cc2541 import PROFILE as CC2541
from solepath.link.devices.cc2541 import PROFILE_20HZ as CC2541_20HZ
from solepath.link.devices.cc2650 import PROFILE as CC2650
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.driver import Reading
from solepath.link.profile import Access, Profile, Write
from solepath.types import Packet, Site
from solepath.wire.fields import parse_whole
from solepath.wire.insole_control import StartSampling, parse_control


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


@pytest.mark.parametrize("profile", PROFILES, ids=lambda profile: profile.name)
def test_every_channel_of_a_profile_is_in_the_protocol(profile: Profile) -> None:
    documented_numbers = documented_channels()
    for channel in profile.channels:
        assert short(channel.characteristic) == documented_numbers[channel.name].zfill(4), channel.name


def test_every_documented_channel_has_a_profile() -> None:
    assert documented_channels().keys() == {channel.name for profile in PROFILES for channel in profile.channels}


def test_the_insole_has_the_documented_uuids() -> None:
    text = (PROTOCOL / "insole.md").read_text()
    base = re.search(r"`([0-9a-f]{4})xxxx(-[0-9a-f-]{27})`", text)
    assert base is not None
    rows = {row[0]: row[1:] for row in table("insole.md", "xxxx")}
    for channel in INSOLE.channels:
        if channel.name.startswith("insole/"):
            number = channel.characteristic[4:8]
            assert channel.characteristic == base[1] + number + base[2]
            assert channel.service == base[1] + "0001" + base[2]
            assert channel.access.value in rows[number][1]
    assert INSOLE.services == (base[1] + "0001" + base[2],)


@pytest.mark.parametrize(("profile", "document"), [(CC2650, "cc2650.md"), (CC2541, "cc2541.md")])
def test_sensortag_sensors_are_at_the_uuids_of_the_tables(profile: Profile, document: str) -> None:
    suffixes = ["", "-config", "-period"]
    checked_channels = set()
    for sensor, *cells in table(document, "sensor"):
        numbers = [re.search(r"[0-9A-F]{4}", cell) for cell in cells]
        service = cells[0]
        for suffix, number in zip(suffixes, numbers[1:], strict=True):
            if number is None:
                continue
            channel = profile.channel(f"{profile.name}/{sensor}{suffix}")
            assert short(channel.characteristic) == number[0]
            assert short(channel.service) == service
            checked_channels.add(channel.name)
    assert len(checked_channels) >= 6


def test_advertised_names_are_in_the_documents() -> None:
    for profile in PROFILES:
        text = (PROTOCOL / f"{profile.name.removesuffix('-20hz')}.md").read_text()
        assert profile is INSOLE or profile.names or profile.prefixes
        assert all(f'"{name}"' in text for name in profile.names)
        assert all(f"begins with `{prefix}`" in text for prefix in profile.prefixes)


def test_a_device_is_known_by_its_whole_name_or_its_prefix() -> None:
    matching_profiles = {
        name: [p.name for p in PROFILES if p.matches_name(name)] for name in ("INS0123", "Thingy", "Thingy 2", "")
    }
    assert matching_profiles == {"INS0123": ["orphe"], "Thingy": ["thingy"], "Thingy 2": [], "": []}


@pytest.mark.parametrize(
    "profile", [orphe.PROFILE, dot.PROFILE, dot_orientation.PROFILE, thingy.PROFILE], ids=lambda profile: profile.name
)
def test_a_declared_device_has_the_uuids_of_its_document(profile: Profile) -> None:
    text = (PROTOCOL / f"{profile.name}.md").read_text()
    base = re.search(r"`([0-9a-f]{4})xxxx(-[0-9a-f-]{27})`", text)
    rows = {row[0].strip("`"): row[1:] for row in table(f"{profile.name}.md", "channel")}
    assert set(rows) == {channel.name for channel in profile.channels}
    for channel in profile.channels:
        for uuid, printed in zip((channel.service, channel.characteristic), rows[channel.name], strict=False):
            if len(printed) == 36:
                assert uuid == printed
            else:
                assert short(uuid) == printed
                assert channel.name.startswith("device/") or uuid == f"{base[1]}{printed}{base[2]}".lower()
        assert channel.access.value in rows[channel.name][2]


@pytest.mark.parametrize("profile", PROFILES, ids=lambda profile: profile.name)
def test_a_profile_refers_only_to_its_own_channels_and_uses_them_as_they_can_be_used(profile: Profile) -> None:
    for write in profile.setup:
        assert profile.channel(write.channel).access is Access.WRITE
        assert all(profile.channel(name).access is Access.READ for name in write.then_read)
    assert all(profile.channel(name).access in (Access.READ, Access.NOTIFY) for name in profile.reads)
    assert all(profile.channel(name).access is Access.NOTIFY for name in profile.streams)
    uuids = [(channel.service, channel.characteristic) for channel in profile.channels]
    assert len({(*pair, channel.access) for pair, channel in zip(uuids, profile.channels, strict=True)}) == len(uuids)
    assert all(len(uuid) == 36 and uuid == uuid.lower() for pair in uuids for uuid in pair)
    assert BY_NAME[profile.name] is profile
    with pytest.raises(KeyError):
        profile.channel("cc2650/nothing")


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


@pytest.mark.parametrize("profile", PROFILES, ids=lambda profile: profile.name)
def test_the_decoder_takes_every_setup_write_as_a_packet(profile: Profile) -> None:
    decoder = Decoder(site=Site.LEFT_FOOT)
    for write in profile.setup:
        assert decoder.feed(Packet(1.0, Site.LEFT_FOOT, write.channel, write.value)) == []


def test_setup_writes_are_what_wire_parses() -> None:
    def value(profile: Profile, channel: str) -> bytes:
        return next(write.value for write in profile.setup if write.channel == channel)

    assert parse_control(value(INSOLE, "insole/control")) == StartSampling()
    formats = {**cc2541.FORMATS, **cc2650.FORMATS}
    assert cc2650.DRIVER.read("cc2650/movement-config", value(CC2650, "cc2650/movement-config"), {}) == Reading(
        silent=False, known={"acc_range": 8, "has_acc": True, "has_gyro": True, "has_mag": True}
    )
    for profile in (CC2541, CC2541_20HZ):
        acc, gyro = "cc2541/accelerometer-config", "cc2541/gyroscope-config"
        assert parse_whole(formats[acc], value(profile, acc)).code == 3
        assert all(parse_whole(formats[gyro], value(profile, gyro)).axes)
    for profile, channel in (
        (CC2650, "cc2650/movement-period"),
        (CC2541, "cc2541/accelerometer-period"),
        (CC2541, "cc2541/gyroscope-period"),
        (CC2541_20HZ, "cc2541/accelerometer-period"),
        (CC2541_20HZ, "cc2541/gyroscope-period"),
    ):
        period = parse_whole(formats[channel], value(profile, channel)).period
        assert period == pytest.approx(1.0 / profile.nominal_rate)
