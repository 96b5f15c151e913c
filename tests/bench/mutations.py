"""Plants bugs and prints which of them the tests notice: `python tests/bench/mutations.py --count N --seed S`.

From a seed it draws N functions of the rooms that turn bytes into events, plants one bug in each, and runs the tests of
the five-minute suite that cover the function, the quick ones and the golden cases first, until one fails. It prints a
line for each bug, and last "killed K of N". A bug is one of nine kinds that people make (BUGS); which kind a function
gets is drawn first, and then the place. Which tests cover a function is known from coverage contexts, which a run of
the suite makes when they are missing or of another code (`.mutations/`, never committed).

A bug that no test notices survives, also when it cannot change what anybody sees; those that were looked at are in
`survivors.txt` with the reason, by function and change. A limit on a measured number is turned round, not moved by its
edge, because a measured number hardly ever meets its limit; one on a count is moved by its edge. So a wrong edge at the
full scale of raw counts is not among the bugs."""

from __future__ import annotations

import argparse
import ast
import hashlib
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / ".mutations"
SURVIVORS = Path(__file__).with_name("survivors.txt")
ROOMS = ("wire", "link", "foot", "body", "place", "floorplan", "papers", "session", "saving", "events", "recording")
"""Rooms that turn bytes into events; the place on a floor plan is in body."""
MOST_SECONDS = 150.0
"""Time of the tests that are run against one bug, s; those that take longest are left out."""
PATIENCE = 240.0
"""Time after which a run counts as one that does not end, which is noticed, s."""
FAVOUR = 0.3
"""Factor on the time of a golden case in the order of the tests, since it notices most."""
RESETTING = re.compile(r"reset|restart|clear|forget|begin|start|renew|finish|disconnect|bind|stop", re.IGNORECASE)
ORDERLESS = {
    "range",
    "isinstance",
    "issubclass",
    "min",
    "max",
    "hypot",
    "zip",
    "getattr",
    "hasattr",
    "isclose",
    "field",
    "print",
    "super",
    "dot",
    "_dot",
}
"""Functions whose arguments nobody swaps, or that are the same when swapped."""
SIDES = {
    "LEFT": "RIGHT",
    "LEFT_FOOT": "RIGHT_FOOT",
    "LEFT_SHANK": "RIGHT_SHANK",
    "LEFT_THIGH": "RIGHT_THIGH",
    "left": "right",
}
SIDES |= {right: left for left, right in SIDES.items()}
TURNS = {"rotate": "rotate_back", "rotate_back": "rotate", "sin": "cos", "cos": "sin"}


@dataclass(frozen=True)
class Bug:
    """A bug in one function: the text between two offsets of a file becomes another one."""

    file: str
    function: str
    lines: tuple[int, int]
    kind: str
    start: int
    end: int
    old: str
    new: str

    @property
    def change(self) -> str:
        return f"{self.kind}: {' '.join(self.old.split())[:90]} -> {' '.join(self.new.split())[:90] or 'nothing'}"


# --- bugs -------------------------------------------------------------------------------------------------------------

Change = tuple[ast.AST, str]
"""A node, and the text that replaces it."""


def is_number(node: ast.AST) -> bool:
    """Return whether a node may be a number: no text, list or tuple."""
    return not isinstance(node, ast.JoinedStr | ast.List | ast.Tuple | ast.ListComp | ast.Dict) and not (
        isinstance(node, ast.Constant) and isinstance(node.value, str | bytes)
    )


def is_count(node: ast.AST) -> bool:
    """Return whether a node is a whole number that is counted."""
    if isinstance(node, ast.Constant):
        return type(node.value) is int
    if isinstance(node, ast.BinOp):
        return is_count(node.left) or is_count(node.right)
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("len", "count", "ord")


def with_operator(node: ast.BinOp | ast.AugAssign, operator: ast.operator) -> str:
    if isinstance(node, ast.BinOp):
        return f"({ast.unparse(ast.BinOp(node.left, operator, node.right))})"
    return ast.unparse(ast.AugAssign(node.target, operator, node.value))


def sign(node: ast.AST, function: str) -> Iterator[str]:
    if isinstance(node, ast.BinOp) and is_number(node.left) and is_number(node.right):
        if isinstance(node.op, ast.Add | ast.Sub):
            yield with_operator(node, ast.Sub() if isinstance(node.op, ast.Add) else ast.Add())
    elif isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add | ast.Sub) and is_number(node.value):
        yield with_operator(node, ast.Sub() if isinstance(node.op, ast.Add) else ast.Add())
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield f"({ast.unparse(node.operand)})"


