"""Walks that tests share, and Machine, a common interface to sessions and decoders."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterable, Iterator
from functools import cache, partial
from math import radians
from typing import Any

import declared
import numpy as np
from attrs import evolve, frozen
from kept import kept
from soak import soaked

from solepath import recipes
from solepath.emulate.radio import CLEAN, Radio
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX, Imu
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.emulate.wearers.walker import Walker
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Start
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.stance.cycle import Cycle
from solepath.foot.stance.shoe import ShoeDetector
from solepath.link.decoder import Decoder
from solepath.papers.kupt_dfpc.known_velocity import KnownVelocity
from solepath.recipes import DEFAULT, Recipe
from solepath.saving import codec
from solepath.session import Session
from solepath.types import Foot, Packet, Sample, Site
from solepath_lab.emulated.limb_samples import limb_samples

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
ROUGH = Radio(loss=0.05, duplicate=0.02, corrupt=0.02, truncate=0.02, latency=0.01, jitter=0.04)
"""A poor radio connection that a session must tolerate: lost, repeated, damaged and late packets."""
SHORT = Route().stand(1.5).walk(3.0, 1.3).turn(radians(60), radius=1.5).walk(1.2).stop(0.8)
"""A walk of about 7 s, three or four strides of each foot."""

Item = Packet | Sample


@cache
def insoles(
    route: Route = SHORT, radio: Radio = CLEAN, seed: int = 1, cells: int = 24, rate: float = 50.0
) -> EmulatedWalk:
    """Return a walk with an insole in each shoe."""
    devices = {site: Insole(cells=cells, rate=rate) for site in (LEFT, RIGHT)}
    return emulate(route, devices=devices, radio=radio, seed=seed)


@kept
def samples(route: Route = SHORT, cells: int = 24, rate: float = 50.0, seed: int = 1) -> tuple[Sample, ...]:
    """Return the samples of both feet in the order of time, with the errors of an LSM6DSOX; without a radio."""
    return both_feet(Walker(route, seed=seed), rate, LSM6DSOX, cells)


def both_feet(walker: Walker, rate: float, part: Imu, cells: int = 0, **more: Any) -> tuple[Sample, ...]:
    """Return the samples of two sensors of a walker, in the order of time."""
    both_samples = [
        sample
        for foot in Foot
        for sample in walker.samples(foot, rate, part, layout=layout(cells, foot) if cells else None, **more)
    ]
    return tuple(sorted(both_samples, key=_time))


def _time(sample: Sample) -> float:
    return sample.t


def columns_of(walker: Walker, foot: Foot) -> dict[str, np.ndarray]:
    """Return exact samples of a foot at 100 Hz as the columns of a file of samples."""
    foot_samples = walker.samples(foot, 100.0)
    return {key: np.array([getattr(s, key) for s in foot_samples]) for key in ("t", "acc", "gyro")}


def each_by_itself(session: Any) -> Any:
    """Return a new session, which then tells each gap and each rejection by itself, as `Session(losses=True)` does."""
    session._state.settings = evolve(session._state.settings, losses=True)
    return session


def run_session(items: Iterable[Item], recipe: Recipe = DEFAULT, **given: Any) -> list[Any]:
    """Return all events of a session for these items, with those at the end."""
    session = Session(recipe, **given)
    return session.feed(items) + session.finish()


@frozen
class Machine:
    """A session or decoder that tests feed, save and restore; `items` are the input, in order."""

    name: str
    items: tuple[Item, ...]
    start: Callable[[], Any]
    load: Callable[[Any], Any]

    def save(self, machine: Any) -> Any:
        """Return the snapshot of a session or decoder, after a round trip through strict JSON."""
        value = machine.snapshot() if isinstance(machine, Session) else codec.save(machine)
        return json.loads(json.dumps(value, allow_nan=False))

    def repacked(self, session: Any) -> Any:
        """Return a session after a round trip through its packed form; a decoder unchanged."""
        return (
            Session.unpack(session.pack(), session.recipe, floorplan=session._plan)
            if isinstance(session, Session)
            else session
        )

    def events(self, items: tuple[Item, ...] | None = None) -> list[Any]:
        """Return all events of feeding one item at a time and finishing."""
        if items is None:
            return [event for events in machine_events(self.name) for event in events]
        machine = self.start()
        events = [event for item in items for event in machine.feed(item)]
        return events + machine.finish()


def _session(name: str, items: tuple[Item, ...], recipe: Recipe = DEFAULT) -> Machine:
    pressures = name in ("fragments", "samples with pressure")  # in a few sessions only, since it makes most events

    def start() -> Session:
        return Session(recipe, poses=True, pressures=pressures)

    return Machine(f"session, {name}", items, start, Session.restore)


@cache
def indexed_building() -> IndexedPlan:
    return IndexedPlan(BUILDING)


def _placed(name: str, items: tuple[Item, ...], recipe: Recipe) -> Machine:
    """Return a session in a building with a known start without a heading."""
    building = indexed_building()
    first_place = Start("0", (9.0, 12.0))

    def start() -> Session:
        return Session(recipe, poses=True, floorplan=building, start=first_place)

    return Machine(f"session, {name}", items, start, partial(Session.restore, floorplan=building))


def _decoder(name: str, items: tuple[Packet, ...]) -> Machine:
    def start() -> Decoder:
        return Decoder(LEFT)

    def load(saved: Any) -> Decoder:
        return codec.load(Decoder, saved, recipes.part_class)

    return Machine(f"decoder, {name}", tuple(item for item in items if item.site is LEFT), start, load)


@kept
def packets() -> dict[str, tuple[Packet, ...]]:
    """Return the packets of both feet over a poor radio connection, by the name of their device."""
    devices = {
        "whole frames": Insole(),
        "fragments": Insole(cells=24, rate=50.0, mtu=23),
        "four samples a frame": Insole(cells=35, batch=4, quaternion=True),
        "pressure alone": Insole(cells=99, rate=50.0, imu=False),
        "few frames": Insole(cells=24, rate=50.0),
        "cc2650": CC2650(presses=(2.0,)),
        "cc2541": CC2541(presses=(2.0,)),
        "cc2541 at 20 Hz": CC2541(rate=20.0),
    }
    by_device = {
        name: emulate(SHORT, devices={LEFT: device, RIGHT: evolve(device)}, radio=ROUGH, seed=7).packets
        for name, device in devices.items()
    }
    return by_device | {worn.driver.name: declared.walked(worn, SHORT, ROUGH) for worn in declared.EVERY}


@cache
def machines() -> dict[str, Machine]:
    """Return every machine by name."""
    plain, pressed = samples(cells=0, rate=50.0), samples(rate=50.0)
    all_machines = [_session(name, items) for name, items in packets().items()]
    all_machines += [_decoder(name, items) for name, items in packets().items()]
    all_machines += [_session("samples", samples(cells=0)), _session("samples with pressure", samples())]
    all_machines.append(_session("ShoeDetector", plain, Recipe("shoe", ShoeDetector(), ErrorStateFilter())))
    all_machines.append(_session("LinearDedrift", plain, Recipe("LinearDedrift", Cycle(), LinearDedrift())))
    all_machines.append(
        _session("LinearDedrift with pressure", pressed, Recipe("pressed", KnownVelocity(), LinearDedrift()))
    )
    for name in RECIPES:
        all_machines.append(_session(name, packets()["few frames"], recipes.by_name(name)))
    all_machines.append(_session("seven sites", suited(), recipes.by_name("walking-modes")))
    all_machines.append(_placed("particles", plain, DEFAULT))
    all_machines.append(_placed("Snake game", plain, recipes.by_name("footstep-tracker-printed")))
    return {machine.name: machine for machine in all_machines}


@frozen
class MachineRun:
    """The result of a machine that was fed its items one by one and then finished."""

    events: tuple[tuple[Any, ...], ...]
    """Events after each item, and at the end."""
    fed: Any
    """Snapshot after the last item."""
    ended: Any
    """Snapshot after the end."""


@kept
def run_machine(name: str) -> MachineRun:
    """Return the result, computed once for all tests that compare with it."""
    machine = machines()[name]
    instance = machine.start()
    events = [tuple(instance.feed(item)) for item in machine.items]
    fed = machine.save(instance)
    events.append(tuple(instance.finish()))
    return MachineRun(tuple(events), fed, machine.save(instance))


def machine_events(name: str) -> tuple[tuple[Any, ...], ...]:
    """Return a machine's events after each of its items, and at the end."""
    return run_machine(name).events


