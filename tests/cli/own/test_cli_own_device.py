"""Tests devices of one's own on the command line: --driver, and what is said about channels that nobody knows."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest
from commands import rows_in, run, run_failing
from here import EXAMPLES
from recordings import recorded

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.recording import read_packets
from solepath.types import Foot, Packet, Site

OWN = EXAMPLES / "own_device.py"
WALKER = Walker(Route().stand(2.0).walk(8.0, speed=1.3).stop(1.5), seed=3)
STRIDES = len(WALKER.truth().strides(Foot.LEFT))


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
    assert done.returncode == 1 and "nothing must be mended" not in done.stdout
    heading, finding = done.stdout.splitlines()[1:3]
    assert heading == "must be mended:" and "shoe/motion" in finding and "--driver FILE.py" in finding


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
    assert done.returncode == 1 and sentence in done.stdout and "nothing must be mended" not in done.stdout


def test_the_example_is_a_device_of_track_and_check(walk: Path, tmp_path: Path) -> None:
    done = run("track", walk, "--driver", OWN, "--out", tmp_path / "out")
    assert done.returncode == 0 and "rejected" not in done.stdout
    assert len(rows_in(tmp_path / "out" / "strides.csv")) == STRIDES
    done = run("check", walk, "--driver", OWN)
    assert done.returncode == 0 and f"left foot {STRIDES} strides" in done.stdout


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
