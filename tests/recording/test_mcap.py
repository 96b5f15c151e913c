"""Export to MCAP: the library's reader gets the same packets, samples and events as a session."""

import io
import json
from base64 import b64decode
from collections.abc import Iterable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path

import declared
import pytest
import walks

from solepath import Packet, Sample, Site
from solepath.emulate import CC2650, Radio, Route, emulate
from solepath.link.decoder import Decoder
from solepath.recording import RecordingError

pytest.importorskip("mcap", reason="the extra mcap is not installed")
from mcap.reader import make_reader  # noqa: E402
from mcap.records import Message  # noqa: E402
from mcap.stream_reader import StreamReader  # noqa: E402

from solepath.recording.mcap import McapWriter  # noqa: E402

START = {"began": "2026-11-21T09:30:00.25Z", "began_t": 2.0}
TIME_AT_ZERO = int(datetime(2026, 11, 21, 9, 29, 58, 250_000, UTC).timestamp() * 1000) * 1_000_000
"""Time since 1970 at t = 0, ns."""
LEFT = Site.LEFT_FOOT


def write_mcap(path: Path, packets: Iterable[Packet], **header) -> Path:
    with McapWriter(path, header) as writer:
        for packet in packets:
            writer.write(packet)
    return path


def messages(path: Path) -> dict[str, list[tuple[int, int, dict]]]:
    """Return (log time, publish time, content) of each message by topic, in the order of the file."""
    content_by_topic: dict[str, list[tuple[int, int, dict]]] = {}
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages(log_time_order=False):
            assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            content = json.loads(message.data)
            check_schema(content, json.loads(schema.data))
            content_by_topic.setdefault(channel.topic, []).append((message.log_time, message.publish_time, content))
    return content_by_topic


PYTHON_TYPES = {"number": (int, float), "string": str, "boolean": bool, "object": dict, "array": list}


def check_schema(value: object, schema: dict) -> None:
    """Check the part of JSON Schema used here: every key of the schema has the type that it declares, or is null."""
    assert value is None or not schema or isinstance(value, PYTHON_TYPES[schema["type"]])
    if isinstance(value, dict):
        assert value.keys() & schema["properties"].keys()
        for key, inner in schema["properties"].items():
            if key in value:
                check_schema(value[key], inner)


@pytest.fixture(scope="module")
def exported(tmp_path_factory) -> dict[str, list[tuple[int, int, dict]]]:
    return messages(write_mcap(tmp_path_factory.mktemp("mcap") / "walk.mcap", walks.insoles().packets, **START))


def test_the_packets_in_it_are_those_that_were_recorded_in_their_order(tmp_path):
    packets = [Packet(p.t, p.site, p.channel, p.data, f"F0:{p.site.value}") for p in walks.insoles().packets[:300]]
    path = write_mcap(tmp_path / "walk.mcap", packets)
    read = []
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages(log_time_order=False):
            if "channel" in channel.metadata:
                fields = json.loads(message.data)
                site, name = Site(channel.metadata["site"]), channel.metadata["channel"]
                assert channel.topic == f"/{site.value}/packets/{name}"
                read.append(Packet(fields["t"], site, name, b64decode(fields["data"]), fields["device"]))
    assert read == packets


def test_log_times_are_those_of_the_wall_where_the_recording_knows_it(exported, tmp_path):
    packets = walks.insoles().packets
    first = next(p for p in packets if p.site is LEFT and p.channel == "insole/frame")
    assert exported["/left_foot/packets/insole/frame"][0][0] == TIME_AT_ZERO + round(first.t * 1e9)
    plain = messages(write_mcap(tmp_path / "plain.mcap", packets[:20]))
    assert {round(t * 1e-9, 6) for rows in plain.values() for t, _, _ in rows} >= {round(p.t, 6) for p in packets[:20]}
    start = {"began": "2026-11-21T09:29:58.25Z"}
    later = messages(write_mcap(tmp_path / "first.mcap", packets[:20], **start))
    assert min(t for name, rows in later.items() if "packets" in name for t, _, _ in rows) == TIME_AT_ZERO


def content_of(sample: Sample) -> dict:
    """Return what a message has of a sample: every quantity that the device gave."""
    vectors = {name: getattr(sample, name) for name in ("acc", "gyro", "mag", "quat", "pressure")}
    fields: dict = {name: list(vector) for name, vector in vectors.items() if vector is not None}
    if sample.air_pressure is not None:
        fields["air_pressure"] = sample.air_pressure
    same = {"t": sample.t, "known_at": sample.known_at, "saturated": sample.saturated}
    return fields | same | {"site": sample.site.value}