def term(node: ast.AST, function: str) -> Iterator[str]:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub | ast.Mult | ast.Div):
        if is_number(node.left) and is_number(node.right):
            yield f"({ast.unparse(node.left)})"
    elif isinstance(node, ast.BoolOp):
        yield f"({ast.unparse(ast.BoolOp(node.op, node.values[:-1]) if len(node.values) > 2 else node.values[0])})"


def boundary(node: ast.AST, function: str) -> Iterator[str]:
    if isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Lt | ast.LtE | ast.Gt | ast.GtE):
        edge = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
        turned = {ast.Lt: ast.Gt, ast.LtE: ast.GtE, ast.Gt: ast.Lt, ast.GtE: ast.LtE}
        counted = is_count(node.left) or any(is_count(one) for one in node.comparators)
        first = (edge if counted else turned)[type(node.ops[0])]()
        yield f"({ast.unparse(ast.Compare(node.left, [first, *node.ops[1:]], node.comparators))})"


def rotation(node: ast.AST, function: str) -> Iterator[str]:
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        arguments = [ast.unparse(one) for one in node.args]
        if node.func.id == "multiply" and len(arguments) == 2:
            yield f"multiply({arguments[1]}, {arguments[0]})"
        elif node.func.id == "conjugate" and len(arguments) == 1:
            yield f"({arguments[0]})"
        elif node.func.id in ("sin", "cos"):
            yield f"{TURNS[node.func.id]}({', '.join(arguments)})"
        elif node.func.id in ("rotate", "rotate_back"):
            yield f"{node.func.id}(({arguments[0]})[:1] + tuple(-one for one in ({arguments[0]})[1:]), {arguments[1]})"


def side(node: ast.AST, function: str) -> Iterator[str]:
    if isinstance(node, ast.Attribute) and node.attr in SIDES:
        yield f"{ast.unparse(node.value)}.{SIDES[node.attr]}"
    elif isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id == "OTHER":
        yield f"({ast.unparse(node.slice)})"


def reset(node: ast.AST, function: str) -> Iterator[str]:
    if RESETTING.search(function):
        is_call = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
        if (
            is_call
            or isinstance(node, ast.AugAssign | ast.Delete)
            or isinstance(node, ast.Assign)
            and all(isinstance(one, ast.Attribute | ast.Subscript) for one in node.targets)
        ):
            yield "pass"


def unit(node: ast.AST, function: str) -> Iterator[str]:
    if isinstance(node, ast.Constant) and type(node.value) is float and node.value not in (0.0, 1.0, -1.0, 0.5, 2.0):
        yield repr(node.value * 1000.0)
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("radians", "degrees"):
        yield f"({ast.unparse(node.args[0])})"


def argument(node: ast.AST, function: str) -> Iterator[str]:
    if isinstance(node, ast.Call) and len(node.args) >= 2 and ast.unparse(node.func).split(".")[-1] not in ORDERLESS:
        first, second, *rest = node.args
        are_names = all(isinstance(one, ast.Name | ast.Attribute | ast.Subscript) for one in (first, second))
        if are_names and ast.unparse(first) != ast.unparse(second):
            yield ast.unparse(ast.Call(node.func, [second, first, *rest], node.keywords))


def is_one(node: ast.AST) -> bool:
    """Return whether a node is a whole number in the code."""
    return isinstance(node, ast.Constant) and type(node.value) is int


def window(node: ast.AST, function: str) -> Iterator[str]:
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Slice):
        for name in ("lower", "upper"):
            end = getattr(node.slice, name)
            if end is not None:
                moved = ast.BinOp(end, ast.Add(), ast.Constant(1))
                ends = {key: getattr(node.slice, key) for key in ("lower", "upper", "step")}
                yield ast.unparse(ast.Subscript(node.value, ast.Slice(**{**ends, name: moved}), node.ctx))
    elif isinstance(node, ast.Call) and ast.unparse(node.func) == "range" and node.args:
        last = node.args[-1] if len(node.args) < 3 else node.args[1]
        arguments = [ast.BinOp(one, ast.Sub(), ast.Constant(1)) if one is last else one for one in node.args]
        yield ast.unparse(ast.Call(node.func, arguments, []))
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub) and is_one(node.right):
        yield f"({ast.unparse(node.left)})"


