"""One row of a recording that cannot be used costs one row, which is named; a file of such rows is rejected."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from recordings import PACKETS, recorded
from tabled import saved, still

from solepath.recording import (
    RecordingError,
    TableMapping,
    bad_rows,  # its limits are those of megabytes
    read_packets,
    read_samples,
)
from solepath.recording.bad_rows import MAX_SKIPPED
from solepath.types import Packet, Sample

HEADER = '{"format": "solepath-packets", "version": 1}\n'
COLUMNS = "t,acc_x,acc_y,acc_z\n"


def line_of(**fields: object) -> str:
    return json.dumps({"t": 1.0, "site": "left_foot", "channel": "insole/frame", "data": "f5"} | fields) + "\n"


def packets_of(path: Path) -> tuple[list[Packet], list[str]]:
    """Return the packets of a recording and the reports, without the path."""
    reports: list[str] = []
    packets = list(read_packets(path, report=reports.append))
    assert all(report.startswith(f"{path}: ") and report.isprintable() and len(report) < 400 for report in reports)
    return packets, [report.removeprefix(f"{path}: ") for report in reports]


def samples_of(path: Path) -> tuple[list[Sample], list[str]]:
    """Return the samples of a file and the reports, without the path."""
    reports: list[str] = []
    samples = list(read_samples(path, report=reports.append))
    return samples, [report.removeprefix(f"{path}: ") for report in reports]


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("hello\n", "is not JSON"),
        ('{"t": NaN}\n', "NaN is not JSON"),
        ("[" * 30_000 + "\n", "is not JSON"),
        ('{"t": 1.0, "site": "left_foot", "channel": "x"}\n', '"data" is missing'),
        (line_of(t="1"), '"t" is not a number but "1"'),
        (line_of(t=True), '"t" is not a number but true'),
        (line_of().replace("1.0", "1e999"), '"t" is not a finite number'),
        (line_of(t=10**400), '"t" is not a finite number'),
        (line_of(site="hand"), '"site" is not one of left_foot'),
        (line_of(channel=["a" * 60]), f'"channel" is not text but ["{"a" * 35}...;'),
        (line_of(data="f5 0"), '"data" is not pairs of hexadecimal digits but "f5 0"'),
        (line_of(device=None), '"device" is not text but null'),
        ("\0" * 1_000_000 + line_of(), "is longer than 65536 bytes"),
        (line_of()[:30] + line_of(), "is not JSON"),
    ],
)
def test_a_damaged_line_is_named_and_costs_one_packet(tmp_path: Path, line: str, complaint: str) -> None:
    path = tmp_path / "walk.jsonl"
    path.write_text(HEADER + line_of(t=0.5) + line + line_of(t=9.0))
    packets, reports = packets_of(path)
    assert [packet.t for packet in packets] == [0.5, 9.0]
    assert len(reports) == 1 and reports[0].startswith(f"line 3: {complaint}")
    assert reports[0].endswith("; this line is left out")


def test_of_many_damaged_lines_the_first_are_named_and_all_are_counted(tmp_path: Path) -> None:
    path = tmp_path / "walk.jsonl"
    path.write_text(HEADER + "".join(line_of(t=k) + ("?\n" if k % 3 == 0 else "") for k in range(30)))
    packets, reports = packets_of(path)
    assert [packet.t for packet in packets] == list(range(30))
    assert [report.partition(":")[0] for report in reports[:-1]] == ["line 3", "line 7", "line 11"]
    assert reports[-1] == "10 of 40 lines are left out"


def test_a_recording_is_rejected_from_one_more_damaged_line_than_whole_ones_on(tmp_path: Path) -> None:
    path = tmp_path / "walk.jsonl"
    path.write_bytes(HEADER.encode() + b"\xff\n" * 4 + line_of().encode() * 4)
    packets, reports = packets_of(path)
    assert len(packets) == 4 and reports[3:] == ["4 of 8 lines are left out"]
    assert reports[0] == "line 2: is not text; this line is left out"
    path.write_text(HEADER + line_of() * 4 + "?\n" * 5)
    with pytest.raises(RecordingError, match=r"line 6: is not JSON; 5 of 9 lines cannot be used"):
        packets_of(path)
    path.write_text(HEADER + "?\n" * 3 + line_of() * 2)
    with pytest.raises(RecordingError, match="3 of 5 lines cannot be used"):  # and nothing is said of single lines
        list(read_packets(path, report=pytest.fail))


def test_a_file_of_damaged_lines_is_not_read_to_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "walk.jsonl"
    path.write_text(HEADER + line_of() + "?\n" * 2000)
    monkeypatch.setattr(bad_rows, "MAX_EXCESS", 1000)
    with pytest.raises(RecordingError, match="line 3: is not JSON; 1002 of 1003 lines cannot be used"):
        packets_of(path)


@pytest.mark.parametrize("end", ["\n", "0.05,0,0,9.8\n", "\n0.05,0,0,9.8\n", ""])
@pytest.mark.parametrize("size", [65_537, 70_000, 1_000_000])
def test_a_row_that_is_too_long_costs_only_itself(tmp_path: Path, size: int, end: str) -> None:
    path = tmp_path / "walk.csv"
    path.write_text(COLUMNS + "".join(f"{k / 100},0,0,9.8\n" for k in range(5)) + "\0" * size + end)
    samples, reports = samples_of(path)
    assert len(samples) == 5 + end.startswith("\n0")
    assert reports == ["line 7: is longer than 65536 characters; this row is left out"]


def test_a_line_without_end_ends_the_file_there(tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", PACKETS)
    with path.open("ab") as file:
        file.truncate(path.stat().st_size + 3 * MAX_SKIPPED)  # a hole of zeros, as after a power failure
    packets, reports = packets_of(path)
    assert packets == PACKETS and len(reports) == 1 and "line 5: is longer than 65536 bytes" in reports[0]


@pytest.mark.parametrize(
    ("quantity", "value"),
    [(q, v) for q in ("acc", "gyro", "pressure") for v in (np.nan, np.inf, -np.inf) if (q, v) != ("pressure", np.nan)],
)
@pytest.mark.parametrize("name", ["walk.npz", "walk.csv"])
def test_a_value_that_is_not_finite_costs_its_row(tmp_path: Path, name: str, quantity: str, value: float) -> None:
    columns = still()
    columns[quantity][7, 1] = value
    samples, reports = samples_of(saved(tmp_path / name, columns))
    assert [sample.t for sample in samples] == [t for k, t in enumerate(columns["t"].tolist()) if k != 7]
    place = f"{quantity}, row 7" if name == "walk.npz" else f"line 9, {quantity}"
    assert reports == [f"{place}: is {value}, not a finite number (t = 0.07 s); this row is left out"]


@pytest.mark.parametrize(
    ("row", "t", "complaint"),
    [
        (7, 0.02, "0.02 s after 0.06 s and before 0.08 s"),
        (7, 5.0, "5 s after 0.06 s and before 0.08 s"),
        (0, 9.0, "9 s before 0.01 s"),
        (19, -3.0, "-3 s after 0.18 s"),
    ],
)
@pytest.mark.parametrize("name", ["walk.npz", "walk.csv"])
def test_one_time_stamp_out_of_order_costs_its_row(
    tmp_path: Path, name: str, row: int, t: float, complaint: str
) -> None:
    columns = still()
    columns["t"][row] = t
    samples, reports = samples_of(saved(tmp_path / name, columns))
    assert [sample.t for sample in samples] == [k / 100.0 for k in range(20) if k != row]
    place = f"t, row {row}" if name == "walk.npz" else f"line {row + 2}, t"
    assert reports == [f"{place}: time is out of order: {complaint}; this row is left out"]


@pytest.mark.parametrize("name", ["walk.npz", "walk.csv"])
def test_a_file_with_more_bad_rows_than_good_ones_is_rejected(tmp_path: Path, name: str) -> None:
    columns = still()
    columns["acc"][3:14, 0] = np.nan
    with pytest.raises(RecordingError, match="is nan, not a finite number .*; 11 of 20 rows cannot be used"):
        samples_of(saved(tmp_path / name, columns))


@pytest.mark.parametrize("fault", ["", "ERR", "-", "nan"])
@pytest.mark.parametrize("broken", [(1,), (0, 1, 2)])
def test_a_pressure_cell_without_a_number_costs_neither_the_others_nor_the_inertial_part(
    tmp_path: Path, fault: str, broken: tuple[int, ...]
) -> None:
    path = tmp_path / "left.csv"
    cells = [fault if k in broken else str(k + 1.0) for k in range(3)]
    rows = [",".join([f"{0.01 * k:.2f},0,0,9.81,0,0,0", *cells]) for k in range(20)]
    path.write_text("\n".join(["t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z,c1,c2,c3", *rows, ""]))
    mapping = TableMapping.parse("t=t,acc=acc_*,gyro=gyro_*,pressure=c*")
    samples = list(read_samples(path, mapping=mapping))
    assert len(samples) == 20
    for sample in samples:
        assert sample.acc == (0.0, 0.0, 9.81)
        assert [math.isnan(value) for value in sample.pressure] == [k in broken for k in range(3)]
        assert all(value == k + 1.0 for k, value in enumerate(sample.pressure) if k not in broken)
