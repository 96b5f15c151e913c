"""Mappings: the texts of the options, files in TOML, and what one mapping takes from another."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from solepath.recording import RecordingError, TableMapping, read_mapping, read_samples
from solepath.recording.mapping.mapping import join_names
from solepath.recording.mapping.units import find_unit

LAB = """
rate = 128
separator = ";"
decimal = ","
header = 3
[columns]
t = "Zeit"
acc = ["Beschl X", "Beschl Y", "-Beschl Z"]
[units]
t = "ms"
acc = "g"
[feet]
left = "*_li.csv"
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "lab.toml"
    path.write_text(text)
    return path


def test_the_text_of_the_options_gives_a_mapping() -> None:
    mapping = TableMapping.parse('t=Time (s), acc="A, x",-AY,"say ""AZ""",gyro_left=G*', "dps, g,msec", rate=100.0)
    assert mapping.columns == {"t": ("Time (s)",), "acc": ("A, x", "-AY", 'say "AZ"'), "gyro_left": ("G*",)}
    assert mapping.units == {"gyro": "deg/s", "acc": "g", "t": "ms"} and mapping.rate == 100.0
    assert TableMapping.parse('t="a=b",acc=x=1,y,z').columns == {"t": ("a=b",), "acc": ("x=1", "y", "z")}


NAME = st.text(
    st.characters(codec="utf-8", exclude_characters="\r\n*#=", exclude_categories=["C"]), min_size=1, max_size=9
).filter(lambda text: text == text.strip() and text[0] not in '-"')


@given(names=st.lists(NAME, min_size=3, max_size=3))
def test_names_that_are_written_as_an_option_are_read_again(names: list[str]) -> None:
    text = f"t={join_names(names[:1])},acc={join_names(names)}"
    assert TableMapping.parse(text).columns == {"t": (names[0],), "acc": tuple(names)}


@pytest.mark.parametrize(
    ("columns", "units", "fault"),
    [
        ("Time", "", "'Time' names no quantity: write t=Time,acc=AX,AY,AZ"),
        ("t=Time,t=Zeit", "", "t is given twice"),
        ("t=a,b", "", "t is one column, not 2"),
        ('acc="AX,AY', "", "has a double quote that does not end"),
        ("", "parsec", "'parsec' is no unit: s, ms, us, ns, datetime; m/s^2, g, mg; rad/s"),
        ("", "g,mg", "g and mg are units of the same quantity"),
    ],
)
def test_an_option_that_cannot_be_is_explained(columns: str, units: str, fault: str) -> None:
    with pytest.raises(ValueError, match=r"^") as caught:
        TableMapping.parse(columns, units)
    assert fault in str(caught.value)


@pytest.mark.parametrize(
    ("text", "unit"),
    [("[g]", ("acc", "g")), ("mg", ("acc", "mg")), ("(m/s²)", ("acc", "m/s^2")), ("°/s", ("gyro", "deg/s")),
     ("DPS", ("gyro", "deg/s")), ("µs", ("t", "us")), ("S", ("t", "s")), ("N/cm²", ("pressure", "N/cm^2")),
     ("uT", None), ("", None), ("Mg", None)],
)  # fmt: skip
def test_units_are_known_by_their_usual_spellings(text: str, unit: tuple[str, str] | None) -> None:
    assert find_unit(text) == unit


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        ({"columns": {"acc": ("x", "", "z")}}, "acc has no names of columns"),
        ({"separator": "/"}, "separator is '/', not one of comma"),
        ({"decimal": ";"}, "decimal is ';', not"),
        ({"header": -1}, "header is -1, not the number of a line"),
        ({"wrap": 0}, "wrap is 0, not a number above 0"),
        ({"units": {"acc": "deg/s"}}, "'deg/s' is no unit of acc: m/s^2, g, mg"),
    ],
)
def test_a_value_that_a_mapping_cannot_have_is_explained(given: dict[str, Any], fault: str) -> None:
    with pytest.raises(ValueError, match=r"^[^\n]*$") as caught:
        TableMapping(**given)
    assert fault in str(caught.value)


def test_a_file_holds_a_mapping(tmp_path: Path) -> None:
    mapping = read_mapping(written(tmp_path, LAB))
    assert mapping == TableMapping(
        {"t": "Zeit", "acc": ["Beschl X", "Beschl Y", "-Beschl Z"]},
        {"t": "ms", "acc": "g"},
        rate=128,
        separator=";",
        decimal=",",
        header=3,
        feet={"left": "*_li.csv"},
    )


