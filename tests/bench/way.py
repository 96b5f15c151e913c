"""Counts the calls of a packet, and what is loaded for it: `python tests/bench/way.py`. Prints; asserts nothing.

First the calls: one frame of an insole with 96 cells, both feet at 100 Hz, is fed to a session. Every call of a
function whose file is in src/solepath is counted, with the number of files and of changes from one folder ("room") of
src/solepath to another. Generated code (attrs) and other packages do not count; a generator counts each time that it
continues. A quiet frame causes no event; the other kind ends a stride. Medians over a walk.

Then what `import solepath; Session(...)` loads: modules of ours, their lines, and the processor time beside that of
`import attrs, construct`, in fresh processes; medians too. `--calls` lists the functions of a frame of each kind.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path
from statistics import median, median_low
from types import CodeType, FrameType
from typing import Any

from attrs import frozen

import solepath
from solepath import Packet, Session, StrideTaken
from solepath.emulate.radio import CLEAN
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import emulate

OURS = str(Path(solepath.__file__).parent) + "/"
ROUTE = Route().stand(2.0).walk(50.0, 1.3).stop(2.0)
RECIPES = ("default", "kupt-dfpc", "footstep-tracker", "walking-modes", "pressure-contour", "shoe-sensing")
"""The default recipe and one of each paper."""
RUNS = 7
"""Number of fresh processes of each kind."""


@frozen
class Way:
    """The calls of one frame, in order."""

    codes: tuple[CodeType, ...]

    @property
    def files(self) -> int:
        return len({code.co_filename for code in self.codes})

    @property
    def rooms(self) -> list[str]:
        return [room(code) for code in self.codes]

    @property
    def changes(self) -> int:
        rooms = self.rooms
        return sum(one != other for one, other in zip(rooms, rooms[1:], strict=False))


def room(code: CodeType) -> str:
    """Return the folder of src/solepath of a function, or its file when that is in none."""
    return code.co_filename.removeprefix(OURS).partition("/")[0]


def way_of(session: Session, packet: Packet) -> tuple[Way, list[Any]]:
    """Return the calls of one packet, and its events."""
    codes: list[CodeType] = []

    def called(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and frame.f_code.co_filename.startswith(OURS):
            codes.append(frame.f_code)

    sys.setprofile(called)
    try:
        events = session.feed(packet)
    finally:
        sys.setprofile(None)
    return Way(tuple(codes)), events


def ways(packets: tuple[Packet, ...]) -> tuple[list[Way], list[Way]]:
    """Return the calls of the frames without events and of those that end a stride."""
    session = Session()
    idle, ending = [], []
    for packet in packets:
        way, events = way_of(session, packet)
        if packet.channel != "insole/frame":
            continue
        if not events:
            idle.append(way)
        elif any(isinstance(event, StrideTaken) for event in events):
            ending.append(way)
    return idle, ending


def show(name: str, found: list[Way], calls: bool) -> None:
    middle = median_low([len(way.codes) for way in found])
    files, changes = median([way.files for way in found]), median([way.changes for way in found])
    print(f"{name} ({len(found)}): {middle} calls, {files:.0f} files, {changes:.0f} changes of room")
    named = Counter[str]()
    for way in found:
        named.update(set(way.rooms))
    each = {one: median([way.rooms.count(one) for way in found]) for one, _ in named.most_common()}
    most = sorted(each.items(), key=lambda item: (-item[1], item[0]))
    print("  " + ", ".join(f"{one} {count:.0f}" for one, count in most if count))
    if calls:
        way = next(way for way in found if len(way.codes) == middle)
        for code in way.codes:
            print(f"    {code.co_filename.removeprefix(OURS):45} {code.co_qualname}")


def fresh(program: str) -> str:
    """Return what a program prints in a separate process, which keeps its bytecode as an installed package does."""
    keeping = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    words = [sys.executable, "-c", program]
    return subprocess.run(words, env=keeping, capture_output=True, text=True, check=True).stdout


TIMED = """
from time import process_time
began = process_time()
{work}
print(process_time() - began)
"""
START = "from solepath import Session, recipes; Session(recipes.by_name({name!r}))"
LOADED = """
import sys
{work}
import solepath
from pathlib import Path
here = str(Path(solepath.__file__).parent)
files = {{m.__file__ for m in sys.modules.values() if (getattr(m, "__file__", None) or "").startswith(here)}}
print(len(files), sum(len(Path(file).read_text("utf-8").splitlines()) for file in files))
"""


def loading() -> None:
    """Time each kind of process in rotation, so that a machine that slows down slows them all."""
    works = {"attrs, construct": "import attrs, construct", **{name: START.format(name=name) for name in RECIPES}}
    took: dict[str, list[float]] = {name: [] for name in works}
    for work in works.values():
        fresh(work)
    for _ in range(RUNS):
        for name, work in works.items():
            took[name].append(float(fresh(TIMED.format(work=work))))
    yard = median(took["attrs, construct"])
    print(f"import attrs, construct: {yard * 1e3:.0f} ms")
    for name in RECIPES:
        modules, lines = fresh(LOADED.format(work=works[name])).split()
        seconds = median(took[name])
        print(
            f"import solepath; Session({name}): {modules} modules, {lines} lines, "
            f"{seconds * 1e3:.0f} ms, {seconds / yard:.1f} times attrs and construct"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--calls", action="store_true", help="list the functions of one frame of each kind")
    parser.add_argument("--no-import", action="store_true", help="the way alone")
    options = parser.parse_args()
    idle, ending = ways(emulate(ROUTE, radio=CLEAN, seed=1).packets)
    show("a quiet frame", idle, options.calls)
    show("a frame that ends a stride", ending, options.calls)
    if not options.no_import:
        loading()


if __name__ == "__main__":
    main()
