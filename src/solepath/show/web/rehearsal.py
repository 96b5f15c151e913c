"""Runs in Pyodide when the site is built: finds the modules that the site needs, and compiles them ahead.

A compiled module neither depends on the time nor is compared with its source, so that two builds give the same bytes.
"""

from __future__ import annotations

import py_compile
import sys
import traceback
import zipfile
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages

from ... import body, calibration, events, floorplan, foot, link, recipes, saving, session, types, wire
from ...recording import captures
from .. import page, report
from . import worker

ROOMS = (types, events, saving, calibration, floorplan, wire, link, foot, body, session, page, report)
"""Rooms of which every module goes to the site: a device or a file may need any of them."""
LEFT_OUT = ("solepath.show.page.server", "solepath.show.page.player.player_loop")
"""Modules that serve the page, for which the site has no use."""
UNUSED = "/ssl.py"
"""Module without which asyncio works, and the site too: its requests are the browser's."""
ENCODINGS = ("utf_8", "utf_8_sig", "ascii", "latin_1", "cp437", "utf_16", "cp1252", "iso8859_15")
"""Encodings of texts in files of other programs."""
WITHOUT_DOCSTRINGS = 2
"""Level of optimisation: docstrings and assert statements are left out, a fifth of the size."""
OWN = (__file__, py_compile.__file__)
"""Files of modules that only the build uses."""
ARCHIVE = ".zip/"
"""Part of the path of a module of the standard library, which is in an archive."""


def load_all() -> list[str]:
    """Import what the worker of the site may need; return the files of the modules that are loaded then."""
    names = [found.name for room in ROOMS for found in walk_packages(room.__path__, f"{room.__name__}.")]
    encodings = [f"encodings.{name}" for name in ENCODINGS]
    for name in (
        *[name for name in names if not name.startswith(LEFT_OUT)],
        *encodings,
        worker.__name__,
        captures.__name__,
    ):
        import_module(name)
    for name in recipes.NAMES:
        recipes.by_name(name)
    traceback.format_exc()
    specs = [getattr(module, "__spec__", None) for module in [*sys.modules.values()]]
    origins = {spec.origin for spec in specs if spec is not None and spec.origin}
    needed = origins.difference(OWN)
    return sorted(origin for origin in needed if origin.endswith(".py") and not origin.endswith(UNUSED))


def compile_files(files: list[str], source: str, target: str) -> None:
    """Compile modules below `source` or in an archive to .pyc files of the same places below `target`."""
    for file in files:
        archive, mark, inner = file.partition(ARCHIVE)
        path = Path(file)
        if mark:
            path = Path("/standard", inner)
            path.parent.mkdir(parents=True, exist_ok=True)
            with zipfile.ZipFile(f"{archive}.zip") as opened:
                path.write_bytes(opened.read(inner))
        else:
            inner = path.relative_to(source).as_posix()
        py_compile.compile(
            str(path),
            cfile=str(Path(target, inner).with_suffix(".pyc")),
            dfile=inner,
            doraise=True,
            optimize=WITHOUT_DOCSTRINGS,
            invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH,
        )