@pytest.mark.parametrize("name", ["two insoles", "orphe", "cc2650"])
def test_the_samples_in_it_are_what_the_link_made_of_the_packets(exported, tmp_path, name):
    route = Route().stand(1).walk(2).stop(1)
    (worn,) = (one for one in declared.EVERY if one.driver.name == "orphe")
    packets = {
        "two insoles": lambda: walks.insoles().packets,
        "orphe": lambda: declared.walked(worn, route, Radio()),
        "cc2650": lambda: emulate(route, devices={LEFT: CC2650()}, seed=7).packets,
    }[name]()
    found = exported if name == "two insoles" else messages(write_mcap(tmp_path / "walk.mcap", packets, **START))
    decoder = Decoder(LEFT)
    samples = [s for p in packets if p.site is LEFT for s in decoder.feed(p) if isinstance(s, Sample)]
    samples += [s for s in decoder.finish() if isinstance(s, Sample)]
    assert len(samples) > 30
    expected = [
        (TIME_AT_ZERO + round(s.t * 1e9), TIME_AT_ZERO + round(s.known_at * 1e9), content_of(s)) for s in samples
    ]
    assert found["/left_foot/samples"] == expected
    given = {"two insoles": {"pressure", "saturated"}, "orphe": {"quat", "pressure"}, "cc2650": {"mag", "air_pressure"}}
    assert given[name] <= {key for _, _, content in expected for key in content}


def test_the_events_in_it_are_a_sessions(exported):
    expected: dict[str, list] = {}
    for event in walks.run_session(walks.insoles().packets, poses=True):
        content = json.loads(json.dumps(event.to_dict()))
        place = f"/{content['foot']}_foot" if content.get("foot") else ""
        times = (TIME_AT_ZERO + round(t * 1e9) for t in (event.t, event.known_at))
        expected.setdefault(f"{place}/{content['event']}", []).append((*times, content))
    assert {
        name: rows for name, rows in exported.items() if "/packets" not in name and "/samples" not in name
    } == expected
    assert len(expected["/left_foot/StrideTaken"]) >= 3 and len(expected["/right_foot/HeelStrike"]) >= 3
    assert len(expected["/left_foot/FootMoved"]) > 100 and "/ActivityChanged" in expected


def test_of_a_torn_file_all_but_the_last_chunk_is_read(tmp_path):
    """Cut in the middle, the file holds the messages of every chunk that is whole, in their order."""
    content = write_mcap(tmp_path / "walk.mcap", walks.insoles().packets[:600]).read_bytes()
    read: list[list[Message]] = []
    for part in (content, content[: len(content) // 2]):
        read.append([])
        with suppress(Exception):  # whatever the library says of an end in the middle
            read[-1] += (one for one in StreamReader(io.BytesIO(part)).records if isinstance(one, Message))
    whole, half = read
    assert half == whole[: len(half)] and len(half) > 0.35 * len(whole)


ODD_PACKETS = [
    Packet(-5.0, LEFT, "insole/frame", b""),
    Packet(1e300, LEFT, "\ud800/x", b"\xff", "\udfff"),
    Packet(0.0, Site.PELVIS, "", b"\x00"),
    *[Packet(1.0 + k, LEFT, f"odd/{k}", b"") for k in range(1200)],
]


def test_whatever_a_recording_holds_can_be_exported(tmp_path):
    path = tmp_path / "odd.mcap"
    with McapWriter(path, {"began": "never", "\ud800": "\ud800"}) as writer:
        for packet in ODD_PACKETS:
            writer.write(packet)
        with pytest.raises(ValueError, match="a packet at nan s cannot be recorded"):
            writer.write(Packet(float("nan"), LEFT, "insole/frame", b""))
    assert writer.count == len(ODD_PACKETS)
    with path.open("rb") as file:
        (header,) = (one.metadata for one in make_reader(file).iter_metadata())
    assert header == {"format": "solepath-packets", "version": "1", "began": "never", "?": "?"}
    content_by_topic = messages(path)
    assert sum(len(rows) for topic, rows in content_by_topic.items() if "/packets" in topic) == len(ODD_PACKETS)
    assert 1000 <= len(content_by_topic) < 1010


def test_a_file_with_content_is_not_replaced(tmp_path):
    path = tmp_path / "walk.mcap"
    path.write_bytes(b"of another program")
    with pytest.raises(RecordingError, match="walk.mcap: exists, and is not replaced"):
        McapWriter(path)
    assert path.read_bytes() == b"of another program"


def test_what_cannot_be_written_is_one_clear_error(tmp_path):
    with pytest.raises(RecordingError, match="none/walk.mcap: no such file or directory"):
        McapWriter(tmp_path / "none" / "walk.mcap")
    if not Path("/dev/full").is_char_device():
        pytest.skip("no /dev/full on this system")
    with pytest.raises(RecordingError, match=r"/dev/full: no space left on device; \d+ packets were taken"):
        write_mcap(Path("/dev/full"), walks.insoles().packets)
