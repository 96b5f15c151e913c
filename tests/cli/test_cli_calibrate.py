"""Tests `solepath calibrate`, and the commands that use what it writes."""

import json
import subprocess
import sys
from math import pi
from pathlib import Path

import numpy as np
import pytest
from commands import run, run_failing
from recordings import recorded

from solepath.calibration import Calibration, InsoleCalibration, Limbs
from solepath.calibration.file import read_calibration, write_calibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.suit import suit
from solepath.emulate.walk import emulate
from solepath.recipes import NAMES, by_name
from solepath.types import Foot, Site, WalkingMode
from solepath.types.attrs import evolve
from solepath_lab.emulated.boot import boot
from solepath_lab.emulated.laps import marked, marks, square, straight

ROUTE = Route().stand(2.0).walk(8.0, speed=1.3).stop(1.5)
FEET = (Site.LEFT_FOOT, Site.RIGHT_FOOT)
PRESSED = [name for name in NAMES if by_name(name).needs_pressure]


@pytest.fixture(scope="module")
def packets(folder) -> Path:
    walk = emulate(ROUTE, devices=dict.fromkeys(FEET, Insole(rate=30.0)), seed=3)
    return recorded(folder / "insoles.jsonl", walk.packets)


@pytest.fixture(scope="module")
def bare(folder) -> Path:
    """Write a recording of a foot that stands, without pressure."""
    t = np.arange(200) / 100.0
    np.savez(folder / "imu_only.npz", t=t, acc=np.tile([0.0, 0.0, 9.81], (200, 1)), gyro=np.zeros((200, 3)))
    return folder / "imu_only.npz"


def test_a_recipe_of_pressure_rejects_samples_without_any(bare):
    assert PRESSED
    for name in PRESSED:
        expected = f"solepath: recipe {name} needs pressure cells; {bare} has none\n"
        assert run_failing("track", bare, "--recipe", name) == expected


POSTURES = "pitch_deg,L_r_m,L_p2t_m\n" + "".join(
    f"{degrees},{0.07 + 0.0006 * degrees:.4f},{0.09 - 0.0006 * degrees:.4f}\n" for degrees in (0, 15, 30, 45, 60)
)
GAUGE = "counts,newtons\n" + "".join(f"{counts},{0.1 * counts:.1f}\n" for counts in (60, 100, 400, 800, 1200, 1900))


def calibrated(path: Path) -> Calibration:
    json.loads(path.read_text(), parse_constant=pytest.fail)
    return read_calibration(path)


def test_noise_of_a_walk_is_learnt_for_every_cell_of_both_feet(packets, tmp_path):
    out = tmp_path / "me.json"
    result = run("calibrate", "noise", packets, "--out", out)
    assert result.returncode == 0 and result.stderr == ""
    header, _, left, right, last = result.stdout.splitlines()
    assert header.split() == ["foot", "cells", "mean", "noise", "largest"]
    assert left.split()[:2] == ["left", "96"] and right.split()[:2] == ["right", "96"]
    assert last == f"written to {out}"
    learnt = calibrated(out)
    assert all(len(learnt.insole(foot).noise) == 96 for foot in Foot) and learnt.shoe is None
    assert run("track", packets, "--recipe", PRESSED[0], "--calibration", out).returncode == 0


def test_what_is_learnt_goes_beside_what_the_file_holds_already(tmp_path):
    out, postures, gauge = tmp_path / "me.json", tmp_path / "postures.csv", tmp_path / "gauge.csv"
    noise = {Foot.LEFT: InsoleCalibration(noise=(0.5, 1.0)), Foot.RIGHT: InsoleCalibration(noise=(0.1, 0.2))}
    write_calibration(out, Calibration(insoles=noise, weight=700.0))
    postures.write_text(POSTURES)
    gauge.write_text(GAUGE)
    shoe = run("calibrate", "shoe", postures, "--out", out)
    assert shoe.stdout.startswith("5 measurements of 5 postures, flat to 60 degrees: rms error of L_r 0.0 mm")
    newton = run("calibrate", "newton", gauge, "--foot", "left", "--out", out)
    assert newton.stdout.startswith("left: N = ") and "6 points, rms error 0.00 N" in newton.stdout
    assert shoe.returncode == newton.returncode == 0
    found = calibrated(out)
    assert found.weight == 700.0
    assert newton.stdout.splitlines()[1] == (
        "forces below 5 N count as 0, and those above 190 N, the largest of the gauge, as 190 N"
    )
    assert found.insole(Foot.LEFT).noise == (0.5, 1.0), "newtons cost nothing that was learnt before"
    assert found.insole(Foot.LEFT).newtons.coefficients == pytest.approx((0.0, 0.1, 0.0, 0.0), abs=1e-9)
    assert found.insole(Foot.RIGHT) == InsoleCalibration(noise=(0.1, 0.2))
    assert found.shoe.forefoot_radius[0] == pytest.approx(0.07)


def there_and_back() -> Route:
    route = Route().stand(6.0).walk(9.0)
    for turn in (-pi, pi, -pi):
        route = route.turn(turn, 0.6).walk(9.0)
    return route.stop(2.0)


