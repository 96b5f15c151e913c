"""Computes what a page shows of the links, and of what the checks found in the data that came over them."""

from __future__ import annotations

from typing import Any

from attrs import define, field

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
from ..messages import rounded

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
    words = BRIEF_OF_DEFECT.get(event.defect) if event.needs_action else None
    site = event.site
    name = f"{site.foot} " if site.foot is not None else f"{site.words} "
    return f"{name}{words or (BRIEF_SPOILT if event.needs_action else BRIEF_COARSE)}."


def link_frame(link: LinkLedger, now: float) -> dict[str, Any]:
    """Return one member of "links" of a frame at `now`, s."""
    state = link.state(now)
    silent = state in ("silent", "lost") and link.last_sample_at is not None
    rate = link.recent_rate(now)
    if rate is not None:
        rate = round(rate) if rate >= 20.0 else round(rate, 1)
    return {
        "state": state,
        "rate": rate,
        "missing": link.missing,
        "missing_share": rounded(link.missing_share, 4),
        "recent_share": rounded(link.recent_share(now), 4) if state == "ok" else None,
        "rejected": link.rejected.total(),
        "gaps": link.gaps,
        "battery": rounded(link.battery),
        "name": link.name,
        "signal": link.signal,
        "silent_for": rounded(max(now - (link.last_sample_at or 0.0), 0.0), 1) if silent else None,
        "trouble": link.trouble,
    }


def feet_silent_since(links: dict[Site, LinkLedger], now: float) -> float | None:
    """Return the arrival of the newest sample, s, if no foot sends at `now`, s; None if one does, or none ever did."""
    feet = [link for site, link in links.items() if site.foot is not None]
    last = max([link.last_sample_at for link in feet if link.last_sample_at is not None], default=None)
    return None if any([link.state(now) == "ok" for link in feet]) else last


def fault_words(event: CellsFailed) -> str:
    """Return how many cells of an insole have failed and how, in words, such as "2 cells show no load"."""
    return f"{len(event.cells)} {FAULTS[event.fault][len(event.cells) != 1]}"


@define
class SceneFindings:
    """Findings of the checks that still hold, at most one of each kind for each sensor."""

    found: dict[str, tuple[float, str, str, str, bool]] = field(factory=dict)
    """(t, site in words or "" for both feet, one sentence, all of them, whether results are wrong until somebody acts),
    by site and kind; t in s."""

    def add_event(self, event: Event) -> None:
        """Add what an event found, or remove what no longer holds; other events change nothing."""
        match event:
            case DefectFound(site=site, defect=defect, what=what):
                self._add(event, site, defect.value, brief_of(event), what, event.needs_action)
            case CellsFailed(site=site, fault=fault):
                words = f"{fault_words(event)}; left out from now on. Have the insole repaired; its other cells count."
                self._add(event, site, fault.value, f"{site.words}: {fault_words(event)}.", words, False)
            case InsoleNeverUnloads(site=site):
                self._add(event, site, "load", f"{site.words}: the insole is never without load.", UNLOADS_NEVER, False)
            case FeetSwapped():
                self._add(
                    event, None, "swapped", "the insoles may be swapped: left is right, and right left.", SWAPPED, True
                )
            case FootSilent(foot=foot):
                self._add(
                    event, SITE_OF_FOOT[foot], "silent", f"{foot} foot: no data while the other walks on.", SILENT, True
                )
            case FootResumed(foot=foot):
                self.found.pop(_key(SITE_OF_FOOT[foot], "silent"), None)
            case Connected(site=site) | ClockReset(site=site, restarted=True):
                start = _key(site, "")
                self.found = {key: one for key, one in self.found.items() if not key.startswith(start)}
            case _:
                pass

    def _add(self, event: Event, site: Site | None, kind: str, brief: str, what: str, act: bool) -> None:
        words = "" if site is None else site.words
        self.found[_key(site, kind)] = (rounded(event.t) or 0.0, words, brief, printable(what, 300), act)

    @property
    def unsound(self) -> frozenset[Foot]:
        """Feet whose figures cannot be right until somebody acts."""
        sites = {site for _, site, _, _, act in self.found.values() if act}
        return frozenset(foot for foot in Foot if SITE_OF_FOOT[foot].words in sites)

    def frame(self, broken: frozenset[Site] = frozenset()) -> list[dict[str, Any]]:
        """Return the member "findings" of a frame: those that somebody must act on first, then the newest first.

        That a foot sends nothing is left out where its link is `broken`: the link says it."""
        silent = {_key(site, "silent") for site in broken}
        ordered = sorted(
            [one for key, one in self.found.items() if key not in silent], key=lambda one: (not one[4], -one[0])
        )
        return [
            {"t": t, "site": site, "brief": brief, "what": what, "act": act} for t, site, brief, what, act in ordered
        ]


def _key(site: Site | None, kind: str) -> str:
    return f"{'' if site is None else site.words}: {kind}"
