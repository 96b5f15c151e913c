"""Search for one device among all that advertise."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from attrs import define, field

from .config import DeviceConfig, reports_site
from .scanning import Found, Scanner

UNIQUE_AFTER = 1.0
"""Time of listening after which the only device with the name is accepted as the only one, s."""
PRESENT_FOR = 3.0
"""Time without an advertisement after which a device cannot be connected any more, s."""
SAME_NAME_FOR = 30.0
"""Time after its last advertisement for which another device of the same name prevents a choice, s."""


@define(eq=False)
class Search:
    """One search for one device.

    `address` is the only address to accept once it is known, else "". `is_excluded` says which devices not to use.
    `report_trouble` receives the reason `patience` s after `since` when nothing was found; once, since the search may
    go on for hours. `since` may be before this search, which then listens for a short time at least."""

    scanner: Scanner
    config: DeviceConfig
    address: str
    is_excluded: Callable[[Found], bool]
    patience: float
    since: float
    report_trouble: Callable[[str], None]
    _found: dict[str, Found] = field(factory=dict, init=False)
    _advertised: asyncio.Event = field(factory=asyncio.Event, init=False)
    _reported: bool = field(default=False, init=False)

    async def run(self) -> Found:
        """Return the device as soon as it advertises and no other device can be mistaken for it."""
        loop = asyncio.get_running_loop()
        first: float | None = None
        complain_at = max(self.since + self.patience, loop.time() + min(PRESENT_FOR, self.patience))
        with self.scanner.listening(self._on_advertisement):
            while True:
                now = loop.time()
                self._found = {at: one for at, one in self._found.items() if now - one.t < SAME_NAME_FOR}
                candidates = [
                    one for one in self._found.values() if self._has_address(one) or not self.is_excluded(one)
                ]
                present = [one for one in candidates if now - one.t < PRESENT_FOR]
                first = None if not present else now if first is None else first
                chosen = self._choose(candidates, present, settled=first is not None and now - first >= UNIQUE_AFTER)
                if chosen is not None:
                    return chosen
                if not self._found and now >= complain_at:
                    self._report_once(
                        f"no {self.config.description} is heard: switch it on, bring it near, "
                        "and see that no other program or phone holds it"
                    )
                self._advertised.clear()
                with suppress(TimeoutError):
                    async with asyncio.timeout(UNIQUE_AFTER / 2):
                        await self._advertised.wait()

    def _on_advertisement(self, found: Found) -> None:
        if self.address:
            fits = found.address == self.address
        else:
            fits = self.config.matches(found.address, found.name, found.services)
        if fits:
            self._found[found.address] = found
            self._advertised.set()
        else:
            self._found.pop(found.address, None)  # it advertises another name now

    def _has_address(self, found: Found) -> bool:
        return found.address == self.address or self.config.is_address(found.address)

    def _choose(self, candidates: list[Found], present: list[Found], settled: bool) -> Found | None:
        for one in present:
            if self._has_address(one):
                return one
        if present and not self.config.which and reports_site(self.config.profile):
            return present[0]  # any of them: it reports its site once it is connected
        if len(candidates) > 1:
            addresses = ", ".join(sorted(one.address for one in candidates))
            what = (
                f"{len(candidates)} devices answer to {self.config.description} ({addresses}): say which by its address"
            )
            self._report_once(what)
            return None
        return present[0] if present and settled else None

    def _report_once(self, what: str) -> None:
        if not self._reported:
            self._reported = True
            self.report_trouble(what)
