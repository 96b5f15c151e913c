"""What a report says of its accuracy is what docs/accuracy.md has of the data sets that it names."""

from __future__ import annotations

import re

import pytest
from quoted import PAGES

from solepath.show.report.sections.quality import ACCURACY

DATA = {
    (True, False): "ipol_10m_uturn tripod_treadmill",
    (False, True): "gaitpdb_vgrf",
    (True, True): "moticon_pressed",
}
VALUE = re.compile(
    r"(stride time|stance|swing|double support|stride length) (\S+) (ms|cm|points) \((\S+) to (\S+); (\S+)\)"
)


@pytest.mark.parametrize("kind", ACCURACY)
def test_the_accuracy_of_a_report_is_that_of_the_table(kind: tuple[bool, bool]) -> None:
    table = PAGES["docs/accuracy.md"].split("<!-- agreement -->\n", 1)[1].split("\n\n", 1)[0]
    said = VALUE.findall("".join(ACCURACY[kind]))
    assert len(said) == sum(text.count(" to ") for text in ACCURACY[kind]) - 1, "and the number of cycles"
    for name, bias, unit, lower, upper, icc in said:
        data = DATA[kind].split()[-1 if name == "stride length" else 0]
        (row,) = [line for line in table.splitlines() if line.startswith(f"| `{data}` | {name}")]
        assert [cell.strip() for cell in row.split("|")[5:8]] == [f"{bias} {unit}", f"{lower} to {upper} {unit}", icc]
