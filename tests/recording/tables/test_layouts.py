"""Text tables are read however they are written: separators, decimal marks, headers, times; and Excel and Parquet."""

from __future__ import annotations

import importlib.util
import re
import sys
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from solepath.recording import RecordingError, TableMapping, open_source, read_samples
from solepath.recording.samples import books
from solepath.types import Sample, Site
from solepath.types.extras import install_hint

MAPPING = TableMapping(
    {"t": "Zeit", "acc": ["A x", "A y", "A z"], "gyro": ["G x", "G y", "G z"]}, {"t": "ms", "gyro": "rad/s"}
)
NAMES = ["Zeit", "A x", "A y", "A z", "G x", "G y", "G z"]
NUMBERS = [(10.0 * k, 0.5, -0.25, 9.75 + 0.01 * k, 0.125, 0.0, -1.5) for k in range(6)]
EXPECTED = [Sample(0.01 * k, Site.RIGHT_FOOT, (0.5, -0.25, 9.75 + 0.01 * k), (0.125, 0.0, -1.5)) for k in range(6)]


def assert_expected(samples: list[Sample]) -> None:
    assert len(samples) == len(EXPECTED)
    for sample, expected in zip(samples, EXPECTED, strict=True):
        assert (sample.t, *sample.acc, *sample.gyro) == pytest.approx((expected.t, *expected.acc, *expected.gyro))


def table(separator: str = ",", decimal: str = ".", head: str = "", names: list[str] | None = None) -> str:
    rows = [separator.join(f"{v:.3f}".replace(".", decimal) for v in row) for row in NUMBERS]
    return head + "\n".join([separator.join(NAMES if names is None else names), *rows]) + "\n"


@pytest.mark.parametrize(
    ("separator", "decimal"), [(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ","), ("|", "."), ("|", ",")]
)
@pytest.mark.parametrize("head", ["", "Labor 7\n\n", "Proband;S 12\nDatum,1.3.2026\nRate\t100\n# Kommentar\n"])
def test_separator_decimal_mark_and_lines_before_the_header_are_found(
    tmp_path: Path, separator: str, decimal: str, head: str
) -> None:
    (tmp_path / "walk.csv").write_text(table(separator, decimal, head))
    assert_expected(list(read_samples(tmp_path / "walk.csv", mapping=MAPPING)))


@pytest.mark.parametrize("word", ["-", "ERR", "NA", "", "---"])
@pytest.mark.parametrize("time", ["0.000", None])
@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("head", ["", "Labor 7\n\n"])
@pytest.mark.parametrize("names", [NAMES, []])
def test_rows_without_values_before_the_first_values_are_not_the_header(
    tmp_path: Path, word: str, time: str | None, count: int, head: str, names: list[str]
) -> None:
    damaged = [word if time is None else time, *[word] * 6]
    header = [",".join(names)] if names else []
    numbers = [",".join(map(str, row)) for row in NUMBERS]
    (tmp_path / "walk.csv").write_text(head + "\n".join([*header, *[",".join(damaged)] * count, *numbers, ""]))
    by_number = TableMapping({"t": "1", "acc": ["2", "3", "4"], "gyro": ["5", "6", "7"]}, MAPPING.units)
    mapping = MAPPING if names else by_number
    assert_expected(list(read_samples(tmp_path / "walk.csv", mapping=mapping, report=lambda _: None)))


def test_columns_apart_by_blanks_and_a_line_of_units_are_read(tmp_path: Path) -> None:
    names = [name.replace(" ", "_") for name in NAMES]
    rows = "\n".join("  ".join(f"{v:9.3f}" for v in row) for row in NUMBERS)
    (tmp_path / "walk.txt").write_text(
        f"{'  '.join(names)}\n[ms] [m/s^2] [m/s^2] [m/s^2] [rad/s] [rad/s] [rad/s]\n{rows}\n"
    )
    mapping = TableMapping({"t": "zeit", "acc": "A_*", "gyro": ["G_x", "G_y", "G_z"]})
    assert_expected(list(read_samples(tmp_path / "walk.txt", mapping=mapping)))


def test_units_in_the_header_need_no_option_and_an_option_replaces_them(tmp_path: Path) -> None:
    names = ["Zeit [ms]", *(f"A {axis} (m/s²)" for axis in "xyz"), *(f"G {axis} (rad/s)" for axis in "xyz")]
    (tmp_path / "walk.csv").write_text(table(names=names), encoding="utf-8")
    mapping = TableMapping({"t": "Zeit*", "acc": "A *", "gyro": "G *"})
    assert_expected(list(read_samples(tmp_path / "walk.csv", mapping=mapping)))
    other = TableMapping({"t": "Zeit*", "acc": "A *", "gyro": "G *"}, {"t": "s"})
    with pytest.raises(RecordingError, match=r"Zeit.*the median time between samples is 10 s.*repair: --units ms"):
        read_samples(tmp_path / "walk.csv", mapping=other)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8", "utf-8-sig", "cp1252"])
