"""Feeds mutated input to sessions for as long as one likes: `python tests/fuzz/fuzz.py [--seconds S] [--seed N]`.

The relations of tests/contracts say the same of every kind of input, for seconds. Here packets of all devices come with
fields changed under a right checksum, samples with any number in any field, and states with a right checksum. Nothing
may raise what is not documented, all events must be finite and known no sooner than they happened, a state bounded, and
a restored session must continue as one that never stopped. It prints a line for each target; status 1 and the round
with which it comes again (`TARGET --seed N`): a promise was broken."""

from __future__ import annotations

import argparse
import json
import sys
import traceback
from collections.abc import Callable
from functools import cache
from itertools import count
from math import inf, isfinite, nan
from multiprocessing import Pool
from pathlib import Path
from random import Random
from time import monotonic
from typing import Any

HELPERS = Path(__file__).resolve().parents[1] / "helpers"
sys.path[:0] = [str(path) for path in (HELPERS, *HELPERS.iterdir()) if path.is_dir()]

import walks  # noqa: E402
from attrs import evolve, fields, has  # noqa: E402

from solepath import Sample, Session, Site, SnapshotError, recipes  # noqa: E402
from solepath.link.devices import cc2650, dot, orphe, thingy  # noqa: E402 - the fields of their frames
from solepath.saving.codec import checksum  # noqa: E402 - a state with a right checksum
from solepath.wire.fields import build_whole, parse_whole  # noqa: E402
from solepath.wire.insole import build_frame, parse_frame  # noqa: E402
from solepath.wire.insole_info import build_info, parse_info  # noqa: E402

NUMBERS = (nan, inf, -inf, 0.0, -0.0, 5e-324, 1.0, -1.0, 9.81, 1e3, 1e11, -1e11, 1e300, 10**400)
"""Numbers at which code may fail; the last one is too large for a float."""
ITEMS = 500
"""Number of packets or samples of a round."""
MUTATED_SHARE = 0.5
"""Share of them that are mutated; the others keep a walk going."""
MOST_PACKED = 150_000
"""Largest size of a packed session of two feet, bytes."""
FORMATS = {
    channel: (lambda data, of=form: parse_whole(of, data), lambda value, of=form: build_whole(of, value))
    for driver in (cc2650.DRIVER, dot.DRIVER, dot.ORIENTATION_DRIVER, orphe.DRIVER, thingy.DRIVER)
    for channel, form in driver.formats.items()
} | {"insole/frame": (parse_frame, build_frame), "insole/info": (parse_info, build_info)}
"""How the values of each channel are read and written."""
snapshots = cache(lambda: [one for machine in list(walks.machines().values())[:3] for one in _snapshots(machine)])


