"""For a researcher: two .csv files with a lab's own headers and units become a data frame of strides and a report.

    python examples/researcher.py FOLDER                       two files of an emulated walk are made there first
    python examples/researcher.py FOLDER left.csv right.csv    your own files; change MAPPING to what they have

You see the strides of both feet as a table, their means, and FOLDER/report.html for a browser or a mail. A stride is
what one foot does from lying flat on the floor to lying flat again. Needs `pip install '.[frames,arrays]'`.
"""

import subprocess
import sys
from collections.abc import Mapping
from itertools import pairwise
from math import degrees, radians
from pathlib import Path
from typing import Any

from solepath import Foot, Session, StrideTaken, to_frame
from solepath.recording import RecordingError, TableMapping, read_samples

# t, acc and gyro are solepath's names; on the right are those of the files, in the order x, y, z; "-" turns an axis
COLUMNS = "t=Time_ms,acc=AX,AY,AZ,gyro=GX,GY,GZ"
UNITS = "ms,g,deg/s"
MAPPING = TableMapping.parse(COLUMNS, UNITS)


def lab_files(folder: Path) -> list[Path]:
    """Write what a lab's logger would have written of an emulated walk of 12 m there and back."""
    from solepath.emulate import Route, Walker

    walker = Walker(Route().stand(3).walk(12, speed=1.3).turn(radians(180), radius=1).walk(12).stop(2))
    paths = []
    for foot in Foot:
        rows = ["Time_ms;AX;AY;AZ;GX;GY;GZ"]
        for sample in walker.samples(foot, 100.0):
            values = [*[a / 9.80665 for a in sample.acc], *[degrees(w) for w in sample.gyro]]
            rows.append(";".join([f"{1000 * sample.t:.0f}", *[f"{value:.4f}" for value in values]]))
        paths.append(folder / f"S01_{foot.value}.csv")
        paths[-1].write_text("\n".join(rows) + "\n")
    write_truth(folder, walker.truth().feet)
    return paths


def write_truth(folder: Path, feet: Mapping[Foot, Any]) -> None:
    """Write what a walkway would have measured, every stride from contact to contact, and the list of a study."""
    rows = ["recording,foot,t_start_s,t_end_s,stride_length_m"]
    for foot, walked in feet.items():
        for start, end in pairwise(walked.heel_strikes):
            length = next(one.length for one in walked.strides if start < one.t_end and one.t_start < end < one.t_end)
            rows.append(f"S01,{foot.value},{start:.3f},{end:.3f},{length:.3f}")
    (folder / "truth.csv").write_text("\n".join(rows) + "\n")
    (folder / "study.csv").write_text("file,participant,condition\nS01_left.csv;S01_right.csv,S01,usual pace\n")


folder = Path(sys.argv[1])
folder.mkdir(exist_ok=True)
files = [Path(name) for name in sys.argv[2:]] or lab_files(folder)

try:
    samples = list(read_samples(files, mapping=MAPPING))
except RecordingError as error:  # all that is wrong with the files, each with what repairs it
    sys.exit(str(error))
session = Session()
strides = to_frame(session.feed(samples) + session.finish(), StrideTaken)
print(strides[["foot", "number", "t_start", "t_end", "length", "degraded"]].to_string(index=False))
print(strides.groupby("foot").length.agg(["count", "mean", "std"]).round(3))
report = ["--columns", COLUMNS, "--units", UNITS, "--report", folder / "report.html"]
subprocess.run([sys.executable, "-m", "solepath", "track", *files, *report, "--out", folder], check=True)
