"""Prints which small faults in the core the tests notice: `python tests/bench/mutations.py [--count N] [--file NAME]`.

It takes five files of the core. In a copy of src it makes one small fault at a time (a comparison turned round, + for
-, a number changed, a branch left out), always the same ones for the same text, and runs the tests named here against
it. It prints "caught" or "survived" for each, and a count for each file. Run it before and after tests are deleted:
faults that were caught must still be caught.
"""

from __future__ import annotations

import argparse
import ast
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

CORE: dict[str, tuple[str, ...]] = {
    "link/clock.py": ("link/test_clock.py", "link/test_stories.py", "contracts/test_time.py"),
    "link/stream.py": (
        "link/test_stream.py",
        "link/test_readings.py",
        "link/test_drivers.py",
        "link/test_decoder.py",
        "link/test_insole.py",
        "link/test_sensortags.py",
        "link/test_stories.py",
        "link/test_receiver.py",
    ),
    "foot/stance/cycle.py": ("foot/test_stance.py", "foot/test_tracks.py", "foot/test_limits.py"),
    "foot/navigate/error_state.py": ("foot/test_tracks.py", "foot/test_level.py", "foot/test_limits.py"),
    "body/gait/measuring.py": ("body/test_gait_parameters.py", "body/test_gait_means.py", "link/test_gait_clocks.py"),
}
"""File of src/solepath -> the tests, below tests/, that must notice a fault in it, the quickest first."""

OPPOSITES = ((ast.Lt, ast.GtE), (ast.LtE, ast.Gt), (ast.Eq, ast.NotEq), (ast.Is, ast.IsNot), (ast.In, ast.NotIn))
TURNED = {one: other for pair in OPPOSITES for one, other in (pair, pair[::-1])}
SWAPPED = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
"""Operators, and the operators by which a fault replaces them."""
Fault = tuple[int, str, Callable[[], None]]
"""Line, description, and the function that changes the tree."""


def faults(tree: ast.Module) -> Iterator[Fault]:
    """Yield every possible fault, in the order of the text."""
    left = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.keyword) and node.arg == "init"}
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare) and type(node.ops[0]) in TURNED:
            turned = TURNED[type(node.ops[0])]()
            yield (
                node.lineno,
                f"{ast.unparse(node)} turned round",
                lambda node=node, op=turned: node.ops.__setitem__(0, op),
            )
        elif isinstance(node, ast.BinOp | ast.AugAssign) and type(node.op) in SWAPPED:
            swapped = SWAPPED[type(node.op)]()
            yield (
                node.lineno,
                f"{ast.unparse(node)} by {type(swapped).__name__}",
                lambda node=node, op=swapped: setattr(node, "op", op),
            )
        elif isinstance(node, ast.Constant) and isinstance(node.value, bool | int | float) and id(node) not in left:
            other = not node.value if isinstance(node.value, bool) else 2 * node.value + 1
            yield node.lineno, f"{node.value} is {other}", lambda node=node, value=other: setattr(node, "value", value)
        elif isinstance(node, ast.If):
            yield (
                node.lineno,
                f"if {ast.unparse(node.test)} left out",
                lambda node=node: setattr(node, "test", ast.Constant(False)),
            )


def sample(source: str, count: int) -> list[tuple[int, str, str]]:
    """Return (line, description, changed source) of at most `count` faults, spread evenly over the text."""
    found = sorted((line, what) for line, what, _ in faults(ast.parse(source)))
    chosen = found if len(found) <= count else [found[i * len(found) // count] for i in range(count)]
    changed = []
    for line, what in chosen:
        tree = ast.parse(source)
        for place, name, change in list(faults(tree)):
            if (place, name) == (line, what):
                change()
                break
        changed.append((line, what, ast.unparse(ast.fix_missing_locations(tree)) + "\n"))
    return changed


def passes(copy: Path, tests: tuple[str, ...], limit: float) -> bool:
    """Return whether the tests pass with the library in `copy`; its bytecode is kept beside it, for the next run."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider", *tests]
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"PYTHONPATH": str(copy), "PYTHONPYCACHEPREFIX": str(copy.with_name("bytecode"))}
    try:
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return False
    if done.returncode > 1:
        raise SystemExit(done.stdout.decode() + done.stderr.decode())
    return done.returncode == 0


def judge(name: str, count: int, report: Callable[[str], None]) -> None:
    """Run the tests with the faults of one file."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "src")
        shutil.copytree(ROOT / "src", copy, ignore=shutil.ignore_patterns("__pycache__"))
        file = copy / "solepath" / name
        source = file.read_text()
        tests = tuple(f"tests/{test}" for test in CORE[name])
        started_at = time.monotonic()
        if not passes(copy, tests, 3600.0):
            raise SystemExit(f"{name}: its tests fail as it is")
        limit = 60.0 + 5.0 * (time.monotonic() - started_at)
        caught = 0
        changed = sample(source, count)
        for number, (line, what, text) in enumerate(changed):
            file.write_text(text)
            os.utime(file, (number, number))  # Python compiles a file again when its time in seconds differs
            survived = passes(copy, tests, limit)
            caught += not survived
            report(f"{name}:{line}: {'survived' if survived else 'caught  '} {what}")
        report(f"{name}: {caught} of {len(changed)} caught")


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--count", type=int, default=12, help="faults in a file (default: %(default)s)")
    options.add_argument("--file", choices=CORE, action="append", help="only this file; may be given again")
    options.add_argument("--out", type=Path, help="append what is printed to this file too")
    chosen = options.parse_args()

    def report(line: str) -> None:
        print(line, flush=True)
        if chosen.out is not None:
            with chosen.out.open("a") as out:
                out.write(line + "\n")

    for name in chosen.file or CORE:
        judge(name, chosen.count, report)


if __name__ == "__main__":
    main()
