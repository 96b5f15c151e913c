#!/usr/bin/env python3
"""Prints the gain of compiled modules: `python .ci/compiled/gain.py FOLDER`, with the folder that build.py has made.

Processes with the pure and the compiled form take turns, three times; each value is the median processor time of five
runs in each of them, but that of the longest last frame of a stride, of which a process prints the least of five runs.
The yardstick is that of tests/bench."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
TURNS, RUNS = 3, 5


def measure() -> dict[str, list[float]]:
    """Return the microseconds of each run of the yardstick and of each row with the solepath that is imported."""
    sys.path.insert(0, str(ROOT / "tests" / "bench"))
    from measure import no_garbage_collection
    from yardstick import UsualFilter

    from bench import time_packets
    from solepath import Foot, Session, Site
    from solepath.emulate.radio import CLEAN
    from solepath.emulate.routes.route import Route
    from solepath.emulate.sensors.insoles import layout
    from solepath.emulate.sensors.parts import LSM6DSOX
    from solepath.emulate.walk import emulate
    from solepath.emulate.wearers.walker import Walker
    from solepath.link.decoder import Decoder

    route = Route().stand(2.0).walk(20.0, 1.3).stop(2.0)
    walker = Walker(route, seed=1)
    samples = walker.samples(Foot.LEFT, 100.0, LSM6DSOX)
    pressure_samples = walker.samples(Foot.LEFT, 100.0, LSM6DSOX, layout=layout(96, Foot.LEFT))
    walk = emulate(route, radio=CLEAN, seed=1).packets
    packets = [one for one in walk if one.site is Site.LEFT_FOOT]
    info = [one for one in packets if one.channel == "insole/info"]
    frames = [one for one in packets if one.channel == "insole/frame"]

    def times_of(items: list[Any], make: Any, before: list[Any]) -> list[float]:
        times = []
        for _ in range(RUNS):
            one = make()
            for item in before:
                one.feed(item)
            with no_garbage_collection():
                started_at = process_time()
                for item in items:
                    one.feed(item)
                times.append((process_time() - started_at) / len(items) * 1e6)
        return times

    return {
        "yardstick": times_of(samples, UsualFilter, []),
        "foot sample, inertial": times_of(samples, Session, []),
        "foot sample, 96 cells": times_of(pressure_samples, Session, info),
        "insole frame, 96 cells: decode": times_of(frames, lambda: Decoder(Site.LEFT_FOOT), info),
        "insole frame, 96 cells: session": times_of(frames, Session, info),
        "a stride's last frame, the longest": [time_packets(walk)[1][-1]],
    }


def main() -> None:
    """Run the command."""
    forms = {"pure": str(ROOT / "src"), "compiled": str(Path(sys.argv[1]).resolve())}
    found: dict[str, list[dict[str, list[float]]]] = {form: [] for form in forms}
    for _ in range(TURNS):
        for form, folder in forms.items():
            command = [sys.executable, __file__]
            done = subprocess.run(command, env={**os.environ, "PYTHONPATH": folder}, stdout=subprocess.PIPE, check=True)
            found[form].append(json.loads(done.stdout))
    usual = {
        form: {row: median(sum([one[row] for one in runs], [])) for row in runs[0]} for form, runs in found.items()
    }
    print(f"{'':34}{'pure':>10}{'compiled':>12}  ratio to yardstick: pure, compiled")
    for row in usual["pure"]:
        pure, compiled = (usual[form][row] for form in forms)
        shares = [usual[form][row] / usual[form]["yardstick"] for form in forms]
        print(f"{row:34}{pure:7.1f} us{compiled:9.1f} us{shares[0]:22.3f}{shares[1]:10.3f}")


if __name__ == "__main__":
    main() if sys.argv[1:] else print(json.dumps(measure()))
