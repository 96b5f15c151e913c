"""Runs gaitmap's own example walks through gaitmap and solepath: `python tests/bench/lab/gaitmap_walks.py`.

Asserts nothing. At first it makes an environment of its own (`--environment DIR`) of gaitmap and gaitmap_mad from PyPI;
the walks are in gaitmap's source package there. gaitmap_mad, which has its stride search, is under the AGPL; solepath
does not use it. gaitmap runs as in its example mad_gait_pipeline.py, with all default values: gravity alignment,
BarthDtw, RamppEventDetection, StrideLevelTrajectory, parameters. The patient never stands, so that there is no gravity
to align with, as in gaitmap's own example of that walk. solepath runs its default recipe, a sample at a time, on the
samples as they are.

The 2 x 20 m walk has contacts and paths of the heel from motion capture, the 4 x 10 m walk initial contacts of 14
strides. Stride length is from mid-stance to mid-stance, stride time from initial contact to initial contact, in both.
Contacts, and strides by the contact within them, are the same if they are the nearest ones and at most 0.25 s apart.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
import tomllib
import venv
from argparse import ArgumentParser
from collections.abc import Iterator
from importlib.util import find_spec
from math import radians
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
VERSION = "2.6.0"
"""Version of gaitmap and of gaitmap_mad."""
FEET = ("left", "right")
ROWS = {"contacts": "initial contact", "toe-offs": "toe-off", "times": "stride time", "lengths": "stride length"}
"""What is compared, and its name in the table."""
RUNS = 5
"""Number of runs whose times are printed."""
NEAR = 0.25
"""Largest distance of two times of the same contact, s."""


def prepare(folder: Path) -> Path:
    """Return the Python of an environment with gaitmap and its example data, which is made if it is not there."""
    bin_folder = folder / ("Scripts" if os.name == "nt" else "bin")
    python = bin_folder / "python"
    ready = folder / "ready"
    if not ready.exists():
        print(f"making {folder} (once, some minutes)", file=sys.stderr)
        venv.create(folder, with_pip=True, clear=True)
        own = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["dependencies"]
        pip = [python, "-m", "pip", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*pip, "install", f"gaitmap=={VERSION}", f"gaitmap_mad=={VERSION}", *own], check=True)
        with TemporaryDirectory() as place:
            source = ["download", "--no-deps", "--no-binary", "gaitmap", "--dest", place, f"gaitmap=={VERSION}"]
            subprocess.run([*pip, *source], check=True)
            where = "import gaitmap, pathlib; print(pathlib.Path(gaitmap.__file__).parents[1])"
            packages = subprocess.run([python, "-c", where], check=True, capture_output=True, text=True).stdout.strip()
            with tarfile.open(next(Path(place).glob("*.tar.gz"))) as archive:
                for member in archive.getmembers():
                    _, _, name = member.name.partition("/")
                    if name.startswith("example_data/"):  # beside its package, where gaitmap looks for it first
                        member.name = name
                        archive.extract(member, packages, filter="data")
        ready.touch()
    return python


def walks() -> Iterator[tuple[str, float, dict[str, Any], bool]]:
    """Yield name, rate (Hz), samples of each foot and whether the wearer stands in between."""
    from gaitmap import example_data as data

    healthy = data.get_healthy_example_imu_data()
    yield "2 x 20 m", 204.8, {foot: healthy[f"{foot}_sensor"] for foot in FEET}, True
    short = data.get_healthy_example_imu_data_ic_stride()
    yield "4 x 10 m", 102.4, {foot: short[f"{foot}_sensor"] for foot in FEET}, True
    patient = data.get_ms_example_imu_data()
    yield "patient", 102.4, {foot: patient[f"{foot}_sensor"] for foot in FEET}, False


def truth(name: str) -> dict[str, Any]:
    """Return contacts, toe-offs, stride times and lengths by foot, as far as gaitmap's data have them."""
    import numpy as np
    from gaitmap import example_data as data

    if name == "2 x 20 m":
        found = {}
        for foot in FEET:
            events = data.get_healthy_example_stride_events()[f"{foot}_sensor"]
            paths = data.get_healthy_example_position()[f"{foot}_sensor"].groupby(level="s_id")
            lengths = {number: np.hypot(*(path.iloc[-1] - path.iloc[0])[["pos_x", "pos_y"]]) for number, path in paths}
            seconds = events[["ic", "tc", "pre_ic"]] / 204.8
            found[foot] = {
                "contacts": sorted({*seconds.ic, *seconds.pre_ic}), "toe-offs": [*seconds.tc],
                "times": [*zip(seconds.ic, seconds.ic - seconds.pre_ic, strict=True)],
                "lengths": [(ic, lengths[number]) for ic, number in zip(seconds.ic, events.s_id, strict=True)],
            }  # fmt: skip
        return found
    if name == "4 x 10 m":
        borders = data.get_healthy_example_stride_borders_ic_stride()
        found = {}
        for foot in FEET:
            strides = borders[f"{foot}_sensor"][["start", "end"]] / 102.4
            found[foot] = {
                "contacts": sorted({*strides.start, *strides.end}),
                "times": [*zip(strides.end, strides.end - strides.start, strict=True)],
            }
        return found
    return {}


