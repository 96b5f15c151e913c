"""How the links do, a line for each site: rate, loss, battery, signal; and where the wearer is on a floor plan."""

from __future__ import annotations

from ...recording import printable
from ...types import Site
from ..links import LinkLedger
from ..observer import Observer
from .placed import here


def status(observer: Observer) -> list[str]:
    """A line for each site that was heard of, in the order of Site, and one for the place once it is known."""
    lines = [_line(site, observer.links[site], observer.now) for site in Site if site in observer.links]
    place = observer.places.last
    return lines if place is None else [*lines, here(place)]


def _line(site: Site, link: LinkLedger, now: float) -> str:
    told = [f"{site.words}: {link.rate_of_late(now) or 0.0:.0f} Hz"]
    if link.loss is not None:
        told.append(f"{100.0 * link.loss:.1f} % lost")
    if link.battery is not None:
        told.append(f"battery {100.0 * link.battery:.0f} %")
    if link.signal is not None:
        told.append(f"{link.signal} dBm")
    if link.state(now) == "lost":
        told.append("disconnected")
    if link.trouble:
        told.append(printable(link.trouble))
    return ", ".join(told)
