"""The golden corpus: inputs that are kept as files, what a session says of them, and one hash a case and kind of event.

An input is a file of `inputs/`: packets or samples, one a line of JSON, compressed. A case (cases.py) feeds an input,
changed by plain arithmetic, to a session, so neither numpy nor the emulator can change what a case is given. Every
session is fed in pieces of 1, 7 and 64 items, restored from a snapshot after two fifths and from its packed form after
three, and asked in between what an app may ask and what numbers it keeps. `events.txt` has the hashes, `recorded.txt`
those of recorded data; `.ci/golden` checks and writes both."""

from __future__ import annotations

import json
import lzma
import math
import platform
from collections.abc import Callable, Iterable, Iterator
from enum import Enum
from functools import cache
from hashlib import sha256
from itertools import cycle
from pathlib import Path
from types import NoneType
from typing import Any

import attrs

from solepath import Foot, Packet, Sample, Session, Site, recipes

FOLDER = Path(__file__).resolve().parent
TABLES = {False: FOLDER / "events.txt", True: FOLDER / "recorded.txt"}
"""Tables of hashes: of the inputs that are here, and of recorded data, which are not."""
CHUNKS = (1, 7, 64)
"""Numbers of items that are fed at once, in rotation."""
ASKED = 151
"""Number of items after which a session is asked what an app may ask; a prime, so that every phase is met."""
DIGITS = 10
"""Hexadecimal digits of a hash: two of some thousand differ by chance once in 10^5 tables."""


@attrs.frozen
class Call:
    """A call of the session between two items, by the name of a method and its arguments."""

    method: str
    arguments: tuple[Any, ...] = ()
    options: dict[str, Any] = attrs.field(factory=dict)


Item = Packet | Sample | Call


@attrs.frozen
class Case:
    """One row of the corpus: `make` returns the items, or, without a recipe, values that are recorded as they are."""

    name: str
    make: Callable[[], Iterable[Any]]
    recipe: str = ""
    options: Callable[[], dict[str, Any]] = dict
    """Returns the keywords of the session."""
    recorded: bool = False
    """True for a case of recorded data."""
    heading: float | None = None
    """First heading of the wearer, rad, for a recipe that takes one."""


def read_items(path: Path) -> tuple[Packet | Sample, ...]:
    """Return the packets or samples of an input."""
    with lzma.open(path, "rt") as file:
        return tuple([_item(json.loads(line)) for line in file])


def _item(values: dict[str, Any]) -> Packet | Sample:
    site = Site(values.pop("site"))
    if "channel" in values:
        return Packet(values["t"], site, values["channel"], bytes.fromhex(values["data"]), values.get("device", ""))
    made = {key: tuple(value) if isinstance(value, list) else value for key, value in values.items()}
    return Sample(site=site, **made)


@cache
def given(name: str) -> tuple[Any, ...]:
    """Return the items of an input by its name, read once a process."""
    return read_items(FOLDER / "inputs" / f"{name}.jsonl.xz")


@cache
def _names(kind: type) -> tuple[str, ...] | None:
    """Return the names of the fields of a record's class, or None for a class that is no record."""
    return tuple(field.name for field in attrs.fields(kind)) if attrs.has(kind) else None


