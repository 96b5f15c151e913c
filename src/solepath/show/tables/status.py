"""How the links do, a line for each site: rate, loss, battery, signal; and where the wearer is on a floor plan."""

from __future__ import annotations

from ...recording import printable
from ...types import Site
from ..monitor import LinkHealth, Monitor
from .placed import here


def status(monitor: Monitor) -> list[str]:
    """A line for each site that was heard of, in the order of Site, and one for the place once it is known."""
    lines = [_line(site, monitor.links[site], monitor.now) for site in Site if site in monitor.links]
    place = monitor.session.place
    return lines if place is None else [*lines, here(place)]


def _line(site: Site, link: LinkHealth, now: float) -> str:
    told = [f"{site.words}: {link.rate(now):.0f} Hz"]
    if link.loss is not None:
        told.append(f"{100.0 * link.loss:.1f} % lost")
    if link.battery is not None:
        told.append(f"battery {100.0 * link.battery:.0f} %")
    if link.signal is not None:
        told.append(f"{link.signal} dBm")
    if link.connections and not link.connected:
        told.append("disconnected")
    if link.trouble:
        told.append(printable(link.trouble))
    return ", ".join(told)
