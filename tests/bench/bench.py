"""Measures processing times: `python tests/bench/bench.py`. Prints a table; asserts nothing.

Times are processor times, medians of five runs, with the garbage collector off, as in timeit. The last column
is the time as a multiple of that of the yardstick (yardstick.py), which depends less on the machine.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from functools import partial
from statistics import median
from time import process_time
from typing import Any

from measure import RUNS, machine, measure_memory, no_garbage_collection, seconds
from yardstick import UsualFilter

from solepath import Calibration, Foot, Packet, Recipe, Sample, Session, Site, StrideTaken, recipes
from solepath.calibration import InsoleCalibration
from solepath.cli.main import form
from solepath.emulate.radio import CLEAN
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.emulate.wearers.walker import Walker
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.stance.cycle import Cycle
from solepath.link.decoder import Decoder
from solepath.types import SITE_OF_FOOT
from solepath_lab.emulated.limb_samples import limb_samples

ROUTE = Route().stand(2.0).walk(50.0, 1.3).stop(2.0)
"""A walk of about 43 s; the feet stand still for 10 % of it."""
USUAL_YARDSTICK = 200.0
"""Time of the yardstick on a usual machine, us: what another machine can carry is compared at this."""


def time_each(items: list[Any], make: Callable[[], Any], prepare: Iterable[Any] = ()) -> float:
    """Return the microseconds for which a new object processes an item, after it was fed `prepare` unmeasured."""
    times = []
    for _ in range(RUNS):
        one = make()
        for item in prepare:
            one.feed(item)
        feed = one.feed
        with no_garbage_collection():
            started_at = process_time()
            for item in items:
                feed(item)
            times.append((process_time() - started_at) / len(items) * 1e6)
    return median(times)


def feed_session(items: Iterable[Any]) -> Session:
    """Return a session that has processed these items."""
    session = Session()
    for item in items:
        session.feed(item)
    return session


def time_packets(packets: Iterable[Packet]) -> tuple[list[float], list[float]]:
    """Return the microseconds of each packet, and of those that end a stride, in order of length; the least of RUNS."""
    runs: list[list[float]] = []
    ends: list[bool] = []
    for _ in range(RUNS):
        session, times, ends = Session(), [], []
        with no_garbage_collection():
            for packet in packets:
                started_at = process_time()
                events = session.feed(packet)
                times.append((process_time() - started_at) * 1e6)
                ends.append(any([isinstance(event, StrideTaken) for event in events]))
        runs.append(times)
    least = [min(times) for times in zip(*runs, strict=True)]
    return sorted(least), sorted([time for time, is_end in zip(least, ends, strict=True) if is_end])


def decode(packets: Iterable[Packet]) -> list[Sample]:
    """Return the samples of the packets of several sites."""
    decoders = {site: Decoder(site) for site in Site}
    items = [item for packet in packets for item in decoders[packet.site].feed(packet)]
    return [item for item in items if isinstance(item, Sample)]


def session_with_layout(recipe: Recipe, infos: list[Packet]) -> Session:
    """Return a session that has received the positions of the cells."""
    session = Session(recipe)
    session.feed(infos)
    return session


def _time_of(sample: Sample) -> float:
    return sample.t


def main() -> None:
    walker = Walker(ROUTE, seed=1)
    inertial_samples: list[Sample] = walker.samples(Foot.LEFT, 100.0, LSM6DSOX)
    pressure_samples: list[Sample] = walker.samples(Foot.LEFT, 100.0, LSM6DSOX, layout=layout(96, Foot.LEFT))
    walk = emulate(ROUTE, radio=CLEAN, seed=1)
    left = [packet for packet in walk.packets if packet.site is Site.LEFT_FOOT]
    info = [packet for packet in left if packet.channel != "insole/frame"]
    frames = [packet for packet in left if packet.channel == "insole/frame"]
    (info_packet,) = [packet for packet in info if packet.channel == "insole/info"]
    small = Insole(cells=24, mtu=23)
    fragments = list(emulate(ROUTE, devices={Site.LEFT_FOOT: small}, seed=1).packets)
    linear = Recipe("linear", Cycle(), LinearDedrift())

    samples_200_hz: list[Sample] = walker.samples(Foot.LEFT, 200.0, LSM6DSOX)

    yardstick_time = time_each(inertial_samples, UsualFilter)
    rows: list[tuple[str, float, str]] = []

    def add(what: str, microseconds: float, unit: str = "us a sample") -> None:
        rows.append((what, microseconds, unit))

    def decoder() -> Decoder:
        return Decoder(Site.LEFT_FOOT)

    def session_with_cells(**options: bool) -> Session:
        session = Session(**options)
        session.feed(info_packet)
        return session

    add("yardstick: numpy, nine states, SHOE, the usual way", yardstick_time)
    add("foot sample, inertial", time_each(inertial_samples, Session))
    add("foot sample, inertial at 200 Hz", time_each(samples_200_hz, Session))
    add("foot sample, inertial, FootMoved", time_each(inertial_samples, lambda: Session(poses=True)))
    add("foot sample, 96 cells", time_each(pressure_samples, session_with_cells))
    add("foot sample, 96 cells, FootMoved", time_each(pressure_samples, partial(session_with_cells, poses=True)))
    add(
        "foot sample, 96 cells, FootMoved and FootPressed",
        time_each(pressure_samples, partial(session_with_cells, poses=True, pressures=True)),
    )
    add("foot sample, inertial, linear dedrift", time_each(inertial_samples, lambda: Session(linear)))
    infos = [packet for packet in walk.packets if packet.channel == "insole/info"]
    two_feet = walker.samples(Foot.RIGHT, 100.0, LSM6DSOX, layout=layout(96, Foot.RIGHT)) + pressure_samples
    two_feet.sort(key=_time_of)
    for recipe in map(recipes.by_name, recipes.NAMES):
        add(f"both feet, 96 cells, {recipe.name}", time_each(two_feet, partial(session_with_layout, recipe, infos)))
    papers = {name: recipes.by_name(name) for name in ("footstep-tracker", "shoe-sensing")}
    for name, recipe in papers.items():
        add(f"foot sample, inertial, {name}", time_each(inertial_samples, partial(Session, recipe)))
    tags = {site: CC2541(rate=20.0, mounting=IN_SOLE) for site in SITE_OF_FOOT.values()}
    tag_samples = decode(emulate(ROUTE, devices=tags, seed=1).packets)
    add("CC2541 at 20 Hz, footstep-tracker", time_each(tag_samples, partial(Session, papers["footstep-tracker"])))
    layouts = {site: layout(99, foot) for foot, site in SITE_OF_FOOT.items()}
    suit = limb_samples(walker, 50.0, seed=1, layouts=layouts)
    insoles = sum(sample.pressure is not None for sample in suit)
    layout_calibration = Calibration(insoles={foot: InsoleCalibration(layout(99, foot)) for foot in Foot})
    microseconds = time_each(suit, partial(Session, recipes.by_name("walking-modes"), calibration=layout_calibration))
    add("both feet, 99 cells, five limbs, walking-modes", microseconds * len(suit) / insoles, "us an insole sample")
    add("insole frame, 96 cells: decode", time_each(frames, decoder, info), "us a packet")
    add("insole frame, 96 cells: session", time_each(frames, Session, info), "us a packet")
    add(
        "insole frame, 96 cells: session, FootMoved",
        time_each(frames, lambda: Session(poses=True), info),
        "us a packet",
    )
    add("insole fragment of 20 bytes: session", time_each(fragments, Session), "us a packet")
    packet_times, last_frames = time_packets(walk.packets)
    add("a stride's last frame, both feet: median", median(last_frames), "us a packet")
    add("a stride's last frame, both feet: p99", last_frames[int(0.99 * len(last_frames))], "us a packet")
    add("any packet of both feet: p99", packet_times[int(0.99 * len(packet_times))], "us a packet")
    add("any packet of both feet: longest", packet_times[-1], "us a packet")

    duration = walk.packets[-1].t
    real_time = duration / seconds(lambda: feed_session(walk.packets))

    session = Session()
    strides = sum(isinstance(event, StrideTaken) for event in session.feed(walk.packets))
    saved = session.snapshot()
    text = json.dumps(saved)
    save, load = seconds(session.snapshot), seconds(lambda: Session.restore(saved))

    print(f"{machine()}, one used; {form()} modules; medians of {RUNS}")
    counts = f"{len(inertial_samples)} samples, {len(frames)} frames, {strides} strides of both feet"
    print(f"{counts} in {duration:.0f} s of walking")
    print()
    width = max(len(what) for what, _, _ in rows)
    print(f"{'':{width}}  {'time':>8} {'':<19} {'of the yardstick':>16}")
    for what, value, unit in rows:
        print(f"{what:{width}}  {value:8.1f} {unit:<19} {value / yardstick_time:16.2f}")
    print()
    print(f"real-time factor, both feet with 96 cells at 100 Hz: {real_time:.0f}")
    print(f"an hour of two insoles with 96 cells at 100 Hz: {3600.0 / real_time:.0f} s of processor time")
    wearers = real_time * yardstick_time / USUAL_YARDSTICK
    print(f"live wearers per core, if the yardstick takes {USUAL_YARDSTICK:.0f} us: {wearers:.0f}")
    print(f"snapshot {save * 1e3:.1f} ms, restore {load * 1e3:.1f} ms, {len(text) / 1000:.1f} kB as JSON")
    memory = measure_memory(lambda: feed_session(inertial_samples))
    print(f"memory of a session: {memory / 1000:.0f} kB one foot, inertial; ", end="")
    print(f"{measure_memory(lambda: feed_session(walk.packets)) / 1000:.0f} kB both feet with 96 cells and links")


if __name__ == "__main__":
    main()
