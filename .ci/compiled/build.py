#!/usr/bin/env python3
"""Compiles the hot modules of solepath: `python .ci/compiled/build.py FOLDER [LEVEL [PATTERN ...]]`.

It needs mypy, construct-typing, setuptools and a C compiler. FOLDER gets a copy of the package with the compiled
modules beside their sources, and can stand on PYTHONPATH. LEVEL is the compiler's level of optimisation, 2 if none is
given; modules that match a pattern are compiled instead of all of HOT.
`SOLEPATH_COMPILED=1 pip install .` installs the same (hook.py). docs/hot-code.md has the reasons."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

from classes import base_protocols, read_classes
from rewrite import ModuleRewriter

SOURCE = Path(__file__).resolve().parents[2] / "src"
HOT = (
    "events/[abdghlp]*.py",
    "events/foot.py",
    "types/layout.py",
    "types/plain.py",
    "types/records.py",
    "types/vector.py",
    "foot/*.py",
    "foot/cues/*.py",
    "foot/navigate/[bcels]*.py",
    "foot/pressure/*.py",
    "foot/stance/s*.py",
    "foot/stance/cycle.py",
    "link/clock.py",
    "link/counters.py",
    "link/decoder.py",
    "link/health.py",
    "link/kinds.py",
    "link/periodic.py",
    "link/devices/insole.py",
    "wire/cells.py",
    "wire/envelope.py",
    "wire/insole.py",
    "session/repeats.py",
    "session/session.py",
    "session/state.py",
    "body/part.py",
    "body/activity/*.py",
    "body/checks/**/*.py",
    "body/fuse/[bemps]*.py",
    "body/fuse/common_error.py",
    "body/fuse/walked_path.py",
    "body/gait/*.py",
    "body/altitude.py",
    "body/wear.py",
)
"""Modules whose code runs for every sample, packet, half second or stride with the default recipe."""
PURE = {
    "calibration/records.py": "records that an app may give; of it only usual_strides runs, a division a stride",
    "types/doubles.py": "its type has another form at run time",
}
"""Modules that run as often and are not compiled, with the reason."""
EXACT = ["-ffp-contract=off", "-w"]
"""Options of gcc and clang: no fused multiply-add, whose results have other last bits than Python's; no warnings."""
GROUP = "solepath"
"""Name of the library that has all compiled modules: solepath__mypyc."""


def hot_modules(patterns: Sequence[str]) -> dict[str, Path]:
    """Return the files that are compiled by the names of their modules; an error for a pattern without any."""
    found = {pattern: set((SOURCE / "solepath").glob(pattern)) for pattern in patterns}
    if empty := [pattern for pattern, files in found.items() if not files]:
        raise SystemExit(f"no module matches {', '.join(empty)}")
    files = sorted({file for files in found.values() for file in files})
    named = {".".join(file.relative_to(SOURCE).with_suffix("").parts): file for file in files}
    return {module: file for module, file in named.items() if file.name != "__init__.py"}


def build(folder: Path, optimisation: str = "2", *patterns: str) -> None:
    """Copy the package into `folder` and compile its hot modules there, or those of the patterns alone."""
    shutil.rmtree(folder / "solepath", ignore_errors=True)
    shutil.copytree(SOURCE / "solepath", folder / "solepath", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(Path(__file__).with_name("records.py"), folder / "solepath" / "_compiled.py")
    files = hot_modules(patterns or HOT)
    classes = read_classes(files)
    named = {name: record for own in classes.values() for name, record in own.items()}
    bases = base_protocols(SOURCE, named)
    copies = {module: folder / file.relative_to(SOURCE) for module, file in files.items()}
    for module, copy in copies.items():
        own = {**named, **classes[module]}  # two modules may have classes of one name
        rewritten = ModuleRewriter(own, bases).rewrite(files[module].read_text("utf-8"))
        copy.write_text(rewritten, "utf-8")
    _compile(folder, [str(copy.relative_to(folder)) for copy in copies.values()], optimisation)
    for module, copy in copies.items():  # beside the compiled modules stand their sources, for whoever reads them
        shutil.copy(files[module], copy)


def _compile(folder: Path, names: list[str], optimisation: str) -> None:
    from mypyc.build import mypycify
    from setuptools import setup
    from setuptools.command.build_ext import build_ext

    class BuildAtOnce(build_ext):
        def build_extensions(self) -> None:
            if self.compiler.compiler_type == "unix":
                self.compiler.compile = partial(_compile_at_once, self.compiler)
            super().build_extensions()

    os.chdir(folder)
    os.environ["MYPYPATH"] = str(folder)
    options = ["--follow-imports=silent", "--ignore-missing-imports", "--python-executable", sys.executable]
    # a file for each module: gcc takes far longer for one of all
    chosen = {"opt_level": optimisation, "debug_level": "0", "group_name": GROUP, "multi_file": True}
    extensions = mypycify([*options, *names], **chosen)
    for extension in extensions:
        if os.name != "nt":
            extension.extra_compile_args = [*extension.extra_compile_args, *EXACT]
    words = ["-q", "build_ext", "--inplace"]
    setup(name="solepath", packages=[], ext_modules=extensions, script_args=words, cmdclass={"build_ext": BuildAtOnce})
    shutil.rmtree(folder / "build")


def _compile_at_once(compiler: Any, sources: list[str], output_dir: str, macros: Any, **given: Any) -> list[str]:
    """Compile several files at a time, as distutils compiles one after another."""
    folders, depends, options = given["include_dirs"], given["depends"], given["extra_postargs"]
    _, objects, options, flags, made_of = compiler._setup_compile(
        output_dir, macros, folders, sources, depends, options
    )
    arguments = compiler._get_cc_args(flags, given["debug"], None)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for done in [pool.submit(compiler._compile, one, *made_of[one], arguments, options, flags) for one in objects]:
            done.result()
    return objects


if __name__ == "__main__":
    target = Path(sys.argv[1]).resolve()
    target.mkdir(parents=True, exist_ok=True)
    build(target, *sys.argv[2:])
