"""Compiled modules give the events of pure ones, bit for bit, and states go from the one form to the other and back.

Only some modules are compiled here, without optimisation, to save time: those of samples and their views, stances,
attitude and the wearer. `python tests/bench/same.py --compiled FOLDER` compares many sessions with all hot modules."""

from __future__ import annotations

import ast
import json
import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Sequence
from importlib.util import find_spec
from inspect import CO_NEWLOCALS
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
from here import ROOT
from walks import insoles

import solepath
from solepath import Packet, Session, StrideTaken
from solepath.emulate.routes.route import Route

MODULES = (
    "types/plain.py", "types/records.py", "types/vector.py", "foot/settings.py", "foot/phase.py", "foot/view.py",
    "foot/stance/stance.py", "foot/stance/cycle.py", "foot/navigate/corrector.py",
    "foot/navigate/strapdown.py", "session/state.py", "body/part.py",
)  # fmt: skip
"""Modules of classes that derive from protocols, are frozen, are made at every sample, or hold the state of others."""
SETTLED = 400
"""Packets of the first 2 s, which import what a session needs."""
PACKETS = insoles(Route().stand(2.0).walk(15.0, 1.3).stop(2.0), seed=4).packets
CONTINUE = """
import json, sys
from pathlib import Path
from solepath import Packet, Session, Site

state, rows = json.loads(Path(sys.argv[1]).read_text())
session = Session.restore(state)
packets = [Packet(t, Site(site), channel, bytes.fromhex(data)) for t, site, channel, data in rows]
events = session.feed(packets)
assert "mypy_extensions" not in sys.modules, "which a wheel does not bring"
tracker = next(iter(session.feet.values()))
forms = [type(one).update.__class__.__name__ for one in (tracker.detector, tracker.corrector.interval)]
print(json.dumps([[event.to_dict() for event in events], session.snapshot(), forms]))
"""


BUILD = ROOT / ".ci" / "compiled" / "build.py"
SOURCE = Path(solepath.__file__).parent


def declared(name: str) -> Any:
    """Return a constant of build.py."""
    for node in ast.parse(BUILD.read_text("utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == name:
            return ast.literal_eval(node.value)
    raise AssertionError(f"build.py has no {name}")


def called_modules(packets: Sequence[Packet]) -> set[str]:
    """Return the files of solepath whose functions are called by frames without events, or by those that end a stride.

    Code of a module itself and of its classes runs once, when a frame is the first that needs the module."""
    called: set[str] = set()
    frame_calls: set[str] = set()

    def on_call(frame: FrameType, event: str, _: object) -> None:
        code = frame.f_code
        if event == "call" and code.co_filename.startswith(f"{SOURCE}/") and code.co_flags & CO_NEWLOCALS:
            frame_calls.add(str(Path(code.co_filename).relative_to(SOURCE)))

    session = Session()
    session.feed(packets[:SETTLED])
    for packet in packets[SETTLED:]:
        frame_calls.clear()
        sys.setprofile(on_call)
        try:
            events = session.feed(packet)
        finally:
            sys.setprofile(None)
        if not events or any(isinstance(event, StrideTaken) for event in events):
            called |= frame_calls
    return called


def test_each_module_that_a_frame_calls_is_compiled_or_says_why_not() -> None:
    matched = {pattern: set(SOURCE.glob(pattern)) for pattern in declared("HOT")}
    assert all(matched.values()), "a pattern of HOT matches no module"
    hot = {str(file.relative_to(SOURCE)) for files in matched.values() for file in files}
    pure, called = declared("PURE"), called_modules(PACKETS)
    assert called <= hot | pure.keys(), f"HOT or PURE of {BUILD} must have each of them"
    assert pure.keys() <= called and all(pure.values()), "a module of PURE is not called, or has no reason"
    assert {"foot/tracker.py", "body/activity/motion.py", "body/gait/cycles.py"} <= called, "of each kind of frame"


def lacking() -> str:
    """Return what a build needs and is not here; "" if nothing is lacking."""
    compiler = (sysconfig.get_config_var("CC") or "cc").split()[0]
    header = Path(sysconfig.get_path("include"), "Python.h")
    needed = {"mypyc": find_spec("mypyc"), "setuptools": find_spec("setuptools"), compiler: shutil.which(compiler)}
    absent = [name for name, found in needed.items() if found is None]
    return ", ".join(absent if header.exists() else [*absent, "Python.h"])


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the package, some of whose modules are compiled."""
    if lacking():
        pytest.skip(f"solepath cannot be compiled here without {lacking()}")
    folder = tmp_path_factory.mktemp("compiled")
    command = [sys.executable, BUILD, folder, "0", *MODULES]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def run(folder: Path, *arguments: object) -> str:
    command, environment = [sys.executable, *map(str, arguments)], {**os.environ, "PYTHONPATH": str(folder)}
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout


def go_on(folder: Path, state: Any, packets: list[Packet], place: Path) -> list[Any]:
    """Return events, snapshot and kinds of two methods of a session that goes on in a new process."""
    rows = [(packet.t, packet.site.value, packet.channel, packet.data.hex()) for packet in packets]
    place.write_text(json.dumps([state, rows]))
    found: list[Any] = json.loads(run(folder, "-c", CONTINUE, place))
    return found


@pytest.mark.soak
def test_compiled_modules_give_the_same_events_and_states_bit_for_bit(compiled: Path, tmp_path: Path) -> None:
    third = len(PACKETS) // 3
    session = Session()
    session.feed(PACKETS[:third])
    state = session.snapshot()
    later, last = PACKETS[third : 2 * third], PACKETS[2 * third :]
    events, after, forms = go_on(compiled, state, later, tmp_path / "later")
    assert forms[0] == "method_descriptor" and forms[1] == "function", "the first is compiled, the second is not"
    assert events == json.loads(json.dumps([event.to_dict() for event in session.feed(later)]))
    assert after == json.loads(json.dumps(session.snapshot()))
    # back: the pure form goes on from the compiled form's state, as the compiled form does itself
    back = Session.restore(after)
    events, after, _ = go_on(compiled, after, last, tmp_path / "last")
    assert any(event["event"] == "StrideTaken" for event in events)
    assert events == json.loads(json.dumps([event.to_dict() for event in back.feed(last)]))
    assert after == json.loads(json.dumps(back.snapshot()))


@pytest.mark.soak
def test_the_version_names_the_form_that_runs(compiled: Path) -> None:
    assert run(compiled, "-m", "solepath", "--version").rstrip().endswith(", compiled")
    assert run(ROOT / "src", "-m", "solepath", "--version").rstrip().endswith(", pure")