def test_other_encodings_are_read(tmp_path: Path, encoding: str) -> None:
    names = ["Zeit", *(f"A {axis} größe" for axis in "xyz"), *NAMES[4:]]
    (tmp_path / "walk.csv").write_text(table(";", ",", names=names), encoding=encoding)
    mapping = TableMapping({"t": "Zeit", "acc": names[1:4], "gyro": NAMES[4:]}, {"t": "ms"})
    assert_expected(list(read_samples(tmp_path / "walk.csv", mapping=mapping)))


def test_a_name_that_occurs_twice_is_taken_by_its_number(tmp_path: Path) -> None:
    (tmp_path / "walk.csv").write_text(table(names=["Zeit", "X", "Y", "Z", "X", "Y", "Z"]))
    with pytest.raises(RecordingError) as caught:
        read_samples(tmp_path / "walk.csv", mapping=TableMapping.parse("t=Zeit,acc=X,Y,Z,gyro=#5,#6,#7", "ms"))
    assert "names the column X twice: it is #2 or #5; repair: --columns 't=Zeit,acc=#2,#3,#4" in str(caught.value)
    mapping = TableMapping.parse("t=Zeit,acc=#2,#3,#4,gyro=#5,#6,#7", "ms")
    assert_expected(list(read_samples(tmp_path / "walk.csv", mapping=mapping)))
    for number in ("#0", "#8"):
        with pytest.raises(RecordingError, match=f"names no column {number}"):
            read_samples(tmp_path / "walk.csv", mapping=TableMapping.parse(f"t=Zeit,acc={number},#3,#4", "ms"))


def test_a_pattern_of_times_is_of_one_column(tmp_path: Path) -> None:
    (tmp_path / "walk.csv").write_text(table(names=["Zeit 1", *NAMES[1:6], "Zeit 2"]))
    with pytest.raises(RecordingError, match=r"t needs 1 columns, not 2 \(Zeit 1, Zeit 2\)"):
        read_samples(tmp_path / "walk.csv", mapping=TableMapping.parse("t=Zeit*,acc=A *", "ms"))


def test_a_rate_stands_for_times_and_a_row_that_is_left_out_keeps_its_time(tmp_path: Path) -> None:
    lines = table().splitlines()
    lines[3] = lines[3].replace("0.500", "oh no")
    (tmp_path / "walk.csv").write_text("\n".join(lines) + "\n")
    reports: list[str] = []
    mapping = TableMapping({"acc": NAMES[1:4], "gyro": NAMES[4:]}, rate=100.0)
    samples = list(read_samples(tmp_path / "walk.csv", mapping=mapping, report=reports.append))
    assert [sample.t for sample in samples] == pytest.approx([0.0, 0.01, 0.03, 0.04, 0.05])
    assert 'line 4: A x is "oh no", not a number; this row is left out' in reports[0]


@pytest.mark.parametrize(
    ("cells", "times"),
    [
        (["9:30:01.5", "09:30:01,51", "09:30:01.5200009"], [34201.5, 34201.51, 34201.52]),
        (["23:59:59.99", "0:00:00", "0:00:00.01"], [86399.99, 86400.0, 86400.01]),
        (["12:00:00.02", "12:00:00.01", "12:00:00.03"], [43200.01, 43200.03]),
        (["1:02:03", "1:02:03.1", "1:02:03.2"], [3723.0, 3723.1, 3723.2]),
        (["1999-12-31T23:59:59.5Z", "2000-01-01T01:00:00+01:00", "2000-01-01T00:00:00.5"], [0.0, 0.5, 1.0]),
    ],
)
def test_times_as_text_are_exact(tmp_path: Path, cells: list[str], times: list[float]) -> None:
    rows = [f"{cell};0,5;-0,25;9,75" for cell in cells]
    (tmp_path / "walk.csv").write_text("\n".join(["Zeit;A x;A y;A z", *rows]) + "\n")
    mapping = TableMapping({"t": "Zeit", "acc": NAMES[1:4]})
    source = open_source(tmp_path / "walk.csv", mapping=mapping, report=[].append)
    assert [one.t for one in source] == pytest.approx(times, abs=1e-6)
    assert source.header == ({"began": "1999-12-31T23:59:59.500000+00:00", "began_t": 0.0} if "T" in cells[0] else {})


@pytest.mark.parametrize(("decimal", "cell", "value"), [
    (",", "1.234,5", 1234.5), (",", "-0,5e1", -5.0), (",", ",25", 0.25), (",", "7", 7.0), (".", " 2.5e-1 ", 0.25),
])  # fmt: skip
def test_numbers_are_read_with_either_decimal_mark(tmp_path: Path, decimal: str, cell: str, value: float) -> None:
    (tmp_path / "walk.csv").write_text(f"t;pressure_0;pressure_1\n0;{cell};1\n1;{cell};1\n")
    samples = list(read_samples(tmp_path / "walk.csv", mapping=TableMapping(decimal=decimal)))
    assert [sample.pressure for sample in samples] == [(value, 1.0)] * 2


