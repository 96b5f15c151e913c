"""Text exports of the Moticon OpenGo software: one .txt file for both insoles.

Lines that start with "#" come first ("# Start time:", "# Duration:", "# Sensor insoles: Left SN..., Right SN...",
...), the last of which has the names, with tabs between them: "# time", "left pressure 1[N/cm²]" to 16, "left
acceleration X[g]", "left angular X[dps]", "left total force[N]", ..., and the same of the right foot. Source:
text_import.py and the test data of Moticon's own moticon-rego/moticon-opengo. A row in which all cells of a foot are
blank has no sample of that foot. The axes are right handed in both insoles, x to the toe: `solepath check` on the
vendor's 8 strides of each foot."""

from __future__ import annotations

import re

from ..mapping.mapping import TableMapping
from .export import Export, TableHeader

COLUMN = re.compile(r"(left|right) (pressure|acceleration|angular) (\w+)\[.*\]")
"""Pattern of the name of a column that is used."""
QUANTITIES = {"pressure": "pressure", "acceleration": "acc", "angular": "gyro"}
"""Words of the names, and the quantities that they mean."""


def _is_own(header: TableHeader) -> bool:
    return header.names[0] == "time" and any(map(COLUMN.fullmatch, header.names))


def _mapping(header: TableHeader) -> TableMapping:
    columns: dict[str, tuple[str, ...]] = {"t": ("time",)}
    for match in filter(None, map(COLUMN.fullmatch, header.names)):
        key = f"{QUANTITIES[match[2]]}_{match[1]}"
        columns[key] = (*columns.get(key, ()), match[0])
    if not any(key.startswith("acc") for key in columns):
        raise ValueError("has no columns of acceleration")
    return TableMapping(columns, {"t": "s", "acc": "g", "gyro": "deg/s"})


MOTICON = Export(
    "moticon", "Moticon OpenGo", _mapping, _is_own, lacking="select acceleration and angular rate for the text export"
)
"""The format of Moticon OpenGo."""
