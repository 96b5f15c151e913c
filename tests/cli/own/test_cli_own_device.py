"""Tests devices of one's own on the command line: --driver, and what is said about channels that nobody knows."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest
from attrs import evolve
from commands import rows_in, run, run_failing
from here import EXAMPLES
from programs import emulator
from programs import run as run_program
from recordings import recorded
from snooped import LEFT, T_START, Log, start_connection

from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.walker import Walker
from solepath.recording import read_packets
from solepath.types import Foot, Packet, Site

OWN = EXAMPLES / "own_device.py"
WALKER = Walker(Route().stand(2.0).walk(8.0, speed=1.3).stop(1.5), seed=3)
STRIDES = len(WALKER.truth().strides(Foot.LEFT))
RENAMED = """
from attrs import evolve
from solepath.link.devices.cc2650 import DRIVER
from solepath.link.driver import Driver

def tag(name):
    return name.replace("cc2650/", "tag/")

profile = DRIVER.profile
PROFILE = evolve(
    profile,
    name="tag",
    channels=tuple(evolve(one, name=tag(one.name)) for one in profile.channels),
    setup=tuple(
        evolve(one, channel=tag(one.channel), then_read=tuple(map(tag, one.then_read))) for one in profile.setup
    ),
    reads=tuple(map(tag, profile.reads)),
    streams=tuple(map(tag, profile.streams)),
)
formats = {tag(name): one for name, one in DRIVER.formats.items()}
readers = {tag(name): one for name, one in DRIVER.readers.items()}
TAG = evolve(DRIVER, profile=PROFILE, formats=formats, readers=readers)
"""


@pytest.fixture(scope="module")
def packets() -> list[Packet]:
    """Return a walk with the device of examples/own_device.py on the left foot."""
    own = runpy.run_path(str(OWN))
    found = []
    for k, true in enumerate(WALKER.samples(Foot.LEFT, 100.0)):
        value = {
            "number": k,
            "ticks": round(4096 * true.t) % 65536,
            "acc": [round(v / own["ACC"]) for v in true.acc or ()],
            "gyro": [round(v / own["GYRO"]) for v in true.gyro or ()],
        }
        data = own["DRIVER"].write("shoe/motion", value)
        found.append(Packet(true.t + 0.008, Site.LEFT_FOOT, "shoe/motion", data))
    return found


@pytest.fixture(scope="module")
def walk(packets: list[Packet], folder: Path) -> Path:
    return recorded(folder / "own.jsonl", packets)


def test_a_recording_of_which_nothing_is_known_is_an_error_of_track(walk: Path, tmp_path: Path) -> None:
    line = run_failing("track", walk, "--out", tmp_path / "out")
    count = len(list(read_packets(walk)))
    assert f"own.jsonl, recipe default: left foot: {count} of {count} packets are of a channel that no known" in line
    assert "(shoe/motion)" in line and "--driver FILE.py" in line
    assert not list((tmp_path / "out").iterdir())


def test_and_a_finding_of_check(walk: Path) -> None:
    done = run("check", walk)
    assert done.returncode == 1 and "nothing needs fixing" not in done.stdout
    heading, finding = done.stdout.splitlines()[1:3]
    assert heading == "needs fixing:" and "shoe/motion" in finding and "--driver FILE.py" in finding


def test_a_layout_that_does_not_fit_is_an_error_though_the_setup_is_understood(
    packets: list[Packet], tmp_path: Path
) -> None:
    # Only the packets of a channel other than the stream can be used: there is no sample.
    (tmp_path / "long.py").write_text(
        OWN.read_text()
        .replace("Path(__file__)", f"Path({str(OWN)!r})")
        .replace("Struct(", 'Struct("pad" / Int16ul, ', 1)
    )
    walk = recorded(tmp_path / "own.jsonl", [Packet(0.0, Site.LEFT_FOOT, "shoe/start", b"\xc2"), *packets])
    sentence = f"left foot: only 1 of {len(packets) + 1} packets can be used (truncated {len(packets)})"
    line = run_failing("track", walk, "--driver", tmp_path / "long.py", "--out", tmp_path / "out")
    assert sentence in line and "the layout (of a driver, its Struct) does not fit these bytes" in line
    assert not list((tmp_path / "out").iterdir())
    done = run("check", walk, "--driver", tmp_path / "long.py")
    assert done.returncode == 1 and sentence in done.stdout and "nothing needs fixing" not in done.stdout


@pytest.mark.soak
def test_every_second_packet_cut_is_a_fault_and_a_bad_radio_is_none(tmp_path: Path) -> None:
    good = list(emulate(WALKER.route, seed=3).packets)
    cut = [evolve(one, data=one.data[: len(one.data) // (1 + k // 2 % 2)]) for k, one in enumerate(good)]
    walk = recorded(tmp_path / "cut.jsonl", cut)
    done = run("check", walk)
    must = done.stdout.partition("worth knowing")[0]
    assert done.returncode == 1 and must.count("truncated means shorter than the layout") == 2
    done = run("track", walk)
    assert done.returncode == 0 and done.stderr.count("truncated means") == 2
    # Radio.corrupt of 0.05 is ten times what the demo has; a relay that sends everything twice takes nothing away.
    noisy = Radio(loss=0.05, duplicate=1.0, corrupt=0.05, latency=0.015, jitter=0.03)
    done = run("check", recorded(tmp_path / "noisy.jsonl", list(emulate(WALKER.route, seed=3, radio=noisy).packets)))
    assert "duplicate" in done.stdout and " means " not in done.stdout


def test_the_example_is_a_device_of_track_and_check(walk: Path, tmp_path: Path) -> None:
    done = run("track", walk, "--driver", OWN, "--out", tmp_path / "out")
    assert done.returncode == 0 and "rejected" not in done.stdout
    assert len(rows_in(tmp_path / "out" / "strides.csv")) == STRIDES
    done = run("check", walk, "--driver", OWN)
    assert done.returncode == 0 and f"left foot {STRIDES} strides" in done.stdout


def test_a_phone_s_log_of_it_is_converted(packets: list[Packet], tmp_path: Path) -> None:
    motion = runpy.run_path(str(OWN))["MOTION"]
    log = start_connection(Log(), characteristics={0x12: motion.characteristic})
    for packet in packets:
        log.notify(0x40, 0x12, packet.data, t=T_START + 1_000_000 + round(packet.t * 1e6))
    words = ["convert", log.save(tmp_path / "phone.log"), tmp_path / "walk.jsonl", "--site", f"{LEFT}=left_foot"]
    assert "holds no packets of a device" in run_failing(*words)
    assert run(*words, "--driver", OWN).returncode == 0
    done = run("track", tmp_path / "walk.jsonl", "--driver", OWN, "--out", tmp_path / "out")
    assert done.returncode == 0 and len(rows_in(tmp_path / "out" / "strides.csv")) == STRIDES


BAD = {
    "absent.py": (None, "absent.py: there is no such file"),
    "built_in.py": ("from solepath.link.devices.cc2650 import DRIVER", "built_in.py: no variable of it holds a Driver"),
    "raises.py": ("x = 1\ny = x / 0", "raises.py: line 2: ZeroDivisionError: division by zero"),
    "syntax.py": ("x = 1\ny = (", "syntax.py: line 2: SyntaxError: '(' was never closed"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_file_without_a_device_gets_one_line(
    name: str, walk: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text, expected = BAD[name]
    if text is not None:
        (tmp_path / name).write_text(text)
    assert expected in run_failing("track", walk, "--driver", tmp_path / name)
    monkeypatch.chdir(tmp_path)
    assert f"--driver {expected}" in run_failing("track", walk, "--driver", name)


def test_a_slip_in_a_reader_gets_one_line(walk: Path, tmp_path: Path) -> None:
    text = OWN.read_text().replace("Path(__file__)", f"Path({str(OWN)!r})").replace("sent.number", "sent.numbr")
    number = 1 + next(k for k, line in enumerate(text.splitlines()) if "sent.numbr" in line)
    (tmp_path / "slip.py").write_text(text)
    line = run_failing("track", walk, "--driver", tmp_path / "slip.py")
    assert f"slip.py: line {number}: AttributeError: numbr" in line


@pytest.mark.soak
def test_a_sensor_is_recorded_as_a_device_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "tag.py").write_text(RENAMED)
    file, driver = tmp_path / "walk.jsonl", ("--driver", tmp_path / "tag.py")
    with emulator("--distance", 20, "--device", "cc2650") as (_, where):
        options = ("--via", where, "--left", "F0:5E:00:00:00:01", "--duration", 4)
        run_program("record", "--out", file, *options, *driver)
    channels = {packet.channel for packet in read_packets(file)}
    assert "tag/movement" in channels and not any(name.startswith("cc2650/") for name in channels)
    assert run("check", file).returncode == 1
    assert run("track", file, *driver).returncode == 0
