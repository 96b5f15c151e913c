"""Makes the inputs of the golden corpus that are missing: `python tests/golden/make_inputs.py`.

They are made once and kept, because another numpy, or a change of the emulator, would make others."""

from __future__ import annotations

import json
import lzma
from collections.abc import Callable, Iterable
from math import pi, radians
from typing import Any

import declared
from attrs import evolve
from corpus import FOLDER
from plan_files import format_floorplan

from solepath import Foot, Packet, Sample, Site
from solepath.emulate import CC2541, CC2650, Insole, Route, Walker, emulate, sampled
from solepath.emulate.radio import Radio
from solepath.emulate.routes.building import FOUR_LOOPS
from solepath.emulate.routes.ways import wandering
from solepath.emulate.sensors.dot import Dot
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import AK8963, LSM6DSOX
from solepath_lab.emulated.limb_samples import limb_samples
from solepath_lab.emulated.magnetic_field import DisturbedField

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
ROUGH = Radio(loss=0.03, duplicate=0.01, corrupt=0.01, truncate=0.01, latency=0.01, jitter=0.04)
"""A poor radio connection: lost, repeated, damaged and late packets."""
DAY = (
    Route().stand(2.5).walk(8.0, 1.3).turn(radians(90), radius=4.0).turn(radians(-90), radius=2.0).walk(4.0)
    .stairs(10).walk(3.0).lift(-3.2).walk(4.0).turn(pi).stop(2.0).jog(14.0).stairs(8, up=False).walk(3.0)
    .turn(radians(-90), radius=4.0).turn(radians(90), radius=2.0).turn(radians(90)).walk(5.0, 0.8).shuffle(1.0)
    .escalator(2.0).walk(4.0, 1.5).stop(2.0)
)  # fmt: skip
"""Everything that a wearer does, in about two minutes."""
STROLL = Route().stand(2.0).walk(9.0, 1.3).turn(pi, radius=2.5).walk(9.0, 1.1).turn(radians(-90)).walk(3.0).stop(2.0)
"""A walk of about half a minute, which cases damage."""
DIGITS = {"acc": 3, "gyro": 4, "quat": 5, "mag": 9, "pressure": 1, "air_pressure": 1, "t": 6, "known_at": 6}
"""Decimals that are kept of a sample, beyond the noise of its sensor."""


def both(walker: Walker, rate: float, cells: int = 0) -> list[Sample]:
    """Return the samples of both feet, in the order of time."""
    samples = [
        sample
        for foot in Foot
        for sample in walker.samples(foot, rate, LSM6DSOX, layout=layout(cells, foot) if cells else None)
    ]
    return sorted(samples, key=lambda sample: sample.t)


def packets(device: Any, route: Route = DAY, radio: Radio = ROUGH, **more: Any) -> tuple[Packet, ...]:
    """Return the packets of a device on each foot."""
    return emulate(route, devices={LEFT: device, RIGHT: evolve(device)}, radio=radio, seed=11, **more).packets


def compass() -> Iterable[Sample]:
    """Return a walk over arcs with a magnetometer in both insoles."""
    route = Route(speed=1.3).stand(2.0).walk(3.0)
    for angle in (pi, -1.5 * pi, 1.2 * pi):
        route = route.turn(angle, 10.0)
    insoles = {site: Insole(cells=8, rate=50.0, mag=AK8963) for site in (LEFT, RIGHT)}
    return sampled(route.stop(2.0), insoles=insoles, field=DisturbedField(radians(20.0), seed=4), seed=3).samples


def there_and_back() -> Iterable[Sample]:
    """Return a heading walk: a corridor six times, with turns to both sides."""
    route = Route(speed=1.3).stand(2.0)
    for k in range(6):
        route = route.walk(9.0).turn(pi if k % 2 else -pi, radius=0.6)
    return both(Walker(route.stop(2.0), seed=9), 50.0)


def lifts() -> Iterable[Packet]:
    """Return lift rides and flights with a SensorTag, which has a barometer, on each foot."""
    route = (
        Route()
        .stand(2.0)
        .walk(4.0, 1.2)
        .lift(3.5)
        .walk(4.0)
        .stairs(12)
        .walk(3.0)
        .stairs(12, up=False)
        .walk(2.0)
        .lift(-7.0)
    )
    return packets(CC2650(), route.walk(3.0).stop(2.0))


