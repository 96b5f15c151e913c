"""Words in the names of columns and channels: the quantity, the axis and the foot that they mean."""

from __future__ import annotations

import re

from .units import UNITS, unit_of_name

QUANTITY_WORDS = {
    "t": r"(?:^|[^a-z])(?:t|time|times|timestamp|sampletime|elapsed|zeit|temps|tiempo)(?:[^a-z]|$)",
    "gyro": r"(?:^|[^a-z])[gw](?:[^a-z]|[xyz](?:[^a-z]|$))|gyr|omega|ang(?:ular)?.?(?:vel|rate)|dreh|rot",
    "acc": r"(?:^|[^a-z])a(?:[^a-z]|[xyz](?:[^a-z]|$)|$)|acc|beschl",
}
"""Pattern of each quantity in names in lower case."""
OTHER = r"free|lin(?:ear)?.?acc|user.?acc|gravity|mag|quat|euler|angle|roll|pitch|yaw|temp[^o]|baro"
"""Pattern of what is none of them."""
AXIS = r"([xyz])(?:[^a-z]*(?:axis|achse)?)$|[^a-z]([xyz])(?:[^a-z]|$)"
"""Pattern of the axis in a name in lower case without its unit: at its end, or alone."""
FEET = {"left": r"left|(?:^|[^a-z])l(?:[^a-z]|$)", "right": r"right|(?:^|[^a-z])r(?:[^a-z]|$)"}
"""Patterns of the feet in names of columns."""


def key_of_name(name: str, sensor: str = "") -> tuple[str, str]:
    """Return the key of a mapping that the name of a column suggests, and the axis; "" where it suggests none.

    `sensor` is the quantity of an axis without a name of a quantity. A time has no axis."""
    text = re.sub(r"[\[(].*?[\])]", " ", name).strip()
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).lower()
    if re.search(OTHER, spaced):
        return "", ""
    unit = next((quantity for quantity in UNITS if unit_of_name(name, quantity)), "")
    axis = re.search(AXIS, spaced)
    named = next((q for q in ("gyro", "acc") if re.search(QUANTITY_WORDS[q], spaced)), sensor)
    quantity = unit if unit in ("acc", "gyro") else named
    if axis is not None and quantity:
        feet = [f"_{foot}" for foot, pattern in FEET.items() if re.search(pattern, spaced)]
        return quantity + (feet[0] if feet else ""), axis[1] or axis[2]
    return ("t" if unit == "t" or re.search(QUANTITY_WORDS["t"], spaced) else ""), ""
