"""Adds the gait tables to a report, and the definitions of their parameters."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ...body.gait.means import GaitMeans, GaitParameters, StrideFigures
from ...types import Foot
from ..tables.gait import MIN_STRIDES, gait_rows, strides_of
from ..tables.table import number, percent
from .markup import add, table, terms

HEADER = ("parameter", "left", "right", "both", "CV %", "asymmetry")

DEFINITIONS = {
    "stride_time": "from a contact of a foot to its next one (Hollman et al. 2011)",
    "step_time": "from the other foot's contact to this one's",
    "stride_length": "horizontal, from foot-flat to foot-flat of a foot (Mariani et al. 2010)",
    "step_length": "from where the other foot stands to this one, along the stride (Huxham et al. 2006)",
    "step_width": "distance of the other foot from the line of the stride (Huxham et al. 2006)",
    "speed": "stride length / stride time",
    "clearance": "highest rise of the sensor above the foot-flats; not the minimum toe clearance",
    "toe_off_angle": "how far the heel is up at toe-off, against flat",
    "heel_strike_angle": "how far the toe is up at the contact, against flat",
    "stance_time": "from contact to toe-off, of the stride time (Whittle 2007)",
    "single_support": "only this foot is on the ground",
    "initial_double_support": "from this foot's contact to the other's toe-off; below zero a flight (Novacheck 1998)",
    "terminal_double_support": "from the other foot's contact to this one's toe-off; below zero a flight",
}
"""Short definition of each parameter; GaitCycleMeasured has the full definitions."""
COLUMN_DEFINITIONS = [
    ("steady strides", "neither first nor last of a walk, nor in a turn, on stairs or with samples missing"),
    ("both", "mean of the feet's means; SD from the mean of their variances (Galna et al. 2013)"),
    ("CV", "standard deviation / mean, of both feet (Hausdorff 2005)"),
    ("asymmetry", "(right - left) / their mean; 0 of equal feet, none of a flight (Robinson et al. 1987)"),
    ("asymmetry of angles", "right - left, in degrees, and no CV: their zero is the flat sole, not nothing"),
]


def gait_tables(parent: Element, means: GaitMeans) -> bool:
    """Add a table for walking and one for running; return False if there are no steady strides."""
    tables = [parameters for parameters in (means.of(False), means.of(True)) if parameters is not None]
    for parameters in tables:
        _table(parent, parameters)
    if tables:
        _notes(parent, tables)
    return bool(tables)


def _table(parent: Element, parameters: GaitParameters) -> None:
    columns = [parameters.feet.get(foot) for foot in Foot]
    what = "Running" if parameters.running else "Walking"
    strides = [strides_of(parameters, foot) for foot in Foot]
    rows = [["steady strides", *[number(count, 0) for count in strides], "-", "-", "-"]]
    both = parameters.both if None not in columns else None
    rows.append(["cadence, steps/min", *[_cadence(figures) for figures in (*columns, both)], "-", "-"])
    # the standard deviation is on a line of its own
    rows += [[f"{row.label}, {row.unit}", *row.cells("\n\N{PLUS-MINUS SIGN}")] for row in gait_rows(parameters)]
    caption = f"{what}: means of steady strides, of both feet \N{PLUS-MINUS SIGN} standard deviation"
    table(parent, caption, HEADER, rows, "numbers gait")
    if parameters.coordination is not None:
        add(parent, "p", f"Phase coordination index: {percent(parameters.coordination)} % (Plotnik et al. 2007).")
    count = sum([foot_count for foot_count in strides if foot_count is not None])
    if count < MIN_STRIDES:
        text = f"Of {count} strides: figures settle with {MIN_STRIDES} and more (Galna et al. 2013)."
        add(parent, "p", text, class_="note")


def _cadence(figures: StrideFigures | None) -> str:
    """Return the cadence of a foot, steps/min, as text: two steps in each stride."""
    return "-" if figures is None or figures.stride_time is None else number(120.0 / figures.stride_time.mean, 1)


def _notes(parent: Element, tables: list[GaitParameters]) -> None:
    """Add the definitions of the parameters, in an element that can be folded on a screen."""
    details = add(parent, "details", open="open")
    add(details, "summary", "What the parameters mean")
    labels = {row.name: row.label for parameters in tables for row in gait_rows(parameters)}
    meanings = [(labels[name], meaning) for name, meaning in DEFINITIONS.items() if name in labels]
    terms(details, meanings + COLUMN_DEFINITIONS)