def suit() -> Iterable[Sample]:
    """Return a walk round bends with seven sensors and insoles of 24 cells."""
    route = Route().stand(1.5).walk(3.0, 1.2)
    for angle, radius in ((150, 4.0), (-150, 2.0), (90, 2.0), (-90, 4.0)):
        route = route.turn(radians(angle), radius=radius).walk(2.0)
    layouts = {LEFT: layout(24, Foot.LEFT), RIGHT: layout(24, Foot.RIGHT)}
    return limb_samples(Walker(route.stop(2.0), seed=3), 25.0, layouts=layouts)


def building(seed: int) -> Iterable[Sample]:
    """Return a walk through the emulated building (routes/ways.py)."""
    return both(Walker(wandering(seed).route, seed=seed), 50.0)


INPUTS: dict[str, Callable[[], Iterable[Packet | Sample]]] = {
    "insole": lambda: packets(Insole(cells=16, rate=50.0)),
    "insole-fragments": lambda: packets(Insole(cells=24, rate=50.0, mtu=23), STROLL),
    "insole-batches": lambda: packets(Insole(cells=8, batch=4, quaternion=True), STROLL),
    "insole-cells-alone": lambda: packets(Insole(cells=20, rate=50.0, imu=False), STROLL),
    "cc2650": lambda: packets(CC2650(presses=(2.0,))),
    "cc2541": lambda: packets(CC2541(rate=20.0, presses=(2.0,))),
    "cc2541-10hz": lambda: packets(CC2541(), STROLL),
    "dot-orientation": lambda: emulate(
        STROLL,
        devices={LEFT: Insole(cells=8, rate=50.0), RIGHT: Insole(cells=8, rate=50.0), Site.PELVIS: Dot()},
        radio=ROUGH,
        seed=11,
    ).packets,
    **{
        worn.driver.name: lambda worn=worn: declared.walked(worn, STROLL, ROUGH)
        for worn in (declared.ORPHE, declared.DOT, declared.THINGY)
    },
    "stroll": lambda: both(Walker(STROLL, seed=5), 100.0, cells=12),
    "running": lambda: both(
        Walker(Route().stand(2.0).walk(6.0, 1.3).jog(25.0).walk(4.0).stairs(10).walk(4.0).stop(2.0), seed=6), 100.0
    ),
    "compass": compass,
    "there-and-back": there_and_back,
    "suit": suit,
    "lifts": lifts,
    **{f"building-{seed}": lambda seed=seed: building(seed) for seed in (3, 8, 12)},
}  # fmt: skip


def as_line(item: Packet | Sample) -> str:
    """Return an item as a line of an input."""
    if isinstance(item, Packet):
        return json.dumps(
            {"t": round(item.t, 6), "site": item.site.value, "channel": item.channel, "data": item.data.hex()}
        )
    values: dict[str, Any] = {}
    for name in ("t", "acc", "gyro", "pressure", "quat", "mag", "air_pressure", "known_at"):
        value = getattr(item, name)
        if value is None or (name == "known_at" and value == item.t):
            continue
        digits = DIGITS[name]
        values[name] = round(value, digits) if isinstance(value, float) else [round(one, digits) for one in value]
    return json.dumps({"site": item.site.value, **values, **({"saturated": True} if item.saturated else {})})


def main() -> None:
    (FOLDER / "inputs").mkdir(exist_ok=True)
    for name, make in INPUTS.items():
        path = FOLDER / "inputs" / f"{name}.jsonl.xz"
        if not path.exists():
            lines = [as_line(item) for item in make()]
            path.write_bytes(lzma.compress("\n".join(lines).encode(), preset=9))
            print(f"{name}: {len(lines)} items, {path.stat().st_size} bytes", flush=True)
    plan = FOLDER / "inputs" / "building.geojson.xz"
    if not plan.exists():
        plan.write_bytes(lzma.compress(format_floorplan(FOUR_LOOPS.plan).encode(), preset=9))


if __name__ == "__main__":
    main()
