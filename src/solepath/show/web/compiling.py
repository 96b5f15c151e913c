"""Compiles modules ahead, in Pyodide, whose Python the compiled modules are for.

A compiled module neither depends on the time nor is compared with its source, so that two builds give the same bytes.
"""

from __future__ import annotations

import py_compile
import zipfile
from collections.abc import Iterable
from pathlib import Path

WITHOUT_DOCSTRINGS = 2
"""Level of optimisation: docstrings and assert statements are left out, a fifth of the size."""
ARCHIVE = ".zip/"
"""Part of the path of a module of the standard library, which is in an archive."""


def compile_files(files: Iterable[str], source: str, target: str) -> None:
    """Compile modules below `source` or in an archive to .pyc files of the same places below `target`."""
    for file in sorted(files):
        archive, mark, inner = file.partition(ARCHIVE)
        path = Path(file)
        if mark:
            path = Path("/standard", inner)
            path.parent.mkdir(parents=True, exist_ok=True)
            with zipfile.ZipFile(f"{archive}.zip") as opened:
                path.write_bytes(opened.read(inner))
        else:
            inner = path.relative_to(source).as_posix()
        compiled = Path(target, inner).with_suffix(".pyc")
        compiled.parent.mkdir(parents=True, exist_ok=True)
        py_compile.compile(
            str(path),
            cfile=str(compiled),
            dfile=inner,
            doraise=True,
            optimize=WITHOUT_DOCSTRINGS,
            invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH,
        )
