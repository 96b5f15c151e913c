"""Prints the processor time of an hour of two insoles: `python tests/bench/energy/energy.py`. It asserts nothing.

The same 44 s of both feet with 96 cells at 100 Hz are fed RUNS times to new sessions, as packets, in CPython and in
Pyodide (CPython for WebAssembly, the one of `solepath web`), which runs in node without a page. The last run counts,
when node has compiled what it runs often. What the radio and drawing take is not in it.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from importlib import import_module
from pathlib import Path
from time import process_time

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from feeding import Walk  # noqa: E402
from measure import machine  # noqa: E402

from solepath.emulate.radio import CLEAN  # noqa: E402
from solepath.emulate.routes.route import Route  # noqa: E402
from solepath.emulate.walk import emulate  # noqa: E402
from solepath.recording import PacketWriter  # noqa: E402
from solepath.show.web.pyodide import VERSION, package_files, run_node  # noqa: E402
from solepath.show.web.site import OWN_PACKAGES  # noqa: E402

ROUTE = Route().stand(2.0).walk(50.0, 1.3).stop(2.0)
RUNS = 3


def time_cpython(recording: Path) -> list[float]:
    """Return the processor times of the runs in this interpreter, s."""
    walk, times = Walk(str(recording)), []
    for _ in range(RUNS):
        t_start = process_time()
        walk.feed()
        times.append(process_time() - t_start)
    return times


def time_pyodide(folder: Path) -> list[float]:
    """Return the processor times of the runs in Pyodide, s; `folder` has the recording."""
    (folder / "pyodide").mkdir()
    for name, data in package_files().items():
        (folder / "pyodide" / name).write_bytes(data)
    for package in map(import_module, OWN_PACKAGES):
        shutil.copytree(
            Path(str(package.__file__)).parent,
            folder / "source" / package.__name__,
            ignore=shutil.ignore_patterns("__pycache__"),
        )
    shutil.copy(HERE / "feeding.py", folder / "source")
    printed = run_node("node", str(HERE / "energy.mjs"), str(folder), str(RUNS))
    times: list[float] = json.loads(printed.splitlines()[-1])
    return times


def main() -> None:
    with tempfile.TemporaryDirectory(prefix="solepath-energy-") as directory:
        recording = Path(directory, "walk.jsonl")
        packets = emulate(ROUTE, radio=CLEAN, seed=1).packets
        with PacketWriter(recording) as writer:
            for packet in packets:
                writer.write(packet)
        results = {"CPython": time_cpython(recording), f"Pyodide {VERSION} in node": time_pyodide(Path(directory))}
    duration = packets[-1].t
    print(f"{machine()}, one used; {len(packets)} packets in {duration:.0f} s of walking")
    for name, times in results.items():
        runs = ", ".join([f"{time:.2f}" for time in times])
        hour = 3600.0 / duration * times[-1]
        print(f"{name:26} runs {runs} s; an hour of two insoles: {hour:.0f} s, {hour / 36.0:.1f} % of a core")


if __name__ == "__main__":
    main()