RECIPES = (
    "kupt-dfpc",
    "kupt-dfpc-printed",
    "zupt",
    "pressure-contour",
    "pressure-contour-printed",
    "gyroscope",
    "walking-modes",
    "touchdown-acceleration",
    "footstep-tracker",
    "footstep-tracker-printed",
    "shoe-sensing",
    "shoe-sensing-printed",
)
"""Recipes with a part that no other recipe has."""


@kept
def suited() -> tuple[Sample, ...]:
    """Return samples of pelvis, thighs, shanks and both feet, with insoles of 99 cells, in the order of time."""
    route = Route().stand(1.5).walk(3.0, 1.3).turn(radians(60), radius=1.5).walk(2.0).stop(1.0)
    layouts = {LEFT: layout(99, Foot.LEFT), RIGHT: layout(99, Foot.RIGHT)}
    return tuple(limb_samples(Walker(route, seed=3), 25.0, layouts=layouts))


_STREAMS = (
    "whole frames",
    "fragments",
    "four samples a frame",
    "pressure alone",
    "cc2650",
    "cc2541",
    "cc2541 at 20 Hz",
    "orphe",
    "dot",
    "thingy",
)
DEVICES = ("few frames", *_STREAMS)
"""Names of `packets`, known without an emulation."""
DEVICE_NAMES = tuple(f"session, {device}" for device in _STREAMS)
PACKET_NAMES = (
    *(f"{kind}, {device}" for kind in ("session", "decoder") for device in _STREAMS),
    *(f"session, {recipe}" for recipe in RECIPES),
)
SAMPLE_NAMES = tuple(
    f"session, {name}"
    for name in (
        "samples",
        "samples with pressure",
        "ShoeDetector",
        "LinearDedrift",
        "LinearDedrift with pressure",
        "seven sites",
        "particles",
        "Snake game",
    )
)
NAMES = PACKET_NAMES + SAMPLE_NAMES
"""Names of `machines`, known without an emulation, since collecting tests must not emulate walks."""
SELDOM = {
    "kupt",
    "kupt-dfpc-printed",
    "zupt",
    "pressure-contour-printed",
    "gyroscope",
    "walking-modes-printed",
    "touchdown-height",
    "touchdown-acceleration",
    "touchdown-pressure",
    "footstep-tracker-printed",
    "shoe-sensing-printed",
    "cc2541 at 20 Hz",
    "LinearDedrift with pressure",
}
"""Recipes, devices and detectors that share all but a part or a setting with another one."""


def often(names: Iterable[str], few: Collection[str] = ()) -> list[Any]:
    """Return the names as parameters of a test, of which those of SELDOM, or all but `few`, are for the soak alone."""

    def is_often(kind: str) -> bool:
        return kind in few if few else kind not in SELDOM

    return [one for name in names for one in ([name] if is_often(name.rpartition(", ")[2]) else soaked(name))]


def of(kind: Any, events: list[Any]) -> list[Any]:
    """Return the events of a kind."""
    return [event for event in events if isinstance(event, kind)]


def pieces(items: tuple[Item, ...], sizes: list[int]) -> Iterator[tuple[Item, ...]]:
    """Yield the items in chunks of these sizes, which are repeated until no item is left."""
    start, number = 0, 0
    while start < len(items):
        size = max(1, sizes[number % len(sizes)]) if sizes else len(items)
        yield items[start : start + size]
        start, number = start + size, number + 1
