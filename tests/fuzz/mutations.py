"""Prints which small faults in the core the tests notice: `python tests/fuzz/mutations.py [--count N] [--file NAME]`.

In a copy of src it makes one small fault at a time in one of five files: a comparison turned round, + for -, a number
changed, or a branch left out. The same text always gets the same faults. Then it runs the tests of TESTS_OF_FILE and
prints "caught" or "survived" for each fault, and a count for each file. Run it before and after tests are deleted:
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

TESTS_OF_FILE: dict[str, tuple[str, ...]] = {
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
"""Tests (below tests/) that must notice a fault, by the file of src/solepath; the quickest tests first."""

COMPARISON_PAIRS = ((ast.Lt, ast.GtE), (ast.LtE, ast.Gt), (ast.Eq, ast.NotEq), (ast.Is, ast.IsNot), (ast.In, ast.NotIn))
OPPOSITE_COMPARISONS = {one: other for pair in COMPARISON_PAIRS for one, other in (pair, pair[::-1])}
OPPOSITE_OPERATORS = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
"""Operators by the operators that a fault replaces with them."""
Fault = tuple[int, str, Callable[[], None]]
"""Line, description, and the function that makes the fault in the syntax tree."""


def faults(tree: ast.Module) -> Iterator[Fault]:
    """Yield every possible fault, in the order of the text."""
    skipped = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.keyword) and node.arg == "init"}
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare) and type(node.ops[0]) in OPPOSITE_COMPARISONS:
            opposite = OPPOSITE_COMPARISONS[type(node.ops[0])]()
            yield (
                node.lineno,
                f"{ast.unparse(node)} turned round",
                lambda node=node, op=opposite: node.ops.__setitem__(0, op),
            )
        elif isinstance(node, ast.BinOp | ast.AugAssign) and type(node.op) in OPPOSITE_OPERATORS:
            operator = OPPOSITE_OPERATORS[type(node.op)]()
            yield (
                node.lineno,
                f"{ast.unparse(node)} by {type(operator).__name__}",
                lambda node=node, op=operator: setattr(node, "op", op),
            )
        elif isinstance(node, ast.Constant) and isinstance(node.value, bool | int | float) and id(node) not in skipped:
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
    found = sorted((line, description) for line, description, _ in faults(ast.parse(source)))
    chosen = found if len(found) <= count else [found[i * len(found) // count] for i in range(count)]
    changed = []
    for line, description in chosen:
        tree = ast.parse(source)
        for fault_line, name, change in list(faults(tree)):
            if (fault_line, name) == (line, description):
                change()
                break
        changed.append((line, description, ast.unparse(ast.fix_missing_locations(tree)) + "\n"))
    return changed


def passes(copy: Path, tests: tuple[str, ...], limit: float) -> bool:
    """Return whether the tests pass with the library in `copy` within `limit` s. Bytecode is kept for the next run."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider", *tests]
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"PYTHONPATH": str(copy), "PYTHONPYCACHEPREFIX": str(copy.with_name("bytecode"))}
    try:
        process = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return False
    if process.returncode > 1:
        raise SystemExit(process.stdout.decode() + process.stderr.decode())
    return process.returncode == 0


def run_faults(name: str, count: int, report: Callable[[str], None]) -> None:
    """Report which of at most `count` faults in one file its tests catch."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "src")
        shutil.copytree(ROOT / "src", copy, ignore=shutil.ignore_patterns("__pycache__"))
        file = copy / "solepath" / name
        source = file.read_text()
        tests = tuple(f"tests/{test}" for test in TESTS_OF_FILE[name])
        started_at = time.monotonic()
        if not passes(copy, tests, 3600.0):
            raise SystemExit(f"{name}: its tests fail as it is")
        limit = 60.0 + 5.0 * (time.monotonic() - started_at)
        caught = 0
        changed = sample(source, count)
        for number, (line, description, text) in enumerate(changed):
            file.write_text(text)
            os.utime(file, (number, number))  # Python compiles a file again when its time in seconds differs
            survived = passes(copy, tests, limit)
            caught += not survived
            report(f"{name}:{line}: {'survived' if survived else 'caught  '} {description}")
        report(f"{name}: {caught} of {len(changed)} caught")


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--count", type=int, default=12, help="faults in a file (default: %(default)s)")
    options.add_argument("--file", choices=TESTS_OF_FILE, action="append", help="only this file; may be given again")
    options.add_argument("--out", type=Path, help="append what is printed to this file too")
    chosen = options.parse_args()

    def report(line: str) -> None:
        print(line, flush=True)
        if chosen.out is not None:
            with chosen.out.open("a") as out:
                out.write(line + "\n")

    for name in chosen.file or TESTS_OF_FILE:
        run_faults(name, chosen.count, report)


if __name__ == "__main__":
    main()
