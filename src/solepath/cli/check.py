"""`solepath check FILE`: tells what is wrong with a recording, in sentences."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from itertools import chain

from ..recording import RecordingError, printable
from ..recording.errors import UnusableValues
from ..recording.source import label_files
from ..show.tables.table import counted
from .common.failure import MAX_LENGTH
from .common.inputs import Recording, add_calibration, calibration_of, recipe_option, remarks_on
from .common.own_devices import drivers_of
from .common.parser import command
from .common.tables import axes_repair, source_named, table_options

UNSEEN = (
    "all three axes of an accelerometer reversed, which turns left into right",
    "one sensor of a device turned against the other by up to about 10 degrees",
    "a gyroscope whose scale is wrong by less than about a half, or is a quarter of the right one or less where "
    "somebody walks slowly",
    "one axis of a sensor that is dead, in about half of the cases",
    "a gyroscope that is late against the accelerometer, or early, by less than 0.1 s",
    "a clock that runs at a wrong but constant speed, by less than about a third",
    "sensors of the feet that are exchanged, in about half of the walks",
    "clocks of the feet that are apart, of a wearer who limps",
)
"""Some defects that may be in data of which the checks report nothing; there are others."""


def run(options: Namespace) -> int:
    """Check the recording and print the verdict; return 1 if something needs fixing, else 0.

    RecordingError is raised for a file that cannot be read as a recording. One whose values are in another unit can be
    read, and gets a verdict. Rows and packets that cannot be read are left out and named."""
    from ..body.checks.axes import SETTLED_STRIDES
    from ..link.kinds import make_kinds
    from ..recipes import by_name
    from ..session import Session
    from ..show.findings import Concern, findings
    from ..walk.walk import Walk

    recipe, calibration, drivers = by_name(options.recipe), calibration_of(options), drivers_of(options)
    name, flaws = printable(label_files(options.files)), list[str]()
    is_one = len(options.files) == 1
    try:
        source = source_named(options, report=flaws.append)
    except RecordingError as error:
        if not all(isinstance(problem, UnusableValues) for problem in error.problems):
            raise
        print(f"{name}: {'its' if is_one else 'their'} values cannot be used")
        _print_list("needs fixing", [_without_path(one) if is_one else str(one) for one in error.problems])
        print("nothing else was checked: fix this first")
        return 1
    session = Session(recipe, calibration=calibration, poses=True, losses=True, profiles=drivers)
    recording = Recording(source)
    walk, must = Walk(kinds=make_kinds(drivers)), list[str]()
    may = list[str]()
    for item in chain(recording, [None]):
        if recording.failure is not None and not walk.item_count:
            raise recording.failure
        events = session.finish() if item is None else session.feed(item)
        walk.take(item, events)
    if recording.failure is not None:
        must.append(_without_path(recording.failure))
    walk.remarks = remarks_on(source)
    for one in findings(walk):
        (must if one.act or one.concern is Concern.WEAR else may).append(one.text + axes_repair(source, one.event))
    prefix = f"{printable(str(options.files[0]))}: " if is_one else ""
    left_out = () if source.samples is None else source.samples.left_out
    counted_rows = tuple([one.what for one in walk.remarks])  # named already
    for flaw in flaws:
        if not flaw.endswith(counted_rows):
            (must if flaw in left_out else may).append(flaw.removeprefix(prefix))
    strides = {foot: counts.strides for foot, counts in walk.feet.items() if counts.strides}
    taken = [f"{foot} foot {counted(count, 'stride')}" for foot, count in strides.items()]
    of_cells = [foot for foot in walk.known_feet if not walk.has_strides(foot)]
    taken += [f"{foot} foot {counted(walk.cycles[foot].count, 'gait cycle')}" for foot in of_cells]
    walked = ", ".join(taken) or "no stride"
    print(f"{name}: {walk.covered_time.total:.1f} s, {walked}")
    _print_list("needs fixing", must)
    _print_list("worth knowing", may)
    if not must:
        print("nothing needs fixing")
    if of_cells and of_cells == walk.known_feet:
        print("without an inertial sensor, axes, scales and clocks cannot be checked")
        return 1 if must else 0
    if min(strides.values(), default=0) < SETTLED_STRIDES:
        needed = f"axes need {SETTLED_STRIDES} strides of a foot, and clocks of the feet a minute of walking"
        print(f"too few strides to check everything: {needed}")
    _print_list("not everything can be seen in the data; a check may miss, for example", UNSEEN)
    return 1 if must else 0


def _without_path(error: RecordingError) -> str:
    text = ": ".join([part for part in (error.where, error.what) if part])
    return f"{text}; repair: {error.repair}" if error.repair else text


def _print_list(title: str, sentences: Sequence[str]) -> None:
    if sentences:
        print("\n  ".join([f"{title}:", *(printable(sentence, MAX_LENGTH) for sentence in sentences)]))


add_check = command(
    "check",
    "Say what is wrong with a recording of packets (JSON Lines) or of samples (text tables, Excel,"
    " Parquet, .npz), in sentences. The exit status is 1 if something needs fixing, also if the values are in"
    " another unit, and 2 if the file is no recording. Axes need about 20 s of walking, clocks 60 s.",
    "solepath check walk.csv",
    table_options(),
    recipe_option(),
    add_calibration,
    run=run,
)
