"""Soles of pressure cells alone, on the command line: samples, losses, contacts, and no distance."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from commands import run
from recordings import recorded

from solepath import Layout
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.insoles import layout
from solepath.types import SITE_OF_FOOT, Foot, Packet

DEVICE = """
from construct import Array, Float32l, Int8ul, Struct
from solepath.emulate.sensors.insoles import layout
from solepath.link.driver import Driver, Measured, Reading
from solepath.link.profile import Access, Channel, Profile
from solepath.types import Foot

DATA = Channel("cells/data", "180a", "2a29", Access.NOTIFY)
PROFILE = Profile(
    name="cells", names=("Cells",), services=(), channels=(DATA,), streams=("cells/data",),
    nominal_rate=50.0, stale_after=1.0,
)

def data(sent, known):
    measured = Measured(MEASURED)
    return Reading((measured,), sequence=sent.number, layout=LAYOUT)

FORMAT = Struct("number" / Int8ul, "cells" / Array(24, Float32l))
DRIVER = Driver(PROFILE, {"cells/data": FORMAT}, {"cells/data": data}, sequence=256)
"""
CELLS: Layout = layout(24, Foot.LEFT)
LOST = range(77, 1400, 100)
WALKED = list(Walker(Route().stand(2).walk(24).stop(2), seed=3).samples(Foot.LEFT, 50.0, layout=CELLS))


def sole(folder: Path, measured: str, known_layout: str) -> tuple[Path, Path]:
    """Write the driver of a sole that measures `measured`, and a walk with it in which the packets of LOST are lost."""
    driver = folder / "cells.py"
    driver.write_text(DEVICE.replace("MEASURED", measured).replace("LAYOUT", known_layout))
    scope: dict = {}
    exec(driver.read_text(), scope)
    packets = []
    for k, true in enumerate(WALKED):
        values = true.pressure if "pressure" in measured else [*true.acc, *[0.0] * 21]
        value = scope["DRIVER"].write("cells/data", {"number": k % 256, "cells": list(values)})
        if k not in LOST:
            packets.append(Packet(true.t + 0.01, SITE_OF_FOOT[Foot.LEFT], "cells/data", value))
    return driver, recorded(folder / "walk.jsonl", packets)


OF_CELLS = "pressure=tuple(sent.cells)"
SENSORS = {
    "cells": (OF_CELLS, "None"),
    "cells at known places": (OF_CELLS, "layout(24, Foot.LEFT)"),
    "an accelerometer": ("acc=tuple(sent.cells[:3])", "None"),
}


@pytest.mark.parametrize("sensor", SENSORS)
def test_samples_rate_and_losses_are_those_of_whatever_the_device_measures(sensor: str, tmp_path: Path) -> None:
    driver, walk = sole(tmp_path, *SENSORS[sensor])
    lost = len([k for k in LOST if k < len(WALKED)])
    done = run("track", walk, "--driver", driver, "--out", tmp_path / "out", "--report", tmp_path / "report.html")
    plain = run("track", walk, "--driver", driver)
    (row,) = [line.split() for line in plain.stdout.splitlines() if line.startswith("left  ")]
    assert row in [line.split() for line in done.stdout.splitlines()]
    assert row[1:3] == [str(len(WALKED) - lost), "50.0"]
    assert row[3:5] == ["-", "-"], "strides and distance cannot be known"
    share = f"{lost} of {len(WALKED)} samples missing"
    assert share in plain.stdout and share in run("check", walk, "--driver", driver).stdout
    assert share in (tmp_path / "report.html").read_text()
    (link,) = json.loads((tmp_path / "out" / "run.json").read_text())["sites"].values()
    assert (link["samples"], link["missing"]) == (len(WALKED) - lost, lost)
    assert link["missing_share"] == pytest.approx(lost / len(WALKED), abs=1e-6)


def test_outcomes_of_cells_alone_have_no_turns_and_no_distance(tmp_path: Path) -> None:
    driver, walk = sole(tmp_path, *SENSORS["cells at known places"])
    done = run("track", walk, "--driver", driver, "--out", tmp_path / "out", "--outcomes", "--test", "six-minute")
    assert "Walked an unknown distance" in done.stdout and "turns about" not in done.stdout
    (bout,) = csv.DictReader((tmp_path / "out" / "bouts.csv").open())
    assert (bout["turns"], bout["stride_length_m"], bout["strides"]) == ("", "", "16")
    rows = csv.DictReader((tmp_path / "out" / "outcomes.csv").open())
    known = {row["outcome"]: row["value"] for row in rows}
    assert known["turns_all_sum"] == known.get("distance", "") == "" and known["wb_all_sum"] == "1"


def test_check_says_what_cells_alone_show_and_nothing_of_sensors_that_are_not_there(tmp_path: Path) -> None:
    driver, walk = sole(tmp_path, *SENSORS["cells"])
    done = run("check", walk, "--driver", driver)
    assert done.returncode == 0 and "left foot 16 gait cycles" in done.stdout.splitlines()[0]
    assert "its pressure cells show contacts, and no strides and no track" in done.stdout
    assert "too few strides" not in done.stdout and "gyroscope whose scale" not in done.stdout
