"""Feeds mutated input to everything that takes input from outside: `python tests/fuzz/fuzz.py [TARGET ...]`.

    --seconds S     how long each target is fed (default: 6, half a minute for all five)
    --count N       instead, how many mutated inputs each target gets
    --seed N        the first round; a failure names the round with which it comes again

Targets: notifications (packets of all devices, with fields changed under a right checksum), samples, files, states and
messages (of a page). It checks that nothing raises an exception that is not documented, that events are finite and
states bounded, that a rejected input changes nothing (a rejected fragment only the frame that it belongs to), that a
restored session continues as one that never stopped, that what was final comes once and is not revised, and that a
process does not grow from round to round (memory.py). It prints a line for each target, and exits with 1 if a promise
was broken. Memory is limited to 2 GB for each process, and a round to two minutes.
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
import sys
import traceback
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from importlib import import_module
from itertools import count
from pathlib import Path
from time import monotonic

from memory import MOST_GROWTH_OF_FILES, Memory

HELPERS = Path(__file__).resolve().parents[1] / "helpers"
sys.path[:0] = [str(path) for path in (HELPERS, *HELPERS.iterdir()) if path.is_dir()]

TARGETS = {"notifications": "", "samples": "", "files": "read to the end", "states": "restored", "messages": "commands"}
"""Targets, and what the second number of a round counts; "" for events."""
MEMORY = 2 << 30
"""Most memory of a process, bytes: a reader that fills it raises MemoryError, which is a failure."""
LONGEST_ROUND = 120
"""Time after which a round hangs, s; the longest take one."""
memories = {target: Memory() for target in TARGETS} | {"files": Memory(MOST_GROWTH_OF_FILES)}
"""Memory of this process, by the target of its rounds."""


def limit_process() -> None:
    """Limit the memory of a process, so that input cannot fill that of the machine, and the time of a round."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGALRM, _raise_hang)


def _raise_hang(number: int, frame: object) -> None:
    raise TimeoutError(f"a round of more than {LONGEST_ROUND} s")


def run_round(target: str, seed: int) -> tuple[int, int, str]:
    """Return the number of mutated inputs of a round, its second number, and the text of what was broken or ""."""
    signal.alarm(LONGEST_ROUND)
    try:
        inputs, second = import_module(target).run(seed)
        memories[target].check_growth()
        return inputs, second, ""
    except Exception:
        return 0, 0, f"python tests/fuzz/fuzz.py {target} --seed {seed} --count 1\n{traceback.format_exc()}"
    finally:
        signal.alarm(0)


def run_target(pool: ProcessPoolExecutor, target: str, seed: int, seconds: float, most: int | None) -> bool:
    """Run rounds of a target until the time is over or the number reached; return whether all promises held."""
    started, inputs, second, rounds = monotonic(), 0, 0, 0
    pending = []
    seeds: Iterator[int] = count(seed)
    broken = ""
    while not broken:
        while len(pending) < 4 and (inputs < most if most is not None else monotonic() - started < seconds):
            pending.append(pool.submit(run_round, target, next(seeds)))
        if not pending:
            break
        got, got_second, broken = pending.pop(0).result()
        inputs, second, rounds = inputs + got, second + got_second, rounds + 1
    for future in pending:
        future.cancel()
    print(
        f"{target}: {inputs:,} mutated in {rounds:,} rounds, {second:,} {TARGETS[target] or 'events'},"
        f" {monotonic() - started:.0f} s: {'BROKEN' if broken else 'all promises held'}",
        flush=True,
    )
    if broken:
        print(broken)
    return not broken


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("targets", metavar="TARGET", nargs="*", choices=[*TARGETS, []], help="of those above; all")
    options.add_argument("--seconds", type=float, default=6.0, metavar="S")
    options.add_argument("--count", type=int, metavar="N")
    options.add_argument("--seed", type=int, default=0, metavar="N")
    chosen = options.parse_args()
    with ProcessPoolExecutor(os.cpu_count(), initializer=limit_process) as pool:
        held = [
            run_target(pool, target, chosen.seed, chosen.seconds, chosen.count) for target in chosen.targets or TARGETS
        ]
    return 0 if all(held) else 1


if __name__ == "__main__":
    sys.exit(main())
