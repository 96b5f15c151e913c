"""Adds the gait tables to a report, of walking and of running, and the definitions of their parameters."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ....body.gait.means import GaitMeans, GaitParameters, StrideFigures
from ....types import Foot
from ...tables.gait import MIN_STRIDES, gait_rows, strides_of
from ...tables.table import milliseconds, number, percent
from ..markup import add, table, terms
from ..running import running_means

HEADER = ("parameter", "left", "right", "both", "CV %", "asymmetry")
NO_STEADY = (
    "No stride was steady, so that there are no means: steady strides are neither first nor last of a walk, nor in a "
    "turn, on stairs or with samples missing."
)

DEFINITIONS = {
    "stride_time": "from a contact of a foot to its next one (Hollman et al. 2011)",
    "step_time": "from the other foot's contact to this one's",
    "stride_length": "horizontal, from foot-flat to foot-flat of a foot (Mariani et al. 2010)",
    "speed": "stride length / stride time",
    "clearance": "highest rise of the sensor above the foot-flats; not the minimum toe clearance",
    "toe_off_angle": "how far the heel is up at toe-off, against flat",
    "heel_strike_angle": "how far the toe is up at the contact, against flat (Altman and Davis 2012)",
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
DIFFERENCE_DEFINITION = (
    "asymmetry of swing time",
    "of each right swing against the left ones around it, with a 95 % interval; named if all of it is above 10 ms",
)
RUNNING_DEFINITIONS = [
    ("contact time", "from contact to toe-off of a foot (Novacheck 1998)"),
    ("flight time", "from toe-off to the other foot's contact (Novacheck 1998)"),
    (
        "vertical oscillation",
        "of the centre of mass, from contact and flight by a spring-mass model (Morin et al. 2005)",
    ),
]


def gait_tables(parent: Element, means: GaitMeans) -> bool:
    """Add a table for walking and one for running; return False if there are no steady strides."""
    tables = _all(means)
    for parameters in tables:
        _table(parent, parameters)
    return bool(tables)


def _all(means: GaitMeans) -> list[GaitParameters]:
    return [parameters for parameters in (means.of(False), means.of(True)) if parameters is not None]


def _table(parent: Element, parameters: GaitParameters) -> None:
    columns = [parameters.feet.get(foot) for foot in Foot]
    what = "Running" if parameters.running else "Walking"
    strides = [strides_of(parameters, foot) for foot in Foot]
    rows = [["steady strides", *[number(count, 0) for count in strides], "-", "-", "-"]]
    both = parameters.both if None not in columns else None
    rows.append(["cadence, steps/min", *[_cadence(figures) for figures in (*columns, both)], "-", "-"])
    # the standard deviation is on a line of its own
    rows += [[f"{row.label}, {row.unit}", *row.cells("\n\N{PLUS-MINUS SIGN}")] for row in gait_rows(parameters)]
    rows += _running_rows(parameters)
    caption = f"{what}: means of steady strides, of both feet \N{PLUS-MINUS SIGN} standard deviation"
    table(parent, caption, HEADER, rows, "numbers gait")
    if parameters.coordination is not None:
        index = percent(parameters.coordination)
        add(parent, "p", f"Phase coordination index: {index} % (Plotnik et al. 2007).", class_="note")
    count = sum([foot_count for foot_count in strides if foot_count is not None])  # whole numbers
    if count < MIN_STRIDES:
        text = f"Of {count} strides: figures settle with {MIN_STRIDES} and more (Galna et al. 2013)."
        add(parent, "p", text, class_="note")


def _running_rows(parameters: GaitParameters) -> list[list[str]]:
    """Return the rows of the running measures (docs/gait.md); none for a walk."""
    run = running_means(parameters)
    if run is None:
        return []
    contacts = [None if one is None else one.stance_time for one in map(parameters.feet.get, Foot)]
    feet = [milliseconds(None if contact is None else contact.mean) for contact in contacts]
    rows = [["contact time, ms", *feet, milliseconds(run.contact_time), "-", "-"]]
    rows.append(["flight time, ms", "-", "-", milliseconds(run.flight_time), "-", "-"])
    rows.append(["vertical oscillation, mm", "-", "-", milliseconds(run.vertical_oscillation), "-", "-"])
    return rows


def _cadence(figures: StrideFigures | None) -> str:
    """Return the cadence of a foot, steps/min, as text: two steps in each stride."""
    return "-" if figures is None or figures.stride_time is None else number(120.0 / figures.stride_time.mean, 1)


def definitions(parent: Element, means: GaitMeans, *, difference: bool) -> bool:
    """Add the definitions of the parameters that are shown, with their sources; return False if there are none.

    `difference` says that the left/right difference is shown."""
    tables = _all(means)
    labels = {row.name: row.label for parameters in tables for row in gait_rows(parameters)}
    meanings = [(labels[name], meaning) for name, meaning in DEFINITIONS.items() if name in labels]
    meanings += RUNNING_DEFINITIONS if any(parameters.running for parameters in tables) else []
    if not meanings:
        return False
    has_feet = any(len(parameters.feet) == len(Foot) for parameters in tables)
    words = [] if has_feet else ["both", "asymmetry", "asymmetry of angles"]
    has_angles = bool({"toe_off_angle", "heel_strike_angle"} & labels.keys())
    words += [] if has_angles else ["asymmetry of angles"]
    meanings += [(word, meaning) for word, meaning in COLUMN_DEFINITIONS if word not in words]
    terms(parent, [*meanings, *([DIFFERENCE_DEFINITION] if difference else [])], class_="definitions")
    return True
