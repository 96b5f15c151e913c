"""Looks for one device among all that advertise."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from attrs import define, field

from .air import Found, Scanner
from .wanted import DeviceConfig, says_its_site

SETTLE = 1.0
"""s of listening before the one device that answers to a name is taken for the only one."""
FORGET = 3.0
"""s after which a device that was not heard any more is not there to be connected."""
MISTAKEN = 30.0
"""s after which another one of the same name can no longer be mistaken for it."""


@define(eq=False)
class Search:
    """One search. `address`: the only one that will do, once it is known; else "". `barred`: devices not to be used.

    `patience`: s after `since` at which `complain` is told why nothing was found yet; once, for it may go on for hours.
    `since` may be before this search, which then listens for a moment at least.
    """

    air: Scanner
    wanted: DeviceConfig
    address: str
    barred: Callable[[Found], bool]
    patience: float
    since: float
    complain: Callable[[str], None]
    _heard: dict[str, Found] = field(factory=dict, init=False)
    _news: asyncio.Event = field(factory=asyncio.Event, init=False)
    _complained: bool = field(default=False, init=False)

    async def run(self) -> Found:
        """The device, as soon as it advertises and cannot be mistaken for another one."""
        loop = asyncio.get_running_loop()
        first: float | None = None
        late = max(self.since + self.patience, loop.time() + min(FORGET, self.patience))
        with self.air.listening(self._hear):
            while True:
                now = loop.time()
                self._heard = {at: one for at, one in self._heard.items() if now - one.t < MISTAKEN}
                able = [one for one in self._heard.values() if self._is_the_one(one) or not self.barred(one)]
                there = [one for one in able if now - one.t < FORGET]
                first = None if not there else now if first is None else first
                chosen = self._choose(able, there, settled=first is not None and now - first >= SETTLE)
                if chosen is not None:
                    return chosen
                if not self._heard and now >= late:
                    self._complain_once(
                        f"no {self.wanted.words} is heard: switch it on, bring it near, "
                        "and see that no other program or phone holds it"
                    )
                self._news.clear()
                with suppress(TimeoutError):
                    async with asyncio.timeout(SETTLE / 2):
                        await self._news.wait()

    def _hear(self, found: Found) -> None:
        if self.address:
            fits = found.address == self.address
        else:
            fits = self.wanted.fits(found.address, found.name, found.services)
        if fits:
            self._heard[found.address] = found
            self._news.set()
        else:
            self._heard.pop(found.address, None)  # it goes by another name now

    def _is_the_one(self, found: Found) -> bool:
        return found.address == self.address or self.wanted.is_address(found.address)

    def _choose(self, able: list[Found], there: list[Found], settled: bool) -> Found | None:
        for one in there:
            if self._is_the_one(one):
                return one
        if there and not self.wanted.which and says_its_site(self.wanted.profile):
            return there[0]  # any will do, and it is asked once it is connected
        if len(able) > 1:
            addresses = ", ".join(sorted(one.address for one in able))
            what = f"{len(able)} devices answer to {self.wanted.words} ({addresses}): say which by its address"
            self._complain_once(what)
            return None
        return there[0] if there and settled else None

    def _complain_once(self, what: str) -> None:
        if not self._complained:
            self._complained = True
            self.complain(what)