BUGS: dict[str, Callable[[ast.AST, str], Iterator[str]]] = {
    "a sign": sign,
    "a term left out": term,
    "a boundary": boundary,
    "the order of a rotation": rotation,
    "left for right": side,
    "a line of a reset left out": reset,
    "a unit": unit,
    "swapped arguments": argument,
    "a window off by one": window,
}
"""Kinds of bugs, each a function from a node and the name of its function to the texts that can replace the node."""


def functions(tree: ast.Module) -> Iterator[tuple[str, ast.FunctionDef | ast.AsyncFunctionDef]]:
    """Yield every function with its name, after that of its class."""

    def inside(node: ast.AST, path: tuple[str, ...]) -> Iterator[Any]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
                yield ".".join((*path, child.name)), child
            elif isinstance(child, ast.ClassDef):
                yield from inside(child, (*path, child.name))

    return inside(tree, ())


def parts(function: ast.FunctionDef | ast.AsyncFunctionDef) -> Iterator[ast.AST]:
    """Yield the nodes of a function's body, without annotations, texts and what an error says."""
    left: list[ast.AST] = list(function.body)
    while left:
        node = left.pop()
        if isinstance(node, ast.Raise | ast.JoinedStr | ast.Assert):
            continue
        yield node
        if isinstance(node, ast.AnnAssign):
            left += [node.value] if node.value else []
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            left += node.body if isinstance(node.body, list) else [node.body]
        else:
            left += ast.iter_child_nodes(node)


def bugs_of(path: Path, source_folder: Path) -> Iterator[list[Bug]]:
    """Yield the bugs that can be planted in each function of a file; none of a function without any."""
    source = path.read_text()
    starts = [0]
    for line in source.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    data = source.encode()
    file = str(path.relative_to(source_folder))
    for name, function in functions(ast.parse(source)):
        found = []
        lines = (function.body[0].lineno, function.end_lineno or 0)
        for node in parts(function):
            for kind, change in BUGS.items():
                for new in change(node, name):
                    start = starts[node.lineno - 1] + node.col_offset  # type: ignore[attr-defined]
                    end = starts[node.end_lineno - 1] + node.end_col_offset  # type: ignore[attr-defined]
                    found.append(Bug(file, name, lines, kind, start, end, data[start:end].decode(), new))
        if found:
            yield found


def draw(count: int, seed: int, project: Path) -> list[Bug]:
    """Return one bug in each of `count` functions of a project; the same seed and code give the same bugs."""
    drawn = random.Random(seed)
    source = project / "src" / "solepath"
    files = [path for room in ROOMS for path in sorted((source / room).rglob("*.py"))]
    everywhere = [found for path in files for found in bugs_of(path, source)]
    chosen = []
    for found in drawn.sample(everywhere, min(count, len(everywhere))):
        kind = drawn.choice(sorted({bug.kind for bug in found}))
        chosen.append(drawn.choice([bug for bug in found if bug.kind == kind]))
    return chosen


# --- tests ------------------------------------------------------------------------------------------------------------


def fingerprint(project: Path) -> str:
    """Return a hash of the code, the tests and the protocol of a project."""
    digest = hashlib.sha256()
    files = [path for name in ("src", "tests", "protocol") for path in (project / name).rglob("*") if path.is_file()]
    for path in sorted([*files, project / "pyproject.toml"]):
        if path.suffix != ".pyc":
            digest.update(str(path.relative_to(project)).encode() + path.read_bytes())
    return digest.hexdigest()[:16]


@dataclass
class Contexts:
    """Which tests run which lines, and how long each takes, s."""

    data: Any
    seconds: dict[str, float]

    def tests_of(self, bug: Bug) -> list[str]:
        """Return the tests that run a function, in the order in which they are tried, within MOST_SECONDS.

        A function that runs only while its module is imported is seen by the tests of the whole file."""
        first, last = bug.lines
        by_line = self.data.contexts_by_lineno(f"src/solepath/{bug.file}")
        inside = {one for line, names in by_line.items() if first <= line <= last for one in names}
        if inside == {""}:
            inside = {one for names in by_line.values() for one in names}
        tests = {one.removesuffix("|run").removesuffix("|setup") for one in inside}
        known = [test for test in tests if test in self.seconds]
        known.sort(key=lambda test: (self.seconds[test] * (FAVOUR if "/golden/" in test else 1.0), test))
        chosen, total = [], 0.0
        for test in known:
            total += self.seconds[test]
            if total <= MOST_SECONDS or not chosen:
                chosen.append(test)
        return chosen


