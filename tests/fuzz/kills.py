"""Kills programs with `kill -9` at random moments, and reads what they left: `python tests/fuzz/kills.py record|live`.

    --count N       how often (default: 10)
    --workers N     how many at once (default: 3)
    --seed N        of the moments

An emulated wearer with two insoles walks in another program, over a true link that loses nothing. `record` must have
left a recording in which nothing is missing that came earlier than 200 ms before the kill: the numbers of the frames
are without a gap. `live` must have left such a recording too, and files of which each line but the last is whole: its
events, and the rows of its tables, are the first ones of those of the recording, in their order, with none left out. It
prints one line, and exits with 1 at the first promise that is broken. `solepath fleet-demo --kills N` does the same for
a fleet.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from time import monotonic, sleep, time
from typing import Any, NamedTuple

from solepath import FootMoved, GaitCycleMeasured, Packet, Session, Site, StrideTaken
from solepath.events import LiveEvent
from solepath.recording import read_header, read_packets
from solepath.recording.packets import read_start_time
from solepath.wire.insole import parse_frame

LONGEST_LOSS = 0.2
"""Age of packets that may be missing, s."""
LONGEST_START = 30.0
"""Time in which a program must have its first packets, s."""
LONGEST_WALK = {"record": 2.0, "live": 12.0}
"""Largest time from the first packets to a kill, s: strides come after 5 s, and their files are buffered."""
SEQUENCE_MODULUS = 1 << 16
"""Number after which those of the frames start with 0 again (protocol/insole.md)."""
TABLES: dict[str, tuple[type, dict[str, str]]] = {
    "track.csv": (FootMoved, {"t_s": "t", "foot": "foot"}),
    "strides.csv": (StrideTaken, {"foot": "foot", "t_start_s": "t_start", "t_end_s": "t_end"}),
    "gait_cycles.csv": (GaitCycleMeasured, {"foot": "foot", "number": "number", "t_start_s": "t_start"}),
}
"""Events of the rows of each table, and the fields of its columns that are compared."""
START_SHARE = 0.1
"""Share of the kills that come before the first packet."""


class Broken(AssertionError):
    """A promise that did not hold."""


class Found(NamedTuple):
    """What was found after a kill."""

    packets: int
    """Number of packets of the recording."""
    lines: int
    """Number of whole lines of other files."""
    age: float
    """Time from the newest packet to the kill, s; 0 without a stream of packets."""


@contextmanager
def emulator() -> Iterator[list[str]]:
    """Run emulated insoles; yield the options that reach them, with their addresses, so that nobody has to search."""
    command = [sys.executable, "-m", "solepath", "emulate", "--listen", "127.0.0.1:0", "--duration", "36000"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        assert process.stdout is not None
        served, left, right = [process.stdout.readline().split() for _ in range(3)]
        if not right:
            raise Broken("the emulator has not started")
        yield ["--via", served[-1], "--left", left[0], "--right", right[0]]
    finally:
        process.kill()
        process.wait()


def kill_one(kind: str, reach: list[str], folder: Path, random: Random) -> Found:
    """Start a program, kill it, and check its files."""
    recording, out = folder / "walk.jsonl", folder / "out"
    command = [sys.executable, "-m", "solepath", kind, *reach, "--duration", "600"]
    command += ["--out", str(recording)] if kind == "record" else ["--record", str(recording), "--out", str(out)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    try:
        started = monotonic()
        if random.random() < START_SHARE:
            sleep(random.uniform(0.0, 1.5))
        else:
            while not (recording.exists() and recording.stat().st_size > 2000):
                if process.poll() is not None or monotonic() - started > LONGEST_START:
                    raise Broken(f"{kind} has written nothing: {(process.stderr and process.stderr.read1()) or b''!r}")
                sleep(0.02)
            sleep(random.uniform(0.0, LONGEST_WALK[kind]))
        killed_at = time()
        os.kill(process.pid, signal.SIGKILL)
    finally:
        process.kill()
        process.wait()
    packets = read_recording(recording)
    check_numbers(packets)
    lines = check_files(out, packets) if out.exists() else 0
    age = age_of_newest(recording, packets, killed_at)
    if age > LONGEST_LOSS:
        raise Broken(f"the newest of {len(packets)} packets came {1000.0 * age:.0f} ms before the kill")
    return Found(len(packets), lines, age)


def read_recording(path: Path) -> list[Packet]:
    """Return the packets; a program that was killed at its start has left no file, or one without a whole header."""
    if not path.exists() or b"\n" not in path.read_bytes():
        return []
    return list(read_packets(path, report=_ignore))


def _ignore(sentence: str) -> None:
    """Ignore that the last line is cut off."""


def age_of_newest(path: Path, packets: list[Packet], killed_at: float) -> float:
    """Return how long before the kill the newest packet came, s; 0 before the insoles send a frame each 10 ms."""
    if not any(packet.channel == "insole/frame" for packet in packets):
        return 0.0
    moment = read_start_time(read_header(path))
    if moment is None or moment[1] is None:
        raise Broken("the recording does not say when it started")
    return killed_at - (moment[0].timestamp() + packets[-1].t - moment[1])


def check_numbers(packets: list[Packet]) -> None:
    """Check that no frame is missing between the first and the last of an insole."""
    newest: dict[Site, int] = {}
    for packet in packets:
        if packet.channel == "insole/frame":
            number, before = parse_frame(packet.data).sequence, newest.get(packet.site)
            if before is not None and number != (before + 1) % SEQUENCE_MODULUS:
                raise Broken(f"frame {number} of {packet.site.value} follows frame {before}")
            newest[packet.site] = number


def check_files(folder: Path, packets: list[Packet]) -> int:
    """Check that the files of `live` are those of its recording, as far as they were written; return their lines."""
    count = 0
    events = Session(poses=True).feed(packets)
    for path in folder.iterdir():
        lines = path.read_text("utf-8").split("\n")[:-1]
        count += len(lines)
        if path.suffix == ".jsonl":
            written: list[Any] = [json.loads(line) for line in lines]
            expected: Iterable[Any] = (event.to_dict() for event in events if not isinstance(event, LiveEvent))
        else:
            cls, columns = TABLES[path.name]
            written = [[row[column] for column in columns] for row in csv.DictReader(lines)]
            fields = [event.to_dict() for event in events if isinstance(event, cls)]
            expected = ([str(one[name]) for name in columns.values()] for one in fields)
            if len({line.count(",") for line in lines}) > 1:
                raise Broken(f"{path.name} has lines of different lengths")
        if written != list(islice(expected, len(written))):
            raise Broken(f"{path.name} does not have the first events that the recording gives")
    return count


def run_worker(kind: str, count: int, seed: int) -> list[Found]:
    """Kill a program `count` times beside one emulator."""
    random, results = Random(seed), []
    with emulator() as reach, TemporaryDirectory() as name:
        for number in range(count):
            folder = Path(name, str(number))
            folder.mkdir()
            results.append(kill_one(kind, reach, folder, random))
    return results


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("kind", choices=["record", "live"])
    options.add_argument("--count", type=int, default=10, metavar="N")
    options.add_argument("--workers", type=int, default=3, metavar="N")
    options.add_argument("--seed", type=int, default=0, metavar="N")
    chosen = options.parse_args()
    shares = [chosen.count // chosen.workers + (i < chosen.count % chosen.workers) for i in range(chosen.workers)]
    started = monotonic()
    with ThreadPoolExecutor(chosen.workers) as pool:
        futures = [
            pool.submit(run_worker, chosen.kind, share, chosen.seed + i) for i, share in enumerate(shares) if share
        ]
        try:
            results = [result for future in futures for result in future.result()]
        except Broken as error:
            print(f"{chosen.kind}: BROKEN: {error}")
            return 1
    walked = sorted([one.age for one in results if one.age > 0.0])
    print(
        f"{chosen.kind}: {len(results)} kills, {len(walked)} of them in a stream of packets;"
        f" {sum(one.packets for one in results):,} packets and {sum(one.lines for one in results):,} other lines read"
        f" back; the newest packet came {1000.0 * walked[len(walked) // 2]:.0f} ms before the kill (median),"
        f" at most {1000.0 * walked[-1]:.0f} ms; {monotonic() - started:.0f} s"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
