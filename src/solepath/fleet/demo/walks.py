"""The emulated walks that the wearers of a demonstration share: insoles and both SensorTags over a bad radio."""

from __future__ import annotations

from math import pi

from ...emulate.radio import Radio
from ...emulate.routes.route import Route
from ...emulate.sensors.device import Device
from ...emulate.sensors.insole_device import Insole
from ...emulate.sensors.sensortags import CC2541, CC2650
from ...emulate.walk import emulate
from ...types import Packet, Site

ROUGH = Radio(loss=0.02, duplicate=0.005, corrupt=0.005, truncate=0.005, latency=0.01, jitter=0.03)
"""Of a hundred notifications two never arrive, and one is damaged."""
SPEED = 1.3
"""m/s."""
DEVICES: dict[str, Device] = {
    "insoles": Insole(cells=48),
    "insoles in fragments": Insole(cells=24, rate=50.0, mtu=23),
    "insoles with broken cells": Insole(cells=35, batch=4, quaternion=True, broken=((5, 0), (6, 4095))),
    "insoles out of reach": Insole(cells=48, rate=50.0),
    "CC2650": CC2650(presses=(2.0,)),
    "CC2541": CC2541(rate=20.0),
}
"""What is worn on both feet, by the name of the walk."""
SILENT = "insoles out of reach"
"""The walk in which nothing is heard for a while."""
SILENCE = (0.5, 0.65)
"""From which to which share of it."""


def walk(name: str, seconds: float, seed: int) -> list[Packet]:
    """What is heard in the first `seconds` of a walk in laps that begins with a stand, in the order of arrival."""
    route, length = Route().stand(1.0), 0.0
    while length < SPEED * seconds:
        route = route.walk(6.0, SPEED).turn(pi / 2, radius=1.5)
        length += 6.0 + 1.5 * pi / 2
    worn = {site: DEVICES[name] for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}
    heard = [packet for packet in emulate(route, devices=worn, radio=ROUGH, seed=seed).packets if packet.t < seconds]
    if name == SILENT:
        begin, end = (share * seconds for share in SILENCE)
        heard = [packet for packet in heard if not begin <= packet.t < end]
    return heard
