"""Uses once what the worker of the site can do, so that the build finds the modules that it needs."""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Sequence
from importlib import import_module
from itertools import islice
from pathlib import Path
from pkgutil import walk_packages
from types import ModuleType
from typing import Any

from ... import body, calibration, events, floorplan, foot, link, recipes, saving, session, types, wire
from ...link.devices.insole import PROFILE as INSOLE
from ...link.profile import Access
from ...recording import PacketWriter, read_packets
from ...types import Packet
from .. import page, report
from .worker import Worker

ROOMS = (types, events, saving, calibration, floorplan, wire, link, foot, body, session, page, report)
"""Rooms of which every module goes to the site: a device or a file may need any of them."""
LEFT_OUT = ("solepath.show.page.server", "solepath.show.page.player.player_loop")
"""Modules that serve the page, for which the site has no use."""
PACKETS = 1000
"""Number of packets of the demonstration that are used: some strides."""
ENCODINGS = ("utf_8", "ascii", "latin_1", "cp437", "utf_16", "cp1252", "iso8859_15")
"""Encodings of texts in files of other programs."""


def rehearse(demo: str, _: Any = None) -> list[str]:
    """Use the worker with the first packets of a recording; return the files of the modules that are loaded then."""
    for room in ROOMS:
        _import_all(room)
    for name in recipes.NAMES:
        recipes.by_name(name)
    for name in ENCODINGS:
        import_module(f"encodings.{name}")
    os.makedirs("/files", exist_ok=True)
    os.chdir("/files")
    packets = [*islice(read_packets(demo), PACKETS)]
    with PacketWriter(Path("walk.jsonl")) as writer:
        for packet in packets:
            writer.write(packet)
    worker = Worker("0")
    worker.start_walk("a walk")
    worker.sensor_filters()
    worker.choices()
    connect(worker, packets)
    send_frames(worker, packets[:700])
    _send(worker, type="time", t=packets[-1].t + 3.0)
    worker.take_lines()
    worker.message()
    saved = worker.save()
    _run(worker, "resume_walk", "a walk", saved, "walk.jsonl", packets[-1].t + 5.0)
    worker.finish_walk()
    _run(worker, "open", "walk.jsonl")
    worker.play(0.1, 0.1)
    worker.command('{"do": "seek", "value": 5.0}')
    worker.play(0.1, 1.0)
    worker.heartbeat()
    _run(worker, "report", "", "a walk")
    for name, text in (("bad.jsonl", "{"), ("bad.csv", ""), ("plan.geojson", "{}"), ("plan.osm", "<osm/>"), ("a", "-")):
        Path(name).write_text(text)
        _run(worker, "open", name)
    traceback.format_exc()
    return sorted(_files())


def connect(worker: Worker, packets: Sequence[Packet]) -> None:
    """Connect two insoles, whose values are those of the packets; their sites are also their addresses."""
    values = {(packet.site.value, packet.channel): packet.data.hex() for packet in packets}
    for device in {packet.site.value for packet in packets}:
        about = {"device": device, "t": packets[0].t}
        characteristics = [[one.service, one.characteristic, one.access is Access.NOTIFY] for one in INSOLE.channels]
        _send(worker, type="add", device=device)
        answers = _send(worker, type="connected", characteristics=characteristics, **about)
        while answers:
            value = values.get((device, answers[-1]["channel"]), "")
            answers = _send(worker, type="done", value=value, **about)


def send_frames(worker: Worker, packets: Sequence[Packet]) -> None:
    """Let the insoles send the frames of the packets."""
    frames = [packet for packet in packets if packet.channel in INSOLE.streams]
    _send(worker, type="values", values=[[one.t, one.site.value, one.channel, one.data.hex()] for one in frames])


def _send(worker: Worker, **message: Any) -> Any:
    return json.loads(worker.receive(json.dumps(message)))


def _run(worker: Worker, name: str, *arguments: Any) -> Any:
    worker.start(name, arguments)
    while "share" in (answer := json.loads(worker.step(1.0))):
        pass
    return answer


def _import_all(room: ModuleType) -> None:
    for found in walk_packages(room.__path__, f"{room.__name__}."):
        if not found.name.startswith(LEFT_OUT):
            import_module(found.name)


def _files() -> set[str]:
    """Return the files of the loaded modules that are not built into Python."""
    specs = [getattr(module, "__spec__", None) for module in [*sys.modules.values()]]
    origins = {spec.origin for spec in specs if spec is not None and spec.origin}
    return {origin for origin in origins if origin.endswith(".py") and not origin.endswith(Path(__file__).name)}
