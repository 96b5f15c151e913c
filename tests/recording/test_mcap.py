"""Export to MCAP: the library's reader gets the same packets, samples and events as a session."""

import io
import json
import struct
from base64 import b64decode
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path

import pytest
import walks
from toys import NUMBERED

from solepath import FootMoved, Packet, Sample, Site, StrideTaken
from solepath.events import LiveEvent
from solepath.link.decoder import Decoder
from solepath.recording import RecordingError

pytest.importorskip("mcap", reason="the extra mcap is not installed")
from mcap.exceptions import EndOfFile  # noqa: E402
from mcap.opcode import Opcode  # noqa: E402
from mcap.reader import make_reader  # noqa: E402
from mcap.records import Message  # noqa: E402
from mcap.stream_reader import StreamReader  # noqa: E402

from solepath.recording.mcap import McapWriter  # noqa: E402

START = {"began": "2026-11-21T09:30:00.25Z", "began_t": 2.0}
TIME_AT_ZERO = int(datetime(2026, 11, 21, 9, 29, 58, 250_000, UTC).timestamp() * 1000) * 1_000_000
"""Time since 1970 at t = 0, ns."""
LEFT = Site.LEFT_FOOT
MAGIC = b"\x89MCAP0\r\n"


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


PYTHON_TYPES = {"number": (int, float), "string": str, "integer": int, "boolean": bool, "object": dict}


def check_schema(value: object, schema: dict) -> None:
    """Check the part of JSON Schema used here: every key of the schema has the type that it declares."""
    assert isinstance(value, PYTHON_TYPES[schema["type"]])
    if isinstance(value, dict):
        assert value.keys() & schema["properties"].keys()
        for key, inner in schema["properties"].items():
            if key in value:
                check_schema(value[key], inner)


@pytest.fixture(scope="module")
def exported(tmp_path_factory) -> dict[str, list[tuple[int, int, dict]]]:
    return messages(write_mcap(tmp_path_factory.mktemp("mcap") / "walk.mcap", walks.insoles().packets, **START))


@pytest.mark.parametrize("name", ["fragments", "cc2650"])
def test_the_packets_in_it_are_those_that_were_recorded_in_their_order(tmp_path, name):
    packets = [Packet(p.t, p.site, p.channel, p.data, f"F0:{p.site.value}") for p in walks.packets()[name]]
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


def test_the_samples_in_it_are_what_the_link_made_of_the_packets(exported):
    decoder = Decoder(LEFT)
    packets = [p for p in walks.insoles().packets if p.site is LEFT]
    samples = [s for p in packets for s in decoder.feed(p) if isinstance(s, Sample)]
    samples += [s for s in decoder.finish() if isinstance(s, Sample)]
    rows = exported["/left_foot/samples"]
    assert len(rows) == len(samples) > 700
    for (log_time, publish_time, fields), sample in zip(rows, samples, strict=True):
        assert fields["t"] == sample.t and log_time == TIME_AT_ZERO + round(sample.t * 1e9)
        assert publish_time == TIME_AT_ZERO + round(sample.known_at * 1e9)
        assert tuple(fields["acc"].values()) == sample.acc and tuple(fields["gyro"].values()) == sample.gyro
        assert fields["pressure"] == sum(sample.pressure)