@pytest.mark.soak
@pytest.mark.parametrize(
    ("kind", "route", "devices", "learnt"),
    [
        ("square", square(3), {Site.RIGHT_FOOT: boot(Foot.RIGHT, 50.0)}, "drift"),
        ("walk", there_and_back(), dict.fromkeys(FEET, Insole()), "headings"),
        ("modes", marked(WalkingMode.STRAIGHT, 14), dict.fromkeys(FEET, Insole(rate=50.0)), "modes"),
    ],
)
def test_each_kind_learns_from_its_walk_for_the_feet_that_wear_a_sensor(tmp_path, kind, route, devices, learnt):
    walk, out = emulate(route, devices=devices, seed=2), tmp_path / "me.json"
    more = []
    if kind == "modes":
        found = [one for one in marks(walk.walker) if one.mode is not WalkingMode.STANDING]
        rows = [f"{one.foot.value},{one.x:.4f},{one.y:.4f},{one.mode.name},{one.t:.3f}" for one in found]
        (tmp_path / "marks.csv").write_text("\n".join(["foot,x,y,mode,t", *rows]))
        more = [tmp_path / "marks.csv", "--heading", "0"]
    result = run("calibrate", kind, recorded(tmp_path / "walk.jsonl", walk.packets), *more, "--out", out)
    assert (result.returncode, result.stderr) == (0, "")
    assert set(getattr(calibrated(out), learnt)) == {site.foot for site in devices}


@pytest.mark.soak
def test_a_stand_with_seven_body_sensors_gives_limbs_and_a_walk_with_them_takes_a_heading(tmp_path):
    walk = emulate(straight(5.0, 1.1), devices=suit(Limbs(), 3), seed=2)
    stand, out = recorded(tmp_path / "stand.jsonl", walk.packets), tmp_path / "me.json"
    result = run("calibrate", "limbs", stand, "--stature", "1.75", "--spines", "0.25", "--out", out)
    assert result.returncode == 0 and result.stderr == ""
    assert [line.split()[0] for line in result.stdout.splitlines()[2:4]] == ["pelvis", "left"]
    assert calibrated(out).limbs == evolve(Limbs(), hip_width=0.18)
    result = run("track", stand, "--recipe", "walking-modes", "--calibration", out, "--heading", "0")
    assert result.returncode == 0 and "STRAIGHT" in result.stdout
    failed = run_failing("track", stand, "--heading", "0")
    assert failed == "solepath: --heading: recipe default finds the first heading by itself and takes none\n"


def test_unusable_input_is_rejected_in_one_line_and_nothing_is_written(packets, bare, tmp_path):
    out, odd = tmp_path / "me.json", tmp_path / "odd.csv"
    odd.write_text("pitch_deg,L_r_m\n0,0.07\n")
    for arguments, complaint in [
        (("noise", bare), "no pressure cells in this recording"),
        (("shoe", odd), "odd.csv, line 1: needs one column L_p2t_m"),
        (("square", packets), "strides are less than 3 laps of 40 marks"),
        (("square", packets, "--recipe", "default"), "recipe default takes no drift off"),
        (("walk", packets), "straight legs of 6 m and more, of which 4 are needed"),
        (("modes", packets), "takes two files for each walk"),
        (("modes", packets, odd), "odd.csv, line 1: needs one column foot"),
    ]:
        assert complaint in run_failing("calibrate", *arguments, "--out", out), arguments
        assert not out.exists()


def test_a_file_that_is_no_calibration_is_not_overwritten(tmp_path):
    out, gauge = tmp_path / "notes.txt", tmp_path / "gauge.csv"
    out.write_text("my notes")
    gauge.write_text(GAUGE)
    assert "notes.txt: is not JSON" in run_failing("calibrate", "newton", gauge, "--out", out)
    assert out.read_text() == "my notes"
    assert "there is no folder" in run_failing("calibrate", "newton", gauge, "--out", tmp_path / "none" / "me.json")


def test_a_device_without_end_is_no_calibration_and_gets_none(bare, tmp_path):
    (tmp_path / "postures.csv").write_text(POSTURES)
    assert "/dev/zero: is larger than 8 MB" in run_failing("track", bare, "--calibration", "/dev/zero")
    write = ("calibrate", "shoe", tmp_path / "postures.csv", "--out", "/dev/full")
    assert "/dev/full: is no regular file" in run_failing(*write)


def test_an_impossible_calibration_does_not_replace_a_known_one(tmp_path):
    out, below = tmp_path / "me.json", tmp_path / "below.npz"
    write_calibration(out, Calibration(weight=700.0))
    np.savez(below, t=np.arange(400) / 50.0, pressure=np.full((400, 4), -1e7))
    why = run_failing("calibrate", "noise", below, "--out", out)
    assert "nothing is written" in why and "insoles.right.noise[0] is -1e+07" in why
    assert calibrated(out) == Calibration(weight=700.0)


def test_streams_that_are_closed_stop_nothing(bare):
    command = f'"{sys.executable}" -m solepath track "{bare}" <&- >&- 2>&-'
    result = subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0 and "Traceback" not in result.stderr
