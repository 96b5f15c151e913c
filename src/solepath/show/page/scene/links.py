"""Computes what a page shows of the links."""

from __future__ import annotations

from typing import Any

from ....types import Site
from ...links import LinkLedger
from ..messages import rounded


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
        "lost": link.lost,
        "loss": rounded(link.recent_loss(now), 4) if state == "ok" else None,
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