def by_gaitmap(rate: float, samples: dict[str, Any], stands: bool) -> dict[str, Any]:
    """Return the same of gaitmap's pipeline."""
    from gaitmap.event_detection import RamppEventDetection
    from gaitmap.parameters import SpatialParameterCalculation, TemporalParameterCalculation
    from gaitmap.preprocessing.sensor_alignment import align_dataset_to_gravity
    from gaitmap.stride_segmentation import BarthDtw
    from gaitmap.trajectory_reconstruction import StrideLevelTrajectory
    from gaitmap.utils.coordinate_conversion import convert_to_fbf

    columns = [f"{sensor}_{axis}" for sensor in ("acc", "gyr") for axis in "xyz"]
    data = {f"{foot}_sensor": one[columns].reset_index(drop=True) for foot, one in samples.items()}
    if stands:
        data = align_dataset_to_gravity(data, rate)
    body = convert_to_fbf(data, **{f"{foot}_like": f"{foot}_" for foot in samples})
    strides = BarthDtw().segment(body, sampling_rate_hz=rate).stride_list_
    events = RamppEventDetection().detect(body, strides, sampling_rate_hz=rate).min_vel_event_list_
    path = StrideLevelTrajectory().estimate(data, events, sampling_rate_hz=rate)
    time = TemporalParameterCalculation().calculate(events, sampling_rate_hz=rate).parameters_
    space = SpatialParameterCalculation().calculate(events, path.position_, path.orientation_, sampling_rate_hz=rate)
    found = {}
    for foot in samples:
        key = f"{foot}_sensor"
        one = events[key].reset_index().set_index("s_id")
        found[foot] = {
            "contacts": sorted({*one.ic / rate, *one.pre_ic / rate}), "toe-offs": [*one.tc / rate],
            "times": [*zip(one.ic / rate, time[key].stride_time.reindex(one.index), strict=True)],
            "lengths": [*zip(one.ic / rate, space.parameters_[key].stride_length.reindex(one.index), strict=True)],
        }  # fmt: skip
    return found


def time_pipeline(path: Path) -> None:
    """Print the processor times of gaitmap's pipeline on the samples of a left foot in a file, us a sample, as JSON.

    The file of numpy has the rate, Hz, and rows of specific force, m/s^2, and angular rate, degrees/s, as `left`."""
    import numpy as np
    import pandas as pd

    columns = [f"{sensor}_{axis}" for sensor in ("acc", "gyr") for axis in "xyz"]
    data, times = np.load(path), []
    samples = {"left": pd.DataFrame(data["left"], columns=columns)}
    for _ in range(RUNS + 1):  # in the first run, numba compiles
        started_at = process_time()
        found = by_gaitmap(float(data["rate"]), samples, stands=True)
        times.append((process_time() - started_at) / len(samples["left"]) * 1e6)
    assert found["left"]["lengths"], "gaitmap found no strides"
    print(json.dumps(times[1:]))


def by_solepath(rate: float, samples: dict[str, Any], together: bool) -> tuple[dict[str, Any], float, list[str]]:
    """Return the same of solepath's default recipe, its processor time, s, and the defects that it reports."""
    from solepath import DefectFound, GaitCycleMeasured, HeelStrike, Sample, Session, Site, StrideTaken, ToeOff

    rows = []
    for foot, one in samples.items():
        columns = [one[f"{sensor}_{axis}"].tolist() for sensor in ("acc", "gyr") for axis in "xyz"]
        for number, (x, y, z, p, q, r) in enumerate(zip(*columns, strict=True)):
            turned = radians(p), radians(q), radians(r)
            rows.append(Sample(t=number / rate, site=Site(f"{foot}_foot"), acc=(x, y, z), gyro=turned))
    groups = [rows] if together else [[row for row in rows if row.site.value == f"{foot}_foot"] for foot in FEET]
    events: list[Any] = []
    used = 0.0
    for group in groups:
        group.sort(key=lambda row: row.t)
        session = Session()
        started_at = process_time()
        for sample in group:
            events += session.feed(sample)
        events += session.finish()
        used += process_time() - started_at
    found: dict[str, Any] = {foot: {"contacts": [], "toe-offs": [], "times": [], "lengths": []} for foot in FEET}
    for event in events:
        match event:
            case HeelStrike():
                found[event.foot.value]["contacts"].append(event.t)
            case ToeOff():
                found[event.foot.value]["toe-offs"].append(event.t)
            case GaitCycleMeasured():
                found[event.foot.value]["times"].append((event.t, event.stride_time))
            case StrideTaken(t_heel_strike=float(contact)):
                found[event.foot.value]["lengths"].append((contact, event.length))
    return found, used, [event.what for event in events if isinstance(event, DefectFound)]


