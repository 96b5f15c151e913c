"""`solepath check FILE`: tells what is wrong with a recording, in sentences."""

from __future__ import annotations

from argparse import Namespace
from collections import Counter
from collections.abc import Sequence
from itertools import chain
from math import inf
from typing import TYPE_CHECKING, Any

from ..events import Defect, DefectFound, Flaw
from ..events.foot import LONGEST_HARMLESS_GAP
from ..recording import RecordingError, printable
from ..recording.errors import UnusableValues
from ..recording.source import label_files
from ..show.tables.table import counted
from ..types import Foot
from .common.failure import MAX_LENGTH
from .common.inputs import Recording, add_calibration, add_recipe_name, assumed_foot, calibration_of
from .common.own_devices import UnusedPackets, drivers_of
from .common.parser import add_command
from .common.tables import add_tables, axes_repair, source_named

if TYPE_CHECKING:
    from ..walk.walk import Walk

UNSEEN = (
    "all three axes of an accelerometer reversed, which turns left into right",
    "one sensor of a device turned against the other by up to about 10 degrees",
    "a gyroscope whose scale is wrong by less than about a half",
    "one axis of a sensor that is dead, in about half of the cases",
    "a gyroscope that is late against the accelerometer, or early, by less than 0.1 s",
    "a clock that runs at a wrong but constant speed, by less than about a third",
    "sensors of the feet that are exchanged, in about half of the walks",
    "clocks of the feet that are apart, of a wearer who limps",
)
"""Some defects that may be in data of which the checks report nothing; there are others."""
LARGE_SHARE = 0.1
"""Share of degraded strides of a foot from which on they are mentioned, and of damaged rows that must be mended; chosen
by hand."""


FLAW_WORDS = {
    Flaw.GAP: f"a gap of more than {1e3 * LONGEST_HARMLESS_GAP:.0f} ms",
    Flaw.RANGE: "values at the end of a range",
    Flaw.TWO_STRIDES: "two strides in one",
    Flaw.IMPOSSIBLE: "a speed or a height that cannot be",
}
"""What the sentence on degraded strides says of each flaw; strides that a defect spoils are not in it."""


def degraded_strides(walk: Walk, foot: Foot, found: Sequence[DefectFound]) -> str | None:
    """Return how many strides of a foot are degraded and by what; None if they are few.

    Strides after a defect that spoils its data do not count."""
    spoilt = min([one.known_at for one in found if one.spoils and one.site.foot is foot], default=inf)
    strides = [one for one in walk.strides[foot] if one.known_at < spoilt]
    degraded = [one for one in strides if one.degraded]
    if len(degraded) < max(1.0, LARGE_SHARE * len(strides)):
        return None
    flaws = Counter(flaw for one in strides for flaw in one.flaws)
    reasons = [f"{words} in {flaws[flaw]}" for flaw, words in FLAW_WORDS.items() if flaws[flaw]]
    return f"{foot} foot: {len(degraded)} of {counted(len(strides), 'stride')} degraded: {', '.join(reasons)}"


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = add_command(
        commands,
        "check",
        "say what is wrong with a recording",
        "Say what is wrong with a recording of packets (JSON Lines) or of samples (text tables, Excel,"
        " Parquet, .npz), in sentences. The exit status is 1 if something must be mended, also if the values are in"
        " another unit, and 2 if the file is no recording. Axes need about 20 s of walking, clocks 60 s.",
        "solepath check walk.csv",
        run=run,
    )
    add_tables(command)
    add_recipe_name(command)
    add_calibration(command)


def run(options: Namespace) -> int:
    """Check the recording and print the verdict; return 1 if something must be mended, else 0.

    RecordingError is raised for a file that cannot be read as a recording. One whose values are in another unit can be
    read, and gets a verdict. Rows and packets that cannot be read are left out and named."""
    from ..body.checks.axes import SETTLED_STRIDES
    from ..link.kinds import make_kinds
    from ..recipes import by_name
    from ..session import Session
    from ..show.tables.summary import link_health, wear_lines
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
        _print_list("must be mended", [_without_path(one) if is_one else str(one) for one in error.problems])
        print("nothing else was checked: mend this first")
        return 1
    session, recording = Session(recipe, calibration=calibration, poses=True, profiles=drivers), Recording(source)
    walk, unused = Walk(limit=None), UnusedPackets(make_kinds(drivers))
    must, found = list[str](), list[DefectFound]()
    may = [*filter(None, [assumed_foot(source)])]
    for item in chain(recording, [None]):
        if recording.failure is not None and not walk.item_count:
            raise recording.failure
        events = session.finish() if item is None else session.feed(item)
        walk.take(item, events)
        unused.take(item, events)
        found += [event for event in events if isinstance(event, DefectFound)]
    if recording.failure is not None:
        must.append(_without_path(recording.failure))
    for defect in found:
        if (what := words_beside(defect, found)) is not None:
            sentence = f"{defect.site.words}: {what}{axes_repair(source, defect)}"
            (must if defect.needs_action else may).append(sentence)
    bad_rows = source.bad_rows
    has_many = bad_rows is not None and bad_rows.count > LARGE_SHARE * (bad_rows.count + bad_rows.good)
    prefix = f"{printable(str(options.files[0]))}: " if is_one else ""
    (must if has_many else may).extend(flaw.removeprefix(prefix) for flaw in flaws)
    must += [*unused.sentences(), *wear_lines(walk), *walk.troubles]
    may += [*filter(None, [degraded_strides(walk, foot, found) for foot in Foot])]
    may += [*walk.limitations, *link_health(walk)]
    strides = {foot: counts.strides for foot, counts in walk.feet.items() if counts.strides}
    walked = ", ".join(f"{foot} foot {counted(count, 'stride')}" for foot, count in strides.items()) or "no stride"
    print(f"{name}: {walk.covered_time.total:.1f} s, {walked}")
    _print_list("must be mended", must)
    _print_list("worth knowing", may)
    if not must:
        print("nothing must be mended")
    if min(strides.values(), default=0) < SETTLED_STRIDES:
        needed = f"axes need {SETTLED_STRIDES} strides of a foot, and clocks of the feet a minute of walking"
        print(f"too few strides to check everything: {needed}")
    _print_list("not everything can be seen in the data; a check may miss, for example", UNSEEN)
    return 1 if must else 0


def words_beside(defect: DefectFound, found: Sequence[DefectFound]) -> str | None:
    """Return what to print of a defect beside the others; None if another one of its site says it more exactly."""
    others = [one for one in found if one.site is defect.site and one is not defect]
    if defect.defect is Defect.AXES and defect.axes is None and any(one.axes is not None for one in others):
        return None
    fault, _, advice = defect.what.partition(": choose a larger ")
    is_scaled = any(one.defect is Defect.WRONG_SCALE for one in others) and "accelerometer" in fault
    return f"{fault}: correct its scale first" if advice and is_scaled else defect.what


def _without_path(error: RecordingError) -> str:
    text = ": ".join([part for part in (error.where, error.what) if part])
    return f"{text}; repair: {error.repair}" if error.repair else text


def _print_list(title: str, sentences: Sequence[str]) -> None:
    if sentences:
        print("\n  ".join([f"{title}:", *(printable(sentence, MAX_LENGTH) for sentence in sentences)]))
