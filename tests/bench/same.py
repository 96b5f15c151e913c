"""Compares the events of sessions on all Pythons of this machine: `python tests/bench/same.py`. Status 1: they differ.

The running Python emulates the walks of tests/helpers/walks.py and writes them to a file: for each session its state
before the first item, its floor plan and its items. Then each Python, in a new virtual
environment with attrs and construct alone, restores the sessions, feeds the items one by one, and prints a hash of the
events and of the snapshots in the middle and at the end. Pythons are those on PATH, and those that pyenv and uv have
installed. `--pyodide 0.27.7 0.29.4` adds Pyodide, CPython for WebAssembly, of these versions: npm fetches it, and node
runs it. It has another C library, so its last bits may differ; then the largest difference of a number is printed.
`--recordings FILE ...` compares sessions with poses on recorded samples (.csv, .npz) instead of emulated walks.
`--compiled FOLDER` adds the compiled form that `.ci/compiled/build.py FOLDER` has made, in the running Python."""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
PACKAGES = ("attrs", "construct")
"""What a session needs, besides solepath."""
MINORS = range(11, 20)
"""Minor versions of Python 3 that are looked for."""
TOLERANCE = 1e-9
"""Largest difference of a number on another platform: absolute, or relative for numbers above 1."""
CODE = "import platform, sys; print(platform.python_implementation(), sys.version.split()[0], sys.prefix)"
MODULE = """
import { loadPyodide } from "pyodide";
const python = await loadPyodide();
for (const [name, folder] of Object.entries(%s)) {
  python.FS.mkdirTree(name);
  python.FS.mount(python.FS.filesystems.NODEFS, { root: folder }, name);
}
python.runPython(%s);
"""


def run(walks: str, results: str) -> None:
    """Run all sessions of the file `walks`, and write hash, events and snapshots of each to the file `results`."""
    from solepath import Packet, Sample, Session
    from solepath.floorplan.plan import FloorPlan
    from solepath.saving.codec import load

    found = {}
    for walk in json.loads(Path(walks).read_text()):
        plan = None if walk["plan"] is None else load(FloorPlan, walk["plan"])
        session = Session.restore(walk["state"], floorplan=plan)
        items = [load(Packet if "channel" in item else Sample, item) for item in walk["items"]]
        events, snapshots = [], []
        for number, item in enumerate(items, 1):
            events += [event.to_dict() for event in session.feed(item)]
            if number == len(items) // 2:
                snapshots.append(session.snapshot())
        events += [event.to_dict() for event in session.finish()]
        snapshots.append(session.snapshot())
        texts = [json.dumps(values, sort_keys=True) for values in (events, snapshots)]
        found[walk["name"]] = [*(sha256(text.encode()).hexdigest()[:16] for text in texts), len(events), events]
    Path(results).write_text(json.dumps(found))


def emulated_walks() -> list[dict[str, Any]]:
    """Return the sessions of tests/helpers/walks.py as plain data."""
    from solepath import Session
    from solepath.saving.codec import save

    sys.path[:0] = [str(path) for path in (Path(__file__).parents[1] / "helpers").rglob("") if path.is_dir()]
    from walks import machines

    walks = []
    for name, machine in machines().items():
        session = machine.start()
        if isinstance(session, Session):
            plan = None if session._plan is None else save(session._plan.plan)
            items = [save(item) for item in machine.items]
            walks.append({"name": name, "state": session.snapshot(), "plan": plan, "items": items})
    return walks


def recorded_walks(files: list[Path]) -> list[dict[str, Any]]:
    """Return sessions of the default recipe on recorded samples as plain data."""
    from solepath import Session
    from solepath.recording.samples import load_samples
    from solepath.saving.codec import save

    state = Session(poses=True).snapshot()
    return [
        {"name": str(file), "state": state, "plan": None, "items": [save(one) for one in load_samples(file)]}
        for file in files
    ]


def installed_pythons() -> dict[str, str]:
    """Return the programs of the Pythons on this machine, from 3.11 on, by name and version."""
    names = [shutil.which(f"python3.{minor}") for minor in MINORS]
    names += [sys.executable, shutil.which("python3"), shutil.which("pypy3")]
    home = Path.home()
    pyenv = Path(os.environ.get("PYENV_ROOT", home / ".pyenv"))
    uv = Path(os.environ.get("UV_PYTHON_INSTALL_DIR", home / ".local/share/uv/python"))
    names += [str(path) for folder in (pyenv / "versions", uv) for path in sorted(folder.glob("*/bin/python3"))]
    found: dict[str, str] = {}
    for program in filter(None, names):
        answer = subprocess.run([program, "-c", CODE], capture_output=True, text=True, check=False).stdout.split()
        if len(answer) >= 2 and tuple(map(int, answer[1].split(".")[:2])) >= (3, MINORS[0]):
            found.setdefault(f"{answer[0]} {answer[1]}", program)
    return found


def run_python(program: str, folder: Path, walks: Path, results: Path) -> str:
    """Run all sessions in a new virtual environment of this Python; return an error, "" for none."""
    environment = folder / "environment"
    subprocess.run([program, "-m", "venv", "--clear", environment], check=True, capture_output=True)
    python = next(path for path in (environment / "bin/python", environment / "Scripts/python.exe") if path.exists())
    install = [python, "-m", "pip", "install", "--quiet", *requirements()]
    subprocess.run(install, check=True, capture_output=True)
    return feed(python, ROOT / "src", walks, results)