def pairs(ones: list[Any], others: list[Any]) -> list[tuple[Any, Any]]:
    """Return what is nearest in time in both lists, each at most once; both have times, or times with a value."""

    def time(one: Any) -> float:
        return one[0] if isinstance(one, tuple) else one

    near = [(abs(time(a) - time(b)), n, m) for n, a in enumerate(ones) for m, b in enumerate(others)]
    taken_a, taken_b, found = set(), set(), []
    for distance, n, m in sorted(near):
        if distance <= NEAR and n not in taken_a and m not in taken_b:
            taken_a.add(n)
            taken_b.add(m)
            found.append((ones[n], others[m]))
    return found


def line(name: str, what: str, ours: dict[str, Any], theirs: dict[str, Any], true: dict[str, Any]) -> str:
    """Return a row of the table: counts, errors of both against the truth, and their difference.

    Errors are those of what both have found, so that neither gains by leaving out what is hard."""
    import numpy as np

    scale, unit = (1000.0, "ms") if what != "lengths" else (100.0, "cm")

    def also(a: dict[str, Any], b: dict[str, Any]) -> dict[str, Any]:
        return {foot: {what: [one for one, _ in pairs(a[foot][what], b[foot][what])]} for foot in FEET}

    def differences(a: dict[str, Any], b: dict[str, Any]) -> str:
        matched = [pair for foot in FEET for pair in pairs(a[foot][what], b.get(foot, {}).get(what, []))]
        if not matched:
            return "-"
        values = np.array([(x[1] - y[1]) if isinstance(x, tuple) else x - y for x, y in matched]) * scale
        middle = np.median(values)
        return f"{middle:+.1f}, {np.median(np.abs(values - middle)):.1f} {unit} ({len(values)})"

    def count(one: dict[str, Any]) -> int:
        return sum([len(one.get(foot, {}).get(what, [])) for foot in FEET])

    counts = f"{count(ours)} / {count(theirs)} / {count(true) or '-'}"
    cells = [name, ROWS[what], counts, differences(also(ours, theirs), true), differences(also(theirs, ours), true)]
    cells.append(differences(ours, theirs))
    return f"| {' | '.join(cells)} |"


def compare() -> None:
    import warnings

    warnings.simplefilter("ignore")
    print(f"Python {sys.version.split()[0]}, gaitmap {VERSION}; median difference, MAD (pairs)\n")
    print("| walk | what | solepath / gaitmap / truth | solepath - truth | gaitmap - truth | solepath - gaitmap |")
    print("|---|---|---|---|---|---|")
    costs = []
    for name, rate, samples, stands in walks():
        count = sum([len(one) for one in samples.values()])
        by_gaitmap(rate, samples, stands)  # numba compiles
        started_at = process_time()
        theirs = by_gaitmap(rate, samples, stands)
        used = process_time() - started_at
        ours, own, defects = by_solepath(rate, samples, together=name != "patient")
        true = truth(name)
        for what in ROWS:
            print(line(name, what, ours, theirs, true))
        costs.append(
            f"{name}: solepath {own / count * 1e6:.0f} us a sample, gaitmap {used / count * 1e6:.0f} us a sample"
        )
        costs += [f"  solepath reports: {what}" for what in defects]
    print("\n" + "\n".join(costs))


def run_in(folder: Path, *arguments: object, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run this script with arguments in the environment in a folder, on one processor."""
    threads = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")}
    command = [prepare(folder), Path(__file__).resolve(), *map(str, arguments), "--environment", folder]
    paths = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    return subprocess.run(command, env=paths | threads, text=True, check=False, **options)


def main() -> None:
    parser = ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    place = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "solepath" / f"gaitmap-{VERSION}"
    parser.add_argument(
        "--environment", type=Path, default=place, help="folder of the environment (default: %(default)s)"
    )
    parser.add_argument("--time", type=Path, metavar="FILE", help="only time gaitmap, on the samples of a .npz file")
    arguments = parser.parse_args()
    folder = arguments.environment.resolve()
    if not (Path(sys.prefix).resolve() == folder and find_spec("gaitmap")):
        sys.exit(run_in(folder, *sys.argv[1:]).returncode)
    if arguments.time:
        time_pipeline(arguments.time)
    else:
        compare()


if __name__ == "__main__":
    main()
