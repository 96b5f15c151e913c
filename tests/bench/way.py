"""Counts the calls of a packet, and what is loaded for it: `python tests/bench/way.py`. Prints; asserts nothing.

First come the calls. Frames of two insoles with 96 cells at 100 Hz are fed to a session. For each frame every call of a
function in src/solepath is counted, with the number of files and of changes from one folder ("room") of src/solepath to
another. Generated code (attrs) and other packages do not count. A generator counts each time that it continues. A quiet
frame causes no event; frames of the other kind end a stride. Numbers are medians over a walk.

Then come the modules of solepath that `import solepath; Session(...)` loads: their number, their lines, their syntax
nodes as `.ci/size` counts them, and the processor time beside that of `import attrs, construct`, of `import solepath`
alone, whose names are imported when they are first used, and of `solepath --help`. They are medians over new processes.
The last line adds the first packets of two insoles, which load what a session needs from then on.
`--calls` lists the functions of a frame of each kind.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections import Counter
from importlib.machinery import SourceFileLoader
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
FED = "default, after the first packets of two insoles"
RUNS = 7
"""Number of fresh processes of each kind."""


@frozen
class FrameCalls:
    """The calls of one frame, in order."""

    codes: tuple[CodeType, ...]

    @property
    def files(self) -> int:
        return len({code.co_filename for code in self.codes})

    @property
    def folders(self) -> list[str]:
        return [folder_of(code) for code in self.codes]

    @property
    def changes(self) -> int:
        folders = self.folders
        return sum(one != other for one, other in zip(folders, folders[1:], strict=False))


def folder_of(code: CodeType) -> str:
    """Return the folder of src/solepath that has the function, or its file when it is in none of the folders."""
    return code.co_filename.removeprefix(OURS).partition("/")[0]


def calls_of(session: Session, packet: Packet) -> tuple[FrameCalls, list[Any]]:
    """Return the calls of one packet, and its events."""
    codes: list[CodeType] = []

    def on_call(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and frame.f_code.co_filename.startswith(OURS):
            codes.append(frame.f_code)

    sys.setprofile(on_call)
    try:
        events = session.feed(packet)
    finally:
        sys.setprofile(None)
    return FrameCalls(tuple(codes)), events


def collect_calls(packets: tuple[Packet, ...]) -> tuple[list[FrameCalls], list[FrameCalls]]:
    """Return the calls of the frames without events and of those that end a stride."""
    session = Session()
    frames_without_events, stride_frames = [], []
    for packet in packets:
        frame_calls, events = calls_of(session, packet)
        if packet.channel != "insole/frame":
            continue
        if not events:
            frames_without_events.append(frame_calls)
        elif any(isinstance(event, StrideTaken) for event in events):
            stride_frames.append(frame_calls)
    return frames_without_events, stride_frames


def print_calls(name: str, frames: list[FrameCalls], calls: bool) -> None:
    median_count = median_low([len(frame_calls.codes) for frame_calls in frames])
    files, changes = (
        median([frame_calls.files for frame_calls in frames]),
        median([frame_calls.changes for frame_calls in frames]),
    )
    print(f"{name}, median of {len(frames)}: {median_count} calls, {files:.0f} files, {changes:.0f} changes of room")
    named = Counter[str]()
    for frame_calls in frames:
        named.update(set(frame_calls.folders))
    medians = {
        one: median([frame_calls.folders.count(one) for frame_calls in frames]) for one, _ in named.most_common()
    }
    folder_counts = sorted(medians.items(), key=lambda item: (-item[1], item[0]))
    print("  " + ", ".join(f"{one} {count:.0f}" for one, count in folder_counts if count))
    if calls:
        frame_calls = next(frame_calls for frame_calls in frames if len(frame_calls.codes) == median_count)
        for code in frame_calls.codes:
            print(f"    {code.co_filename.removeprefix(OURS):45} {code.co_qualname}")


def run_fresh(program: str) -> str:
    """Return the output of a program in a new process, which keeps its bytecode as an installed package does."""
    keeping = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    words = [sys.executable, "-c", program]
    return subprocess.run(words, env=keeping, capture_output=True, text=True, check=True).stdout


TIMED_PROGRAM = """
from time import process_time
began = process_time()
{work}
print(process_time() - began)
"""
FIRST_PACKETS = 12
"""Number of packets after which both insoles have sent their layout and some samples."""
FEED_STATEMENT = """from solepath import Packet, Session, Site
session = Session()
for t, site, channel, data in {packets!r}: session.feed(Packet(t, Site(site), channel, data))"""
START_STATEMENT = "from solepath import Session, recipes; Session(recipes.by_name({name!r}))"
MODULES_PROGRAM = """
import sys
{work}
import solepath
from pathlib import Path
here = str(Path(solepath.__file__).parent)
files = {{m.__file__ for m in sys.modules.values() if (getattr(m, "__file__", None) or "").startswith(here)}}
print("\\n".join(files))
"""
SIZE = SourceFileLoader("size", str(Path(__file__).resolve().parents[2] / ".ci" / "size")).load_module()


def print_loading(packets: tuple[Packet, ...]) -> None:
    """Print the times of each kind of process, run in rotation so that a slower machine slows down all of them."""
    first = [(packet.t, packet.site.value, packet.channel, packet.data) for packet in packets[:FIRST_PACKETS]]
    works = {
        "attrs, construct": "import attrs, construct",
        "solepath": "import solepath",
        "help": "from solepath.cli import main\ntry: main(['--help'])\nexcept SystemExit: pass",
        **{name: START_STATEMENT.format(name=name) for name in RECIPES},
        FED: FEED_STATEMENT.format(packets=first),
    }
    times: dict[str, list[float]] = {name: [] for name in works}
    for work in works.values():
        run_fresh(work)
    for _ in range(RUNS):
        for name, work in works.items():
            times[name].append(float(run_fresh(TIMED_PROGRAM.format(work=work)).split()[-1]))
    reference_time = median(times["attrs, construct"])
    print(f"import attrs, construct: {reference_time * 1e3:.0f} ms")
    print(f"import solepath, before any of its names is used: {median(times['solepath']) * 1e3:.0f} ms")
    print(f"solepath --help: {median(times['help']) * 1e3:.0f} ms")
    for name in (*RECIPES, FED):
        sources = [
            Path(file).read_text("utf-8")
            for file in run_fresh(MODULES_PROGRAM.format(work=works[name])).split("\n")[:-1]
        ]
        lines, nodes = sum(len(one.splitlines()) for one in sources), sum(map(SIZE.nodes, sources))
        seconds = median(times[name])
        print(
            f"import solepath; Session({name}): {len(sources)} modules, {lines} lines, {nodes} syntax nodes, "
            f"{seconds * 1e3:.0f} ms, {seconds / reference_time:.1f} times attrs and construct"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--calls", action="store_true", help="list the functions of one frame of each kind")
    parser.add_argument("--no-import", action="store_true", help="the way alone")
    options = parser.parse_args()
    packets = emulate(ROUTE, radio=CLEAN, seed=1).packets
    frames_without_events, stride_frames = collect_calls(packets)
    print_calls("a quiet frame", frames_without_events, options.calls)
    print_calls("a frame that ends a stride", stride_frames, options.calls)
    if not options.no_import:
        print_loading(packets)


if __name__ == "__main__":
    main()