def _snapshots(machine: walks.Machine) -> list[Any]:
    session, found = machine.start(), []
    for number, item in enumerate(machine.items):
        session.feed(item)
        if number % (len(machine.items) // 3) == 7:
            found.append(machine.save(session))
    return found


def changed_bytes(data: bytes, random: Random) -> bytes:
    """Return the bytes with a bit, a byte or a piece changed, left out or repeated."""
    changed, at, size = bytearray(data), random.randrange(len(data) + 1), random.choice((1, 2, 4, 16))
    match random.randrange(4):
        case 0 if changed:
            changed[at - 1] ^= 1 << random.randrange(8)
        case 1:
            del changed[at : at + size]
        case 2:
            changed[at:at] = changed[at : at + size]
        case _:
            changed[at : at + size] = random.randbytes(size)
    return bytes(changed)


def changed_value(value: Any, random: Random) -> Any:
    """Return the value with a change somewhere in it: a number, a flag, an item, or a field of a record."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        border = 1 << random.choice((7, 8, 12, 15, 16, 24, 31, 32, 63))
        return random.choice((value + 1, value - 1, -value, 0, border, border - 1, -border))
    if isinstance(value, float):
        return random.choice(NUMBERS)
    if isinstance(value, bytes):
        return changed_bytes(value, random)
    if isinstance(value, list | tuple) and value:
        at = random.randrange(len(value))
        kept = [[], [changed_value(value[at], random)], [value[at]] * 2][random.choice((0, 1, 1, 1, 2))]
        return type(value)([*value[:at], *kept, *value[at + 1 :]])
    if isinstance(value, dict) and value:
        name = random.choice(list(value))
        return {**value, name: changed_value(value[name], random)}
    if has(type(value)):
        name = random.choice([one.name for one in fields(type(value)) if one.init])
        return evolve(value, **{name: changed_value(getattr(value, name), random)})
    return random.choice((None, "", value))


def changed_packet(packet: walks.Packet, random: Random) -> walks.Packet:
    """Return the packet with another field, under a right checksum where it has one, other bytes, site or time."""
    match random.randrange(8):
        case 0:
            return evolve(packet, site=random.choice(list(Site)))
        case 1:
            return evolve(packet, t=packet.t + random.choice((1e-9, -0.5, 20.0, 1e9, -1e4, nan, inf)))
        case 2 | 3:
            return evolve(packet, data=changed_bytes(packet.data, random))
    parse, build = FORMATS.get(packet.channel, (bytes, bytes))
    try:
        return evolve(packet, data=build(changed_value(parse(packet.data), random)))
    except (ValueError, TypeError, AttributeError, OverflowError, KeyError):  # the value does not fit its format
        return evolve(packet, data=changed_bytes(packet.data, random))


def changed_sample(sample: Sample, random: Random) -> Sample:
    """Return the sample with another value in a field."""
    name = random.choice(("t", "site", "acc", "gyro", "pressure", "quat", "mag", "air_pressure"))
    if name == "site":
        return evolve(sample, site=random.choice(list(Site)))
    value = getattr(sample, name) or (0.0, 1.0, 2.0)
    return evolve(sample, **{name: changed_value(value, random)})


def fed(items: tuple[Any, ...], change: Callable[[Any, Random], Any], random: Random) -> int:
    """Feed a session items of which some are changed; return the number of its events."""
    recipe = recipes.by_name(random.choice(("default", *recipes.NAMES)))
    session, twin, events = Session(recipe, poses=random.random() < 0.5), None, 0
    start = random.randrange(len(items))
    for number, item in enumerate(items[start : start + ITEMS]):
        changed = change(item, random) if random.random() < MUTATED_SHARE else item
        try:
            found = session.feed(changed)
        except TypeError:  # an answer to a sample of wrong types
            assert isinstance(changed, Sample)
            continue
        for event in found:
            assert isfinite(event.t) and event.t <= event.known_at < inf, event
            json.dumps(event.to_dict(), allow_nan=False)
        assert twin is None or twin.feed(changed) == found, "a restored session gives other events"
        events += len(found)
        if number % 200 == 100:
            twin = Session.unpack(session.pack(), recipe)
        elif number % 200 == 140:
            assert twin is None or twin.pack() == session.pack(), "a restored session has another state"
            twin = None
    assert len(session.pack()) < MOST_PACKED
    return events + len(session.finish())


def notifications(random: Random) -> int:
    return fed(random.choice(list(walks.packets().values())), changed_packet, random)


def samples(random: Random) -> int:
    return fed(random.choice((walks.samples(cells=0), walks.samples(), walks.suited())), changed_sample, random)


def states(random: Random) -> int:
    """Restore a changed state; return whether it was one."""
    snapshot = random.choice(snapshots())
    state = changed_value(snapshot["state"], random)
    try:
        check = checksum(state)
    except (ValueError, TypeError):
        check = 0
    try:
        Session.restore({**snapshot, "state": state, "check": check})
    except SnapshotError as error:
        assert len(str(error).splitlines()) == 1, error
        return 0
    return 1


TARGETS = {one.__name__: one for one in (notifications, samples, states)}


def run(chosen: tuple[str, int, float]) -> tuple[str, bool]:
    """Run rounds of a target until the time is over; return the line for it, and whether all promises held."""
    target, seed, seconds = chosen
    end, found = inf, 0
    for round_ in count(seed):
        try:
            found += TARGETS[target](Random(round_))
        except Exception:
            return f"python tests/fuzz/fuzz.py {target} --seed {round_}\n{traceback.format_exc()}", False
        end = min(end, monotonic() + seconds)  # from the first round on, which emulates the walks
        if monotonic() > end:
            return f"{target}: {round_ - seed + 1:,} rounds, {found:,} events or states: all promises held", True
    raise AssertionError


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("targets", metavar="TARGET", nargs="*", help=f"{', '.join(TARGETS)} (default: all)")
    options.add_argument("--seconds", type=float, default=6.0, metavar="S", help="for each target")
    options.add_argument("--seed", type=int, default=0, metavar="N")
    chosen = options.parse_args()
    with Pool() as pool:
        jobs = [(target, chosen.seed, chosen.seconds) for target in chosen.targets or TARGETS]
        lines = list(pool.imap(run, jobs))
    print("\n".join(line for line, _ in lines))
    return 0 if all(held for _, held in lines) else 1


if __name__ == "__main__":
    sys.exit(main())