def test_all_problems_of_a_file_come_at_once(tmp_path: Path) -> None:
    text = """
rate = -3
colour = "red"
decimal = "."
format = "fitbit"
[columns]
t = ["a", "b"]
speed = "v"
acc = [1.5, 2, 3]
[units]
t = "hours"
[feet]
middle = "*.csv"
"""
    with pytest.raises(RecordingError) as caught:
        read_mapping(written(tmp_path, text))
    lines = str(caught.value).splitlines()
    assert len(lines) == len(caught.value.problems) == 8
    assert all(line.startswith(str(tmp_path / "lab.toml")) for line in lines)
    for fault in (
        "colour is no key of a mapping; repair: the keys are rate, wrap, separator",
        "t is one column, not 2",
        "speed is none of t, acc, gyro, pressure",
        "acc has no names of columns",
        "'hours' is no unit of t: s, ms, us, ns, datetime",
        "rate is -3, not a number above 0",
        "format is 'fitbit', not one of the known formats movella-dot, mbientlab",
        "middle is not left or right",
    ):
        assert any(fault in line for line in lines), fault


@pytest.mark.parametrize("text", ["[columns", "columns = 3", "\x00", "t = 1979-05-27", "[[columns]]\nt=1"])
def test_a_file_that_is_no_mapping_gets_a_sentence(tmp_path: Path, text: str) -> None:
    with pytest.raises(RecordingError, match=r"lab.toml: .*(is not TOML|is a value|is no key)"):
        read_mapping(written(tmp_path, text))


def test_a_mapping_takes_what_it_leaves_out_from_another() -> None:
    base = TableMapping.parse("t=T,acc=a,b,c,gyro=d,e,f", "g,deg/s", wrap=100.0)
    own = TableMapping.parse("gyro_left=-d,e,f", "rad/s", rate=50.0)
    both = own.completed(base)
    assert both.columns == {"acc": ("a", "b", "c"), "gyro": ("d", "e", "f"), "gyro_left": ("-d", "e", "f")}
    assert both.units == {"acc": "g", "gyro": "rad/s"} and (both.wrap, both.rate) == (100.0, 50.0)
    bare = TableMapping.parse("acc=x,y,z").completed(TableMapping.parse("acc_left=a,b,c,acc_right=d,e,f"))
    assert bare.columns == {"acc": ("x", "y", "z")}


def test_a_repair_names_the_option_or_the_line_of_the_file(tmp_path: Path) -> None:
    option, file = TableMapping.parse("t=T,acc=a b,c,d", "g"), read_mapping(written(tmp_path, LAB))
    assert option.write_columns("acc", {"acc": ["x", "y", "z"]}) == "--columns t=T,acc=x,y,z"
    assert option.write_columns("t", {"t": ["it's"]}) == "--columns 't=it'\"'\"'s,acc=a b,c,d'"
    assert file.write_columns("acc", {"acc": ["x", "y", "z"]}) == 'in lab.toml: acc = ["x", "y", "z"]'
    assert option.write_units("t", {"t": "ms"}) == "--units g,ms"
    assert file.write_units("t", {"t": "us"}) == 'in lab.toml: t = "us" below [units]'
    assert file.write_setting("rate", "HZ") == "in lab.toml: rate = HZ"


def test_columns_in_a_file_may_be_numbers(tmp_path: Path) -> None:
    mapping = read_mapping(written(tmp_path, "[columns]\nt = 1\nacc = [2, 3, 4]\n"))
    assert mapping.columns == {"t": ("1",), "acc": ("2", "3", "4")}
    with pytest.raises(RecordingError, match="t has no names of columns"):
        read_mapping(written(tmp_path, "[columns]\nt = true\n"))


def test_a_rate_without_end_and_a_header_beyond_the_file_are_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="rate is inf, not a number above 0"):
        read_mapping(written(tmp_path, "rate = inf\n"))
    mapping = read_mapping(written(tmp_path, "header = 99\n[columns]\nt = 1\n"))
    (tmp_path / "walk.csv").write_text("a,b\n1,2\n")
    with pytest.raises(RecordingError, match=r"no names in line 99; repair: header = N, .* in lab\.toml$"):
        read_samples(tmp_path / "walk.csv", mapping=mapping)
