"""Merges calibrations: what was learnt today is added to what a file holds."""

from __future__ import annotations

from typing import Any, TypeVar

from ..types import Foot
from ..types.attrs import evolve, fields
from .records import Calibration, InsoleCalibration

BY_FOOT = ("drift", "toe_out", "headings", "rest", "sensors")
"""Fields of a calibration that have a value for each foot, insoles apart."""


def merged(known: Calibration, newer: Calibration) -> Calibration:
    """Return `known` with its values replaced by those that `newer` has, field by field and insole by insole.

    Known noise is discarded when `newer` changes the conversion to newtons, because it was measured in another unit. So
    are a foot's heading and drift when its sensor is corrected otherwise, because they are what its errors caused."""
    insoles = dict(known.insoles)
    for foot, insole in newer.insoles.items():
        old_insole = insoles.get(foot, InsoleCalibration())
        if insole.newtons is not None and insole.newtons != old_insole.newtons:
            old_insole = evolve(old_insole, noise=())
        insoles[foot] = _replace_values(old_insole, insole)
    stale = stale_feet(known, newer)
    known = evolve(
        known,
        headings={foot: one for foot, one in known.headings.items() if foot not in stale},
        drift={foot: one for foot, one in known.drift.items() if foot not in stale},
    )
    by_foot: dict[str, dict[Foot, Any]] = {"insoles": insoles} | {
        name: getattr(known, name) | getattr(newer, name) for name in BY_FOOT
    }
    ordered: dict[str, Any] = {name: {foot: one[foot] for foot in Foot if foot in one} for name, one in by_foot.items()}
    return evolve(_replace_values(known, newer), **ordered)


def stale_feet(known: Calibration, newer: Calibration) -> list[Foot]:
    """Return the feet whose sensor `newer` corrects otherwise than `known`."""
    return [foot for foot, sensor in newer.sensors.items() if known.sensors.get(foot) != sensor]


_Known = TypeVar("_Known", Calibration, InsoleCalibration)


def _replace_values(known: _Known, newer: _Known) -> _Known:
    replaced = {f.name: getattr(newer, f.name) for f in fields(type(newer)) if getattr(newer, f.name)}
    return evolve(known, **replaced)
