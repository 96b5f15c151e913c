"""Builds the site: one folder of files that any web server can serve, without Python on it.

    build_site(Path("site"), packets)

The same sources give the same bytes. Numbers without a source were chosen by hand."""

from __future__ import annotations

import gzip
import io
import json
import shutil
import zipfile
from base64 import b64encode
from collections.abc import Iterable, Mapping
from hashlib import sha256
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

from ...recording import PacketWriter
from ...session.json_host import filters
from ...types import Packet
from ..report.style import STYLE
from .pyodide import LOCK, RUNTIME, STANDARD_LIBRARY, VERSION, BuildError, minimal_lock, package_files, run_node

HERE = Path(__file__).parent
PAGE = HERE.parent / "page" / "static"
OWN_PACKAGES = ("solepath", "attr", "attrs", "construct")
"""Packages that go to the site, as far as they are used."""
LIBRARY, DEMO, WORKER_LIST = "python.zip.gz", "demo.jsonl.gz", "sw.js"
MARK = "site.json"
"""File of the site: what it is, which sensors a browser offers, and its files, which the next build replaces."""
EPOCH = (1980, 1, 1, 0, 0, 0)
"""Date of all files in an archive: the earliest that a zip file can have."""
HEAD, CONTROLS = "</head>", "</header>"
"""Places of index.html before and behind which the site adds its own elements."""


def build_site(out: Path, demo: Iterable[Packet]) -> dict[str, bytes]:
    """Build the site with a recording to show; return its files by name, after writing them to the folder `out`.

    BuildError is raised, with one sentence, when Pyodide or node is missing or fails, or for another folder's files."""
    earlier_files(out)
    package = package_files()
    with TemporaryDirectory() as directory:
        build = Path(directory)
        with PacketWriter(build / "demo.jsonl") as writer:
            for packet in demo:
                writer.write(packet)
        library = _library(build, package)
        demo_file = gzip.compress((build / "demo.jsonl").read_bytes(), 9, mtime=0)
    files = {name: package[name] for name in RUNTIME}
    files |= {LOCK: minimal_lock(package[LOCK]), LIBRARY: library, DEMO: demo_file}
    files |= {path.name: path.read_bytes() for folder in (PAGE, HERE / "static") for path in sorted(folder.iterdir())}
    fragments = {name: files.pop(f"{name}.html").decode() for name in ("head", "controls")}
    files["index.html"] = _index(files["index.html"].decode(), **fragments).encode()
    known = {"solepath": version("solepath"), "pyodide": VERSION, "filters": filters()}
    mark = {**known, "files": sorted([*files, MARK])}
    files[MARK] = json.dumps(mark).encode()
    files[WORKER_LIST] = _with_list(files)
    write_site(out, files)
    return files


def earlier_files(out: Path) -> frozenset[str]:
    """Return the names of the files that an earlier build wrote to a folder; BuildError if it holds something else."""
    if not out.exists() or (out.is_dir() and not any(out.iterdir())):
        return frozenset()
    try:
        names = json.loads((out / MARK).read_bytes())["files"]
        return frozenset(name for name in names if Path(name).name == name and (out / name).is_file())
    except (OSError, ValueError, KeyError, TypeError):
        raise BuildError(f"{out}: exists and is no site that solepath wrote") from None


def write_site(out: Path, files: Mapping[str, bytes]) -> None:
    """Write the files of a site; of an earlier one the files are replaced or deleted, and others are left alone.

    BuildError is raised, and nothing is changed, when another file has a name that the site needs."""
    earlier = earlier_files(out)
    for name in sorted(files.keys() - earlier):
        if (out / name).exists():
            raise BuildError(f"{out / name}: exists, and was not written by solepath")
    out.mkdir(parents=True, exist_ok=True)
    for name in earlier - files.keys():
        (out / name).unlink(missing_ok=True)
    for name, data in files.items():
        (out / name).write_bytes(data)


def compressed_size(data: bytes) -> int:
    """Return the size of a file as a server sends it with gzip, bytes; never more than the file itself."""
    return min(len(data), len(gzip.compress(data, 9)))


def _index(text: str, head: str, controls: str) -> str:
    """Return the page with the site's own elements in its head and below its heading."""
    style = b64encode(sha256(STYLE.encode()).digest()).decode()
    text = text.replace(HEAD, f"{head.replace('{report style}', style)}{HEAD}")
    return text.replace(CONTROLS, f"{CONTROLS}\n\n{controls}")


def _with_list(files: Mapping[str, bytes]) -> bytes:
    """Return the service worker with the list of all files, and a version that changes with any of them."""
    digest = sha256()
    for name in sorted(files):
        digest.update(f"{name} {len(files[name])}\n".encode() + files[name])
    names = json.dumps(["./", *sorted(name for name in files if name != WORKER_LIST)])
    own = files[WORKER_LIST].decode()
    return f'const VERSION = "{digest.hexdigest()[:16]}";\nconst FILES = {names};\n\n{own}'.encode()


def _library(build: Path, package: Mapping[str, bytes]) -> bytes:
    """Return the archive of compiled modules: of solepath, what it needs, and the standard library, if used.

    The archive itself is not compressed, but whole: it is smaller so, and modules are read faster."""
    (build / "pyodide").mkdir()
    for name in (*RUNTIME, STANDARD_LIBRARY, LOCK):
        (build / "pyodide" / name).write_bytes(package[name])
    for name in OWN_PACKAGES:
        folder = Path(str(import_module(name).__file__)).parent
        shutil.copytree(folder, build / "source" / name, ignore=shutil.ignore_patterns("__pycache__", "static"))
    (build / "source" / "pdb.py").touch()  # construct imports the debugger, of which the site has no use
    shutil.copy(HERE / "node" / "prepare.mjs", build)
    run_node("node", str(build / "prepare.mjs"), str(build))
    packed = _files_below(build / "compiled", "**/*.pyc")
    for read in ("body/**/*.json", "papers/**/*.json", "recording/mapping/*.toml"):  # by modules, beside themselves
        packed |= _files_below(build / "source", f"solepath/{read}")
    return _archive(packed)


def _files_below(folder: Path, pattern: str) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.glob(pattern)}


def _archive(files: Mapping[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name in sorted(files):
            archive.writestr(zipfile.ZipInfo(name, EPOCH), files[name])
    return gzip.compress(out.getvalue(), 9, mtime=0)