def plain(value: Any) -> Any:
    """Return a record as JSON has it, with the name of its class and every number to its last bit."""
    kind = type(value)
    if kind in (float, int, str, bool, NoneType):
        return value
    if kind in (tuple, list):
        return [plain(one) for one in value]
    if (names := _names(kind)) is not None:
        return {"": kind.__name__, **{name: plain(getattr(value, name)) for name in names}}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, dict):
        return {str(plain(key)): plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    return value


def said(case: Case) -> Iterator[dict[str, Any]]:
    """Yield what a case says: events in their order, and answers, each as `plain` has it."""
    if not case.recipe:
        for value in case.make():
            made = plain(value)
            yield made if isinstance(made, dict) and "" in made else {"": "Value", "value": made}
        return
    options = case.options()
    plan, profiles = options.get("floorplan"), options.get("profiles", ())
    recipe = recipes.by_name(case.recipe)
    if case.heading is not None:
        recipe = recipe.with_heading(case.heading)
    session = Session(recipe, **options)
    items = list(case.make())
    saved, packed = len(items) * 2 // 5, len(items) * 3 // 5
    place = fed = 0
    for size in cycle(CHUNKS):
        if place == len(items):
            break
        piece = items[place : place + size]
        if any(isinstance(item, Call) for item in piece):
            piece = piece[:1]
        place += len(piece)
        (first, *_) = piece
        if isinstance(first, Call):
            answer = getattr(session, first.method)(*first.arguments, **first.options)
        else:
            answer = session.feed(piece)
        yield from map(plain, answer or ())
        if fed // ASKED != place // ASKED:
            yield answers(session)
        if fed < saved <= place:
            snapshot = json.loads(json.dumps(session.snapshot()))
            yield kept(snapshot)
            session = Session.restore(snapshot, floorplan=plan, profiles=profiles)
        if fed < packed <= place:
            session = Session.unpack(session.pack(), recipe, floorplan=plan, profiles=profiles)
        if not fed:
            yield kept(session.snapshot())
        fed = place
    yield from map(plain, session.finish())
    yield answers(session)
    yield kept(session.snapshot())


def kept(snapshot: Any) -> dict[str, Any]:
    """Return the numbers, flags and words that a session keeps, in order: a record may have another name or place.

    Evidence that leads to no event on a walk shows its faults here: of exchanged feet, of north, of drift."""
    numbers: list[float] = []
    words: list[str] = []
    left = [snapshot["state"]]
    while left:
        value = left.pop()
        if isinstance(value, dict):
            left += value.values()
        elif isinstance(value, list):
            left += value
        elif isinstance(value, int | float):
            numbers.append(float(value))
        elif isinstance(value, str) and value[:1].islower():  # a class has another name
            words.append(value)
    return {"": "(kept)", "numbers": sorted(numbers, key=_with_sign), "words": sorted(words)}


def _with_sign(number: float) -> tuple[float, float]:
    """Return a key that sorts -0.0 before 0.0."""
    return number, math.copysign(1.0, number)


def answers(session: Session) -> dict[str, Any]:
    """Return what an app can ask a session."""
    feet = {
        foot.value: [tracker.position, tracker.velocity, tracker.attitude] for foot, tracker in session.feet.items()
    }
    asked = (session.now, session.position, session.place, session.activity, session.gait, session.support, feet)
    names = ("now", "position", "place", "activity", "gait", "support", "feet")
    phases = {foot.value: plain(session.phase(foot)) for foot in Foot}
    return {"": "(asked)", "phases": phases, **{name: plain(value) for name, value in zip(names, asked, strict=True)}}


Rows = dict[str, tuple[int, str]]
"""Number and hash of what a case says, by its kind."""


def rows_of(case: Case) -> Rows:
    """Return the rows of a case."""
    counts: dict[str, int] = {}
    digests: dict[str, Any] = {}
    for event in said(case):
        kind = event[""]
        counts[kind] = counts.get(kind, 0) + 1
        digests.setdefault(kind, sha256()).update(json.dumps(event).encode() + b"\n")
    return {kind: (counts[kind], digests[kind].hexdigest()[:DIGITS]) for kind in sorted(counts)}


def read_table(recorded: bool) -> tuple[str, dict[str, Rows]]:
    """Return the platform of a table, and its rows by case."""
    first, *lines = TABLES[recorded].read_text().splitlines()
    table: dict[str, Rows] = {}
    case = ""
    for line in lines:
        if line.startswith("  "):
            kind, count, digest = line.split()
            table[case][kind] = int(count), digest
        elif line and not line.startswith("#"):
            case = line
            table[case] = {}
    return first.removeprefix("# platform: "), table


def write_table(table: dict[str, Rows], recorded: bool) -> None:
    """Write a table for this platform."""
    lines = [f"# platform: {this_platform()}", "# case, and below it kind of event, number, hash"]
    for case, rows in table.items():
        lines += ["", case, *(f"  {kind:24} {count:7} {digest}" for kind, (count, digest) in rows.items())]
    TABLES[recorded].write_text("\n".join(lines) + "\n")


@cache
def this_platform() -> str:
    """Return the name of a platform with the same bits of all numbers: its C library rounds sin, cos and exp alike."""
    rounded = sha256()
    for k in range(4000):
        x = (k - 2000) * 0.0123456789
        numbers = (math.sin(x), math.cos(x), math.exp(x), math.atan2(x, 1.5 - x), math.log1p(abs(x)), math.tan(x))
        rounded.update(repr((*numbers, math.hypot(x, 0.7), abs(x) ** 0.37, math.acos(math.sin(x)))).encode())
    return f"{platform.system()} {platform.machine()}, arithmetic {rounded.hexdigest()[:8]}"