def run_tests(folder: Path, *arguments: str, timeout: float | None = None, **variables: str) -> tuple[int, str]:
    """Run the tests of a copy of the project; return status and output, or -1 for a run that does not end."""
    path = os.pathsep.join([str(folder / "src"), str(Path(__file__).parent)])
    environment = os.environ | {"PYTHONPATH": path, "SOLEPATH_DATA": str(folder / "no-recorded-data"), **variables}
    environment |= {"PYTHONPYCACHEPREFIX": str(folder / ".bytecode"), "PYTHONDONTWRITEBYTECODE": ""}  # "" is no
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "mutations", *arguments]
    process = subprocess.Popen(
        command,
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    try:
        output, _ = process.communicate(timeout=timeout)
        return process.returncode, output
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.communicate()
        return -1, "it does not end"


def make_contexts(project: Path, jobs: int, tests: str) -> Contexts:
    """Return the contexts of a project, which a run of the tests below a folder makes unless they are there."""
    from coverage import CoverageData

    folder = KEPT / f"{fingerprint(project)}-{tests.replace('/', '-')}"
    if not (folder / "seconds.json").exists():
        shutil.rmtree(KEPT, ignore_errors=True)
        folder.mkdir(parents=True)
        rooms = "".join(f"    src/solepath/{room}/*\n" for room in ROOMS)
        (folder / "coveragerc").write_text(
            f"[run]\ndata_file = {folder / 'contexts'}\nrelative_files = true\ninclude =\n{rooms}"
        )
        began = time.monotonic()
        measured = ("--cov", f"--cov-config={folder / 'coveragerc'}", "--cov-context=test", "--cov-report=")
        parallel = ("-n", str(jobs), "--dist", "loadfile", "--no-loadscope-reorder")
        status, output = run_tests(project, tests, *parallel, *measured, MUTATIONS_SECONDS=str(folder / "seconds.json"))
        if status not in (0, 1):
            raise SystemExit(f"the tests do not run:\n{output[-2000:]}")
        print(f"contexts made in {time.monotonic() - began:.0f} s", flush=True)
    data = CoverageData(str(folder / "contexts"))
    data.read()
    return Contexts(data, json.loads((folder / "seconds.json").read_text()))


class Measured:
    """A plugin of pytest: writes the time of each test that passes, and keeps the order of the tests that are given."""

    def __init__(self) -> None:
        self.seconds: Counter[str] = Counter()
        self.failed: set[str] = set()

    def pytest_runtest_logreport(self, report: Any) -> None:
        self.seconds[report.nodeid] += report.duration
        if report.failed or report.skipped:
            self.failed.add(report.nodeid)

    def pytest_sessionfinish(self) -> None:
        if "PYTEST_XDIST_WORKER" not in os.environ:
            passed = {test: seconds for test, seconds in self.seconds.items() if test not in self.failed}
            Path(os.environ["MUTATIONS_SECONDS"]).write_text(json.dumps(passed))


class Ordered:
    """A plugin of pytest: runs the tests in the order of a file."""

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        order = {test: k for k, test in enumerate(Path(os.environ["MUTATIONS_ORDER"]).read_text().splitlines())}
        items.sort(key=lambda item: order.get(item.nodeid, len(order)))


def pytest_configure(config: Any) -> None:
    """Register what this run of pytest needs; this module is the plugin `mutations`."""
    if "MUTATIONS_SECONDS" in os.environ:
        config.pluginmanager.register(Measured())
    if "MUTATIONS_ORDER" in os.environ:
        config.pluginmanager.register(Ordered())


# --- a run ------------------------------------------------------------------------------------------------------------


def copy_project(folder: Path) -> Path:
    """Return a copy of the project in which bugs are planted."""
    left_out = shutil.ignore_patterns(".git", ".mutations", "__pycache__", ".venv", ".*_cache", "dist", "build")
    shutil.copytree(ROOT, folder, ignore=left_out)
    return folder


SOUND: set[str] = set()
"""Tests that killed a bug and pass alone without it."""


def judge(bug: Bug, tests: list[str], folder: Path) -> tuple[str, str]:
    """Plant a bug in a copy of the project and return ("killed", by what) or ("survived", why)."""
    if not tests:
        return "survived", "no test runs it"
    path = folder / "src" / "solepath" / bug.file
    whole, times = path.read_bytes(), path.stat()
    listed = folder / "chosen-tests.txt"
    listed.write_text("\n".join(tests))
    try:
        path.write_bytes(whole[: bug.start] + bug.new.encode() + whole[bug.end :])
        command = ("-x", "-q", "--no-header", "-rfE", "-n", "0", f"@{listed}")
        status, output = run_tests(folder, *command, timeout=PATIENCE, MUTATIONS_ORDER=str(listed))
    finally:
        path.write_bytes(whole)
        # bytecode is known by size and second of its source: one of the bug's must not pass for that of the whole file
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    if status == 0:
        return "survived", f"{len(tests)} tests"
    if status < 0:
        if run_tests(folder, *command, timeout=PATIENCE, MUTATIONS_ORDER=str(listed))[0] < 0:
            return "survived", "the tests do not end without the bug either"
        return "killed", "a test that does not end, or a crash"
    failed = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - |$)", output, re.MULTILINE)
    if failed is not None and failed.group(1) in tests and failed.group(1) not in SOUND:
        if run_tests(folder, "-q", "-n", "0", failed.group(1), timeout=PATIENCE)[0] != 0:
            return "survived", f"{failed.group(1)} fails without the bug"
        SOUND.add(failed.group(1))
    if failed is None and status not in (1, 2) and "while loading conftest" not in output:
        raise SystemExit(f"the tests of {bug.file} do not run:\n{output[-2000:]}")
    return "killed", failed.group(1) if failed else "an import"


