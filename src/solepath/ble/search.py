"""Search for one device among all that advertise."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from attrs import define, field

from .config import DeviceConfig, reports_site
from .scanning import Advertisement, Scanner

UNIQUENESS_TIME = 1.0
"""Time of listening without a second device that matches the config, after which the first is accepted, s."""
PRESENCE_TIME = 3.0
"""Time after its last advertisement during which a device counts as near enough to connect, s."""
SAME_NAME_TIME = 30.0
"""Time after its last advertisement during which a second device that matches the config prevents a choice, s."""


@define(eq=False)
class Search:
    """A search for one device.

    `address` is the only address to accept once it is known, else "". `is_excluded` returns True for devices not to
    use. If nothing was found `patience` s after `since` (s, loop's clock), `report_trouble` is called once, since the
    search may take hours. `since` may be before this search; the search then listens up to PRESENCE_TIME before it
    reports."""

    scanner: Scanner
    config: DeviceConfig
    address: str
    is_excluded: Callable[[Advertisement], bool]
    patience: float
    since: float
    report_trouble: Callable[[str], None]
    _found: dict[str, Advertisement] = field(factory=dict, init=False)
    _advertised: asyncio.Event = field(factory=asyncio.Event, init=False)
    _reported: bool = field(default=False, init=False)

    async def run(self) -> Advertisement:
        """Return the device as soon as it advertises and no other device can be mistaken for it."""
        loop = asyncio.get_running_loop()
        present_since: float | None = None
        report_at = max(self.since + self.patience, loop.time() + min(PRESENCE_TIME, self.patience))
        with self.scanner.listening(self._on_advertisement):
            while True:
                now = loop.time()
                self._found = {k: found for k, found in self._found.items() if now - found.t < SAME_NAME_TIME}
                candidates = [
                    device
                    for device in self._found.values()
                    if self._has_address(device) or not self.is_excluded(device)
                ]
                present = [device for device in candidates if now - device.t < PRESENCE_TIME]
                present_since = None if not present else now if present_since is None else present_since
                device_found = self._choose(
                    candidates, present, settled=present_since is not None and now - present_since >= UNIQUENESS_TIME
                )
                if device_found is not None:
                    return device_found
                if not self._found and now >= report_at:
                    self._report_once(
                        f"no {self.config.description} is in range: switch it on, bring it near, "
                        "and see that no other program or phone holds it"
                    )
                self._advertised.clear()
                with suppress(TimeoutError):
                    async with asyncio.timeout(UNIQUENESS_TIME / 2):
                        await self._advertised.wait()

    def _on_advertisement(self, found: Advertisement) -> None:
        if self.address:
            matches = found.address == self.address
        else:
            matches = self.config.matches(found.address, found.name, found.services)
        if matches:
            self._found[found.address] = found
            self._advertised.set()
        else:
            self._found.pop(found.address, None)  # the device advertises another name now

    def _has_address(self, found: Advertisement) -> bool:
        return found.address == self.address or self.config.is_address(found.address)

    def _choose(
        self, candidates: list[Advertisement], present: list[Advertisement], settled: bool
    ) -> Advertisement | None:
        for device in present:
            if self._has_address(device):
                return device
        if present and not self.config.which and reports_site(self.config.profile):
            return present[0]  # any of them will do: it reports its site once it is connected
        if len(candidates) > 1:
            addresses = ", ".join(sorted(device.address for device in candidates))
            self._report_once(
                f"{len(candidates)} devices answer to {self.config.description} ({addresses}): say which by its address"
            )
            return None
        return present[0] if present and settled else None

    def _report_once(self, text: str) -> None:
        if not self._reported:
            self._reported = True
            self.report_trouble(text)
