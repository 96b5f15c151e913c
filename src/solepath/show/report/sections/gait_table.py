"""Adds the gait tables to a report, of walking and of running, and the definitions of their parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from xml.etree.ElementTree import Element

from ....body.gait.means import GaitParameters, StrideFigures
from ....events import GaitCycleMeasured
from ....types import Foot
from ...tables.gait import MIN_STRIDES, gait_cells, gait_rows, strides_of, sure_rows
from ...tables.table import milliseconds, percent
from ..markup import notes, table, terms
from ..running import running_means

HEADER = ("parameter", "left", "right", "both", "CV %", "asymmetry")
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
FOOT_PARAMETERS = ("clearance", "toe_off_angle", "heel_strike_angle")
"""Parameters of how a foot moves, which no result of a walk test needs."""
STEADY = ("steady strides", "neither first nor last of a walk, nor in a turn, on stairs or degraded")
VARIATION = ("CV", "standard deviation / mean, of both feet (Hausdorff 2005)")
BOTH_FEET = ("both", "mean of the feet's means; SD from the mean of their variances (Galna et al. 2013)")
ASYMMETRY = ("asymmetry", "(right - left) / their mean; 0 of equal feet, none of a flight (Robinson et al. 1987)")
ANGLES = ("asymmetry of angles", "right - left, in degrees, and no CV: their zero is the flat sole, not nothing")
DIFFERENCE = (
    "asymmetry of swing time",
    "of each right swing against the left ones around it, with a 95 % interval; named if all of it is above 10 ms",
)
RUNNING = [
    ("contact time", "from contact to toe-off of a foot (Novacheck 1998)"),
    ("flight time", "from toe-off to the other foot's contact (Novacheck 1998)"),
    (
        "vertical oscillation",
        "of the centre of mass, from contact and flight by a spring-mass model (Morin et al. 2005)",
    ),
]


def gait_table(
    parent: Element, parameters: GaitParameters, cycles: Iterable[GaitCycleMeasured], *, brief: bool
) -> None:
    """Add the table of walking or of running, of these gait cycles; a `brief` one has no FOOT_PARAMETERS."""
    known, left_out = sure_rows(parameters, cycles, FOOT_PARAMETERS if brief else ())
    # the standard deviation is on a line of its own
    rows = gait_cells(parameters, "\n\N{PLUS-MINUS SIGN}", known)
    if (run := running_means(parameters)) is not None:
        contacts = [parameters.feet.get(foot, StrideFigures()).stance_time for foot in Foot]
        feet = ["-" if one is None else milliseconds(one.mean) for one in contacts]
        rows += [
            ["contact time, ms", *feet, milliseconds(run.contact_time), "-", "-"],
            ["flight time, ms", "-", "-", milliseconds(run.flight_time), "-", "-"],
            ["vertical oscillation, mm", "-", "-", milliseconds(run.vertical_oscillation), "-", "-"],
        ]
    what = "Running" if parameters.running else "Walking"
    caption = f"{what}: means of steady strides, of both feet \N{PLUS-MINUS SIGN} standard deviation"
    table(parent, caption, HEADER, rows, "numbers gait")
    if parameters.coordination is not None:
        notes(parent, [f"Phase coordination index: {percent(parameters.coordination)} % (Plotnik et al. 2007)."])
    notes(parent, left_out)
    count = sum([strides_of(parameters, foot) or 0 for foot in Foot])  # whole numbers
    if count < MIN_STRIDES:
        notes(parent, [f"Of {count} gait cycles: figures settle with {MIN_STRIDES} and more (Galna et al. 2013)."])


def definitions(parent: Element, tables: Sequence[GaitParameters], *, difference: bool, brief: bool) -> None:
    """Add the definitions of the parameters that are shown, with their sources.

    `difference` says that the left/right difference is shown, `brief` that the tables have no FOOT_PARAMETERS."""
    rows = [row for parameters in tables for row in gait_rows(parameters)]
    labels = {row.name: row.label for row in rows if not brief or row.name not in FOOT_PARAMETERS}
    meanings = [(labels[name], meaning) for name, meaning in DEFINITIONS.items() if name in labels]
    meanings += [*(RUNNING if any([one.running for one in tables]) else []), STEADY]
    if any([len(parameters.feet) == len(Foot) for parameters in tables]):
        meanings += [BOTH_FEET, VARIATION, ASYMMETRY]
        meanings += [ANGLES] if labels.keys() & {"toe_off_angle", "heel_strike_angle"} else []
    else:
        meanings.append(VARIATION)
    terms(parent, [*meanings, *([DIFFERENCE] if difference else [])], "definitions")
