"""The choice of one device among all that advertise."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from ..link.profile import Profile
from ..link.setup.config import DeviceConfig, identify, reports_site
from ..types.attrs import define, evolve, field, frozen

UNIQUENESS_TIME = 1.0
"""Time of listening without a second device that matches the config, after which the first is accepted, s."""
PRESENCE_TIME = 3.0
"""Time after its last advertisement during which a device counts as near enough to connect, s."""
SAME_NAME_TIME = 30.0
"""Time after its last advertisement during which a second device that matches the config prevents a choice, s."""
MOST_SEEN, MOST_NAMED = 100, 5
"""Largest number of devices that are remembered, and that a sentence lists, chosen by hand."""
CHOICE_INTERVAL = UNIQUENESS_TIME / 2
"""Longest time from one call of `choose` to the next, s."""


@frozen
class Advertisement:
    """The last advertisement of a device.

    `address` is that of the system; on macOS, iOS and in a browser it is an identifier that is valid there only.
    `services` holds the UUIDs that the device advertises. `signal` is the signal strength, dBm, -127 when unknown. `t`
    is the time of the advertisement, s, on the host's clock. `device` is the system's own object for the device."""

    address: str
    name: str
    services: tuple[str, ...]
    signal: int
    t: float
    device: Any = None

    def after(self, before: Advertisement | None) -> Advertisement:
        """Return this advertisement with what it lacks of the one before it: a name and services come in turns."""
        if before is None:
            return self
        return evolve(self, name=self.name or before.name, services=self.services or before.services)

    @property
    def profile(self) -> Profile | None:
        """Profile of the device; None for an unknown device."""
        return identify(self.name, self.services)


def describe_seen(seen: Iterable[Advertisement]) -> str:
    """Return words that list the devices that were seen, those with a name and the nearest first; "" for none."""
    ordered = sorted(seen, key=lambda one: (not one.name, -one.signal, one.address))
    if not ordered:
        return ""
    named = [f"{one.name or 'without a name'} ({one.address})" for one in ordered[:MOST_NAMED]]
    more = f" and {len(ordered) - MOST_NAMED} more" if len(ordered) > MOST_NAMED else ""
    return f"seen: {', '.join(named)}{more}"


@define(eq=False)
class Candidates:
    """The devices that may be the configured one.

    `address` is the only address to accept once it is known, else "". `is_excluded` returns True for devices not to
    use. If no device was found until `report_at`, s, `choose` reports it once, since a search may take hours."""

    config: DeviceConfig
    address: str
    is_excluded: Callable[[Advertisement], bool]
    report_at: float
    _found: dict[str, Advertisement] = field(factory=dict, init=False)
    _seen: dict[str, Advertisement] = field(factory=dict, init=False)
    """Newest advertisement of each device, MOST_SEEN of them."""
    _present_since: float | None = field(default=None, init=False)
    _reported: bool = field(default=False, init=False)

    def add(self, found: Advertisement) -> bool:
        """Add an advertisement; return whether it is of a device that may be the configured one."""
        found = found.after(self._seen.get(found.address))
        if found.address in self._seen or len(self._seen) < MOST_SEEN:
            self._seen[found.address] = found
        if self.address:
            matches = found.address == self.address
        else:
            matches = self.config.matches(found.address, found.name, found.services)
        if matches:
            self._found[found.address] = found
        else:
            self._found.pop(found.address, None)  # the device advertises another name now
        return matches

    def choose(self, now: float) -> tuple[Advertisement | None, str]:
        """Return the device, or None as long as another may be mistaken for it, and a sentence to report, or ""."""
        self._found = {k: found for k, found in self._found.items() if now - found.t < SAME_NAME_TIME}
        candidates = [one for one in self._found.values() if self._has_address(one) or not self.is_excluded(one)]
        present = [device for device in candidates if now - device.t < PRESENCE_TIME]
        if not present:
            self._present_since = None
        elif self._present_since is None:
            self._present_since = now
        for device in present:
            if self._has_address(device):
                return device, ""
        if present and not self.config.which and reports_site(self.config.profile):
            return present[0], ""  # any of them will do: it reports its site once it is connected
        if len(candidates) > 1:
            addresses = ", ".join(sorted(device.address for device in candidates))
            return None, self._once(
                f"{len(candidates)} devices answer to {self.config.description} ({addresses}): say which by its address"
            )
        if present and self._present_since is not None and now - self._present_since >= UNIQUENESS_TIME:
            return present[0], ""
        if not self._found and now >= self.report_at:
            seen = describe_seen(self._seen.values())
            return None, self._once(
                f"no {self.config.description} is in range: switch it on, bring it near, "
                f"and see that no other program or phone holds it{seen and '; ' + seen}"
            )
        return None, ""

    def _has_address(self, found: Advertisement) -> bool:
        return found.address == self.address or self.config.is_address(found.address)

    def _once(self, text: str) -> str:
        if self._reported:
            return ""
        self._reported = True
        return text
