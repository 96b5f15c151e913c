"""Computes what a page shows of the links, and of what the checks found in the data that came over them."""

from __future__ import annotations

from typing import Any

from attrs import define, field, frozen

from ....events import (
    CellFault,
    CellsFailed,
    ClockReset,
    Connected,
    Defect,
    DefectFound,
    Event,
    FeetSwapped,
    FootResumed,
    FootSilent,
    InsoleNeverUnloads,
)
from ....recording import printable
from ....types import SITE_OF_FOOT, Foot, Site
from ....walk.links import LinkLedger
from ..messages import members, plain

FAULTS = {
    CellFault.DEAD: ("cell shows no load", "cells show no load"),
    CellFault.STUCK: ("cell shows one value all the time", "cells show one value all the time"),
    CellFault.SATURATED: ("cell stays at the end of its range", "cells stay at the end of their range"),
    CellFault.MISSING: ("cell sends no number", "cells send no number"),
}
"""Words for a fault of one cell, and of several."""
UNLOADS_NEVER = (
    "the insole is never without load, so the phases come from the inertial sensor. Loosen the shoe, or lay the insole "
    "in again."
)
SWAPPED = (
    "the insoles may be swapped: what comes as the left foot looks like a right one. Stop, and put each sensor on its "
    "own foot."
)
SILENT = "nothing comes while the other foot walks on. See whether the sensor is switched on, charged and near."

BRIEF_OF_DEFECT = {
    **dict.fromkeys(
        (Defect.AXES, Defect.CONTRADICTION, Defect.NO_GRAVITY, Defect.WRONG_SCALE),
        "sensor is mounted or set up wrongly: its figures are wrong",
    ),
    **dict.fromkeys(
        (Defect.TIME_UNIT, Defect.ACC_UNIT, Defect.GYRO_UNIT, Defect.PRESSURE_UNIT),
        "sensor sends a wrong unit: its figures are wrong",
    ),
    Defect.LOOSE: "sensor is loose: fasten it",
    Defect.CLOCKS: "sensor has another clock than the other: figures of both feet together are wrong",
    Defect.MOVING_GROUND: "sensor: the ground carries the wearer",
    Defect.CALIBRATION: "sensor: the calibration of its heading does not fit",
}
"""Sentence for the line at the top of a page, after the word left or right, by defect."""
BRIEF_SPOILT = "sensor sends wrong data: its figures are wrong"
BRIEF_COARSE = "sensor: its figures are less accurate"


def brief_of(event: DefectFound) -> str:
    """Return one plain sentence on what a defect of a sensor means, without its reason."""
    words = BRIEF_OF_DEFECT.get(event.defect, BRIEF_SPOILT) if event.needs_action else BRIEF_COARSE
    return f"{event.site.words if event.site.foot is None else event.site.foot} {words}."


def link_frame(link: LinkLedger, now: float) -> dict[str, Any]:
    """Return one member of "links" of a frame at `now`, s."""
    state, rate = link.state(now), link.recent_rate(now)
    silent_for = max(now - link.last_sample_at, 0.0) if link.last_sample_at is not None else None
    return {
        **members(link, "missing", "gaps", "battery", "name", "signal", "trouble"),
        "state": state,
        "rate": rate if rate is None else round(rate) if rate >= 20.0 else round(rate, 1),
        "missing_share": plain(link.missing_share, 4),
        "recent_share": plain(link.recent_share(now), 4) if state == "ok" else None,
        "rejected": link.rejected.total(),
        "silent_for": plain(silent_for, 1) if state in ("silent", "lost") else None,
    }


def feet_silent_since(links: dict[Site, LinkLedger], now: float) -> float | None:
    """Return the arrival of the newest sample, s, if no foot sends at `now`, s; None if one does, or none ever did."""
    feet = [link for site, link in links.items() if site.foot is not None]
    last = max([link.last_sample_at for link in feet if link.last_sample_at is not None], default=None)
    return None if any([link.state(now) == "ok" for link in feet]) else last


def fault_words(event: CellsFailed) -> str:
    """Return how many cells of an insole have failed and how, in words, such as "2 cells show no load"."""
    return f"{len(event.cells)} {FAULTS[event.fault][len(event.cells) != 1]}"


@frozen
class Finding:
    """What a check found in the data; the member of "findings" of a frame has its fields."""

    t: float
    """Time at which it was found, s."""
    site: str
    """Sensor in words; "" for both feet."""
    brief: str
    """One sentence: what it means for the figures."""
    what: str
    """Sentences for the wearer: what is wrong, and what to do about it."""
    act: bool
    """True if results are wrong until somebody acts."""


@define
class SceneFindings:
    """Findings of the checks that still hold, at most one of each kind for each sensor."""

    found: dict[tuple[str, str], Finding] = field(factory=dict)
    """Findings by site and kind."""

    def add_event(self, event: Event) -> None:
        """Add what an event found, or remove what no longer holds; other events change nothing."""
        match event:
            case DefectFound(defect=defect, what=what):
                self._add(event, defect.value, brief_of(event), what, event.needs_action)
            case CellsFailed(site=site, fault=fault):
                words = f"{fault_words(event)}; left out from now on. Have the insole repaired; its other cells count."
                self._add(event, fault.value, f"{site.words}: {fault_words(event)}.", words)
            case InsoleNeverUnloads(site=site):
                self._add(event, "load", f"{site.words}: the insole is never without load.", UNLOADS_NEVER)
            case FeetSwapped():
                brief = "the insoles may be swapped: left is right, and right left."
                self._add(event, "swapped", brief, SWAPPED, True)
            case FootSilent(foot=foot):
                self._add(event, "silent", f"{foot} foot: no data while the other walks on.", SILENT, True)
            case FootResumed():
                self.found.pop((_site_words(event), "silent"), None)
            case Connected() | ClockReset(restarted=True):
                site_words = _site_words(event)
                self.found = {key: one for key, one in self.found.items() if key[0] != site_words}
            case _:
                pass

    def _add(self, event: Event, kind: str, brief: str, what: str, act: bool = False) -> None:
        words = _site_words(event)
        self.found[words, kind] = Finding(event.t, words, brief, printable(what, 300), act)

    @property
    def unsound(self) -> frozenset[Foot]:
        """Feet whose figures cannot be right until somebody acts."""
        sites = {one.site for one in self.found.values() if one.act}
        return frozenset(foot for foot in Foot if SITE_OF_FOOT[foot].words in sites)

    def frame(self, broken: frozenset[str]) -> list[dict[str, Any]]:
        """Return the member "findings" of a frame: those that somebody must act on first, then the newest first.

        That a foot sends nothing is left out where its link is one of `broken`, in words: the link says it."""
        shown = [one for (site, kind), one in self.found.items() if kind != "silent" or site not in broken]
        return [plain(one) for one in sorted(shown, key=lambda one: (not one.act, -one.t))]


def _site_words(event: Event) -> str:
    """Return the sensor that an event is about, in words; "" for both feet."""
    foot: Foot | None = getattr(event, "foot", None)
    site: Site | None = getattr(event, "site", None) if foot is None else SITE_OF_FOOT[foot]
    return "" if site is None else site.words