def feed(python: Path | str, source: Path, walks: Path, results: Path) -> str:
    """Run all sessions in a Python that has what a session needs, with the package in `source`; return an error."""
    words = [python, __file__, "--run", walks, "--results", results]
    given = {**os.environ, "PYTHONPATH": str(source), "PYTHONHASHSEED": "random"}
    return subprocess.run(words, env=given, capture_output=True, text=True, check=False).stderr


def run_compiled(package: Path, folder: Path, walks: Path, results: Path) -> str:
    """Run all sessions in the running Python with the package in this folder; return an error, "" for none."""
    given = {**os.environ, "PYTHONPATH": str(package)}
    form = subprocess.run([sys.executable, "-m", "solepath", "--version"], env=given, capture_output=True, text=True)
    if not form.stdout.rstrip().endswith(", compiled"):
        return f"Error: {form.stdout or form.stderr}"
    return feed(sys.executable, package, walks, results)


def requirements() -> list[str]:
    """Return the packages that a session needs, in the versions that are installed here."""
    return [f"{package}=={version(package)}" for package in PACKAGES]


def run_pyodide(release: str, folder: Path, walks: Path, results: Path) -> str:
    """Run all sessions in this release of Pyodide; return an error, "" for none."""
    subprocess.run(["npm", "install", "--silent", "--prefix", folder, f"pyodide@{release}"], check=True)
    packages = folder / "packages"
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--target", packages, *requirements()]
    subprocess.run(install, check=True, capture_output=True)
    mounts = {"/repository": ROOT, "/packages": packages, "/walks": walks.parent}
    program = f"""
import sys
sys.path[:0] = ["/repository/src", "/repository/tests/bench", "/packages"]
import same
same.run("/walks/{walks.name}", "/walks/{results.name}")
"""
    module = MODULE % (json.dumps({name: str(path) for name, path in mounts.items()}), json.dumps(program))
    (folder / "run.mjs").write_text(module)
    done = subprocess.run(["node", "run.mjs"], cwd=folder, capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stderr or done.stdout


def last_error(text: str) -> str:
    """Return the last line of an output that names an error, cut to 200 characters."""
    lines = re.findall(r"^\w+Error:.*$", text, re.MULTILINE) or text.splitlines() or ["no result"]
    return str(lines[-1])[:200]


def difference(one: Any, other: Any) -> float:
    """Return the largest difference of two numbers in equal places; infinity when anything else differs."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        return max((difference(one[key], other[key]) for key in one), default=0.0)
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return max(map(difference, one, other), default=0.0)
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) / max(1.0, abs(one), abs(other))
    return 0.0 if one == other else math.inf


def main() -> int:
    """Run the command and return its exit status."""
    parser = argparse.ArgumentParser(description="Compares the events of sessions on all Pythons of this machine.")
    parser.add_argument("--pyodide", nargs="+", default=[], metavar="RELEASE", help="releases of Pyodide to add")
    parser.add_argument("--recordings", nargs="+", default=[], type=Path, metavar="FILE", help="recorded samples")
    parser.add_argument("--compiled", type=Path, metavar="FOLDER", help="folder of a compiled form to add")
    parser.add_argument("--run", metavar="WALKS", help=argparse.SUPPRESS)
    parser.add_argument("--results", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.run:
        run(chosen.run, chosen.results)
        return 0
    runs: list[tuple[str, str, Callable[..., str], Any]] = []
    runs += [(name, "native", run_python, program) for name, program in installed_pythons().items()]
    if chosen.compiled:
        runs.append((f"compiled, {sys.version.split()[0]}", "native", run_compiled, chosen.compiled.resolve()))
    runs += [(f"Pyodide {release}", "WebAssembly", run_pyodide, release) for release in chosen.pyodide]
    status, first_of, first = 0, dict[str, dict[str, Any]](), None
    with tempfile.TemporaryDirectory() as directory:
        folder = Path(directory)
        walks = folder / "walks.json"
        walks.write_text(json.dumps(recorded_walks(chosen.recordings) if chosen.recordings else emulated_walks()))
        print(f"{'Python':24}{'platform':14}{'sessions':>9}{'events':>9}  hash of events and snapshots")
        for number, (name, platform, runner, what) in enumerate(runs):
            place, results = folder / str(number), folder / f"results{number}.json"
            place.mkdir()
            error = runner(what, place, walks, results)
            if error or not results.exists():
                print(f"{name:24}{platform:14}  failed: {last_error(error)}")
                status = 1
                continue
            found = json.loads(results.read_text())
            hashes = {session: values[:2] for session, values in found.items()}
            digest = sha256(json.dumps(hashes, sort_keys=True).encode()).hexdigest()[:16]
            print(f"{name:24}{platform:14}{len(found):>9}{sum(values[2] for values in found.values()):>9}  {digest}")
            like = first_of.setdefault(platform, found)
            differing = [session for session in found if found[session][:2] != like[session][:2]]
            if differing:
                status = 1
                print(f"    differs on one platform: {', '.join(differing)}")
            if first is None:
                first = found
            elif like is found:
                largest = max(difference(first[session][3], found[session][3]) for session in found)
                status |= not largest <= TOLERANCE
                print(f"    largest difference of a number to the first line: {largest:.1e}, allowed {TOLERANCE:.0e}")
    return status


if __name__ == "__main__":
    sys.exit(main())