def test_a_point_among_decimal_commas_is_no_number_because_it_may_be_a_thousand(tmp_path: Path) -> None:
    lines = table(";", ",").splitlines()
    lines[2] = lines[2].replace("10,000", "1.010,000")
    lines[3] = lines[3].replace("0,500", "0.500")
    (tmp_path / "walk.csv").write_text("\n".join(lines) + "\n")
    reports: list[str] = []
    samples = list(read_samples(tmp_path / "walk.csv", mapping=MAPPING, report=reports.append))
    assert any('line 4: A x is "0.500", not a number' in report for report in reports)
    assert any("time is out of order: 1.01 s" in report for report in reports) and len(samples) == 4


LIBRARIES = [name for name in ("pyarrow", "polars") if importlib.util.find_spec(name) is not None]


def only(monkeypatch: pytest.MonkeyPatch, *installed: str) -> None:
    """Let the reader find none but these libraries."""
    monkeypatch.setattr(books, "find_spec", lambda name: importlib.util.find_spec(name) if name in installed else None)
    for name in {"pyarrow", "polars"} - {*installed}:
        monkeypatch.setitem(sys.modules, name, None)


@pytest.mark.parametrize("library", LIBRARIES)
def test_parquet_is_read_with_either_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, library: str) -> None:
    pandas = pytest.importorskip("pandas")
    path = tmp_path / "walk.parquet"
    pandas.DataFrame(NUMBERS, columns=NAMES).to_parquet(path)
    only(monkeypatch, library)
    assert_expected(list(read_samples(path, mapping=MAPPING)))


@pytest.mark.parametrize("library", LIBRARIES)
def test_texts_of_parquet_are_times_and_names_as_in_any_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, library: str
) -> None:
    """Texts that are all different, a few that many rows share, and none in some rows; in groups of 3,000 rows."""
    pandas = pytest.importorskip("pandas")
    count = 10_000
    start = datetime(2026, 3, 1, 9, 30)
    columns = {
        "time": [(start + timedelta(milliseconds=10 * k)).isoformat() for k in range(count)],
        **{name: [value] * count for name, value in zip(NAMES[1:4], (0.5, -0.25, 9.75), strict=True)},
        "side": pandas.Categorical(["left", None] * (count // 2)),
        "note": [None, "turned", *[None] * (count - 2)],
        "raw": [b"\x00"] * count,
    }
    path = tmp_path / "walk.parquet"
    pandas.DataFrame(columns).to_parquet(path, row_group_size=3_000)
    only(monkeypatch, library)
    (_, names), (_, first), (_, second), *rest = books.read_book(path)
    assert first[names.index("side")] == "left" and second[names.index("side")] is None
    assert first[names.index("note")] is None and second[names.index("note")] == "turned" and len(rest) == count - 2
    mapping = TableMapping({"t": "time", "acc": NAMES[1:4]})
    times = [sample.t for sample in read_samples(path, mapping=mapping)]
    assert times == pytest.approx([0.01 * k for k in range(count)], abs=2e-6)


def test_excel_needs_no_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("openpyxl")
    path = tmp_path / "walk.xlsx"
    with pandas.ExcelWriter(path) as book:
        pandas.DataFrame([["Labor 7"]]).to_excel(book, header=False, index=False)
        pandas.DataFrame(NUMBERS, columns=NAMES).to_excel(book, startrow=2, index=False)
    only(monkeypatch)
    assert_expected(list(read_samples(path, mapping=MAPPING)))


def test_dates_and_times_of_a_workbook_are_times(tmp_path: Path) -> None:
    """Cells have numbers of days; only their style says that these are times."""
    openpyxl = pytest.importorskip("openpyxl")
    for offset, style in ((datetime(2026, 3, 1, 9, 30), "yyyy-mm-dd hh:mm:ss.000"), (datetime(2026, 3, 1), "General")):
        book = openpyxl.Workbook()
        book.active.append(NAMES[:4])
        for k in range(6):
            moment = offset + timedelta(milliseconds=10 * k)
            book.active.append([moment if style != "General" else moment.time(), 0.5, -0.25, 9.75])
            if style != "General":
                book.active.cell(k + 2, 1).number_format = style
        book.save(tmp_path / "walk.xlsx")
        mapping = TableMapping({"t": "Zeit", "acc": NAMES[1:4]})
        times = [sample.t for sample in read_samples(tmp_path / "walk.xlsx", mapping=mapping)]
        assert times == pytest.approx([0.01 * k for k in range(6)], abs=2e-5)


@pytest.mark.parametrize("name", ["walk.xlsx", "walk.parquet"])
def test_a_damaged_workbook_and_a_missing_library_get_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    (tmp_path / name).write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(
        RecordingError, match="is no whole Parquet file|cannot be unpacked: it is damaged|needs pyarrow"
    ):
        read_samples(tmp_path / name)
    only(monkeypatch)
    if name == "walk.parquet":
        with pytest.raises(
            RecordingError, match="needs pyarrow or polars; repair: " + re.escape(install_hint("tables"))
        ):
            read_samples(tmp_path / name)