def test_the_samples_in_it_are_those_that_a_session_uses_when_a_site_falls_silent(tmp_path):
    """A sample that waits for a lost packet of a silent site is used when the other site's packets let time pass."""
    packets = walks.packets()["cc2541"]
    end = packets[len(packets) // 2].t
    ends = {"cc2541/gyroscope": end - 0.15}  # of its last accelerations the gyroscope's part is missing
    packets = [p for p in packets if p.site is not LEFT or p.t < ends.get(p.channel, end)]
    decoders: dict[Site, Decoder] = {}
    used = []
    for packet in packets:
        items = decoders.setdefault(packet.site, Decoder(packet.site)).feed(packet)
        items = [i for site, d in decoders.items() if site is not packet.site for i in d.advance(packet.t)] + items
        used += items
    used += [item for decoder in decoders.values() for item in decoder.finish()]
    content_by_topic = messages(write_mcap(tmp_path / "walk.mcap", packets, **START))
    for site in decoders:
        rows = [(fields["t"], publish) for _, publish, fields in content_by_topic[f"/{site.value}/samples"]]
        samples = [item for item in used if isinstance(item, Sample) and item.site is site]
        assert rows == [(s.t, TIME_AT_ZERO + round(s.known_at * 1e9)) for s in samples]


def test_the_events_in_it_are_a_sessions(exported):
    events = walks.run_session(walks.insoles().packets, poses=True)
    as_json = [json.loads(json.dumps(e.to_dict())) for e in events if not isinstance(e, LiveEvent)]
    assert [fields for _, _, fields in exported["/events"]] == as_json
    poses = [e for e in events if isinstance(e, FootMoved) and e.foot.value == "left"]
    assert [fields["position"]["x"] for _, _, fields in exported["/left_foot/pose"]] == [e.position[0] for e in poses]
    assert {(fields["phase"], fields["phase_number"]) for _, _, fields in exported["/left_foot/pose"]} == {
        ("LOADING", 0), ("STATIONARY", 1), ("PUSH_OFF", 2), ("SWING", 3),
    }  # fmt: skip
    strides = [e for e in events if isinstance(e, StrideTaken) and e.final and e.foot.value == "left"]
    rows = exported["/left_foot/strides"]
    assert [(fields["number"], fields["stride_length"]) for _, _, fields in rows] == [
        (stride.number, stride.length) for stride in strides
    ] != []  # fmt: skip
    gait = Counter(fields["event"] for _, _, fields in exported["/left_foot/gait"])
    assert gait == Counter(
        name for e in events
        if (name := type(e).__name__) in ("HeelStrike", "FootFlat", "HeelOff", "ToeOff") and e.foot.value == "left"
    )  # fmt: skip
    assert gait["ToeOff"] >= 3


def test_of_a_torn_file_all_but_the_last_chunk_is_read(tmp_path):
    """Cut anywhere, the file holds the messages of every chunk that is whole, in their order."""
    content = write_mcap(tmp_path / "walk.mcap", walks.insoles().packets).read_bytes()
    whole = [record for record in StreamReader(io.BytesIO(content)).records if isinstance(record, Message)]
    ends, counts, offset = [0], [0], len(MAGIC)
    while offset + 9 <= len(content) - len(MAGIC):  # opcode, length, and what they are of
        opcode, size = struct.unpack_from("<BQ", content, offset)
        if opcode == Opcode.CHUNK:
            chunk = StreamReader(io.BytesIO(MAGIC + content[offset : offset + 9 + size]), skip_magic=False)
            ends.append(offset + 9 + size)
            counts.append(counts[-1] + messages_in(chunk))
        offset += 9 + size
    assert len(ends) > 20 and counts[-1] == len(whole)
    for number in (1, len(ends) // 2, len(ends) - 1):
        for cut in (ends[number] - 1, ends[number], ends[number] + 5):
            messages_read = []
            with pytest.raises(Exception):  # noqa: B017 - whatever the library says of an end in the middle
                for record in StreamReader(io.BytesIO(content[:cut])).records:
                    if isinstance(record, Message):
                        messages_read.append(record)
            assert messages_read == whole[: counts[number if cut >= ends[number] else number - 1]]


def messages_in(reader: StreamReader) -> int:
    """Return the number of messages up to the end of the data, which is no end of a file."""
    count = 0
    with suppress(EndOfFile):
        for record in reader.records:
            count += isinstance(record, Message)
    return count


ODD_PACKETS = [
    Packet(-5.0, LEFT, "insole/frame", b""),
    Packet(1e300, LEFT, "\ud800/x", b"\xff", "\udfff"),
    Packet(0.5, Site.PELVIS, "", b"\x00"),
    *[Packet(1.0 + k, LEFT, f"odd/{k}", b"") for k in range(1200)],
]


def test_whatever_a_recording_holds_can_be_exported(tmp_path):
    path = tmp_path / "odd.mcap"
    with McapWriter(path, {"began": "never", "\ud800": "\ud800"}) as writer:
        for packet in ODD_PACKETS:
            writer.write(packet)
        with pytest.raises(ValueError, match="a packet at nan s cannot be recorded"):
            writer.write(Packet(float("nan"), LEFT, "insole/frame", b""))
    assert writer.count == len(ODD_PACKETS) and writer.outside > 0
    content_by_topic = messages(path)
    assert sum(len(rows) for topic, rows in content_by_topic.items() if "/packets" in topic) == len(ODD_PACKETS)
    assert 1000 <= len(content_by_topic) < 1010


def test_a_file_with_content_is_replaced_only_on_request(tmp_path):
    path = tmp_path / "walk.mcap"
    path.write_bytes(b"of another program")
    with pytest.raises(RecordingError, match="walk.mcap: exists, and is not replaced; McapWriter"):
        McapWriter(path)
    assert path.read_bytes() == b"of another program"
    McapWriter(path, replace=True).close()
    assert path.read_bytes() == b"of another program", "no packet came"
    with McapWriter(path, replace=True) as writer:
        assert path.read_bytes() == b"of another program"
        writer.write(walks.insoles().packets[0])
    assert b"of another program" not in path.read_bytes() and messages(path)


def test_of_two_writers_of_one_file_the_second_is_rejected(tmp_path):
    path = tmp_path / "walk.mcap"
    with McapWriter(path) as writer:
        for replace in (False, True):
            with pytest.raises(RecordingError, match=r"walk\.mcap: another program is recording into it"):
                McapWriter(path, replace=replace)
        writer.write(walks.insoles().packets[0])
    assert messages(path)


def test_what_cannot_be_written_is_one_clear_error(tmp_path):
    with pytest.raises(RecordingError, match="none/walk.mcap: no such file or directory"):
        McapWriter(tmp_path / "none" / "walk.mcap")
    if not Path("/dev/full").is_char_device():
        pytest.skip("no /dev/full on this system")
    with pytest.raises(RecordingError, match=r"/dev/full: no space left on device; \d+ packets were taken"):
        write_mcap(Path("/dev/full"), walks.insoles().packets)


def test_a_device_of_an_app_s_own_is_exported_with_its_samples_and_events(tmp_path) -> None:
    def packets(first: int, last: int) -> list[Packet]:
        fields = {"ticks": 0, "count": 1, "up": [9.80665]}
        return [
            Packet(1.0 + 0.01 * k, LEFT, "toy/data", NUMBERED.write("toy/data", {"number": k, **fields}))
            for k in range(first, last)
        ]

    path = tmp_path / "own.mcap"
    with McapWriter(path, profiles=iter([NUMBERED])) as writer:
        for packet in [*packets(0, 50), *packets(53, 60)]:
            writer.write(packet)
    content_by_topic = messages(path)
    assert len(content_by_topic["/left_foot/samples"]) == 57
    assert "PacketsLost" in {content["event"] for _, _, content in content_by_topic["/events"]}