def read_survivors() -> dict[str, str]:
    """Return the reason of each survivor that was looked at, by file, function and change."""
    if not SURVIVORS.exists():
        return {}
    lines = [line.split(" | ") for line in SURVIVORS.read_text().splitlines() if line and not line.startswith("#")]
    return {f"{place} | {change}": reason for place, change, reason in lines}


def plant(bugs: list[Bug], contexts: Contexts, copies: list[Path]) -> int:
    """Plant the bugs one after the other in the copies, print a line for each, and return how many were killed."""
    free: SimpleQueue[Path] = SimpleQueue()
    for copy in copies:
        free.put(copy)
    reasons = read_survivors()
    tests = {bug: contexts.tests_of(bug) for bug in bugs}

    def attempt(bug: Bug) -> tuple[Bug, str, str, float]:
        copy, began = free.get(), time.monotonic()
        try:
            verdict, by = judge(bug, tests[bug], copy)
        finally:
            free.put(copy)
        return bug, verdict, by, time.monotonic() - began

    killed = 0
    with ThreadPoolExecutor(len(copies)) as pool:
        for bug, verdict, by, seconds in pool.map(attempt, bugs):
            killed += verdict == "killed"
            place = f"{bug.file} {bug.function}"
            reason = reasons.get(f"{place} | {bug.change}")
            noted = f" (looked at: {reason})" if reason and verdict == "survived" else ""
            print(f"{verdict:8} {place} | {bug.change} | {by}, {seconds:.0f} s{noted}", flush=True)
    return killed


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--count", type=int, default=40, help="number of bugs")
    options.add_argument("--seed", type=int, default=1, help="seed that draws them")
    options.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="bugs that are tried at once")
    options.add_argument("--list", action="store_true", help="print the bugs without planting them")
    options.add_argument("--tests", default="tests", help="only tests below this folder")
    options.add_argument("--only", default="", help="only bugs in functions whose file and name contain this")
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as work:
        copies = [copy_project(Path(work) / str(k)) for k in range(1 if given.list else given.jobs)]
        drawn = draw(given.count, given.seed, copies[0])
        bugs = [bug for bug in drawn if given.only in f"{bug.file} {bug.function}"]
        if given.list:
            for bug in bugs:
                print(f"{bug.file} {bug.function} | {bug.change}")
            return 0
        contexts = make_contexts(copies[0], given.jobs, given.tests)
        killed = plant(bugs, contexts, copies)
    print(f"killed {killed} of {len(bugs)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
