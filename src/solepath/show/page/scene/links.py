"""Computes what a page shows of the links, and of what the checks found in the data that came over them."""

from __future__ import annotations

from typing import Any

from ....events import Defect, DefectFound
from ....recording import printable
from ....types import Site
from ....walk.links import LinkLedger
from ....walk.walk import Walk
from ...findings import Concern, Finding, reported
from ..messages import members, plain

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


def brief_of(finding: Finding) -> str:
    """Return one plain sentence on what a finding means for the figures, without its reason."""
    event = finding.event
    if not isinstance(event, DefectFound):
        return f"{finding.brief}."
    words = BRIEF_OF_DEFECT.get(event.defect, BRIEF_SPOILT) if finding.act else BRIEF_COARSE
    return f"{event.site.words if event.site.foot is None else event.site.foot} {words}."


def link_frame(link: LinkLedger, now: float) -> dict[str, Any]:
    """Return one member of "links" of a frame at `now`, s."""
    state, rate = link.state(now), link.recent_rate(now)
    silent_for = max(now - link.last_sample_at, 0.0) if link.last_sample_at is not None else None
    return {
        **members(link, "missing", "gaps", "battery", "name", "signal", "trouble"),
        "state": state,
        "rate": rate if rate is None else round(rate) if rate >= 20.0 else round(rate, 1),
        "absent": plain(link.absent_time(now), 1),
        "missing_share": plain(link.missing_share, 4),
        "recent_share": plain(link.recent_share(now), 4) if state == "ok" else None,
        "rejected": link.rejected.total(),
        "silent_for": plain(silent_for, 1) if state in ("silent", "lost") else None,
        "delay": {name: [round(1e3 * t) for t in times] for name, times in link.delays.figures.items()},
    }


def feet_silent_since(links: dict[Site, LinkLedger], now: float) -> float | None:
    """Return the arrival of the newest sample, s, if no foot sends at `now`, s; None if one does, or none ever did."""
    feet = [link for site, link in links.items() if site.foot is not None]
    last = max([link.last_sample_at for link in feet if link.last_sample_at is not None], default=None)
    return None if any([link.state(now) == "ok" for link in feet]) else last


def standing_findings(walk: Walk) -> list[Finding]:
    """Return what is wrong with the data and with the sensors now: what somebody must act on first, the newest first.

    What is wrong with a link stands at the link."""
    found = [one for one in reported(walk, now=True) if one.concern in (Concern.DATA, Concern.WEAR)]
    return sorted(found, key=lambda one: (not one.act, -one.event.t if one.event else 0.0))


def findings_frame(walk: Walk, broken: frozenset[str]) -> list[dict[str, Any]]:
    """Return the member "findings" of a frame.

    That a foot sends nothing is left out where its link is one of `broken`, in words: the link says it."""
    found = [(one, "" if one.site is None else one.site.words) for one in standing_findings(walk)]
    return [
        {
            "t": plain(one.event and one.event.t),
            "site": words,
            "brief": printable(brief_of(one), 300),
            "what": printable(one.what, 300),
            "act": one.act,
        }
        for one, words in found
        if one.code != "foot_silent" or words not in broken
    ]
