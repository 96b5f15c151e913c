"""Looks for one device among all that advertise."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from attrs import define, field

from .air import Air, Found
from .wanted import Wanted, says_its_site

SETTLE = 1.0
"""s of listening before the one device that answers to a name is taken for the only one."""
FORGET = 3.0
"""s after which a device that was not heard any more is no longer there."""


@define(eq=False)
class Search:
    """One search. `address`: the only one that will do, once it is known; else "". `barred`: addresses not to be used.

    `patience`: s after which `complain` is told why nothing was found yet; once, for it may go on for hours.
    """

    air: Air
    wanted: Wanted
    address: str
    barred: Callable[[str], bool]
    patience: float
    complain: Callable[[str], None]
    _heard: dict[str, Found] = field(factory=dict, init=False)
    _news: asyncio.Event = field(factory=asyncio.Event, init=False)
    _complained: bool = field(default=False, init=False)

    async def run(self) -> Found:
        """The device, as soon as it advertises and cannot be mistaken for another one."""
        loop = asyncio.get_running_loop()
        first: float | None = None
        began = loop.time()
        with self.air.listening(self._hear):
            while True:
                now = loop.time()
                there = [one for one in self._heard.values() if now - one.t < FORGET and self._may_be(one)]
                first = None if not there else now if first is None else first
                chosen = self._choose(there, settled=first is not None and now - first >= SETTLE)
                if chosen is not None:
                    return chosen
                if not there and now - began >= self.patience:
                    self._complain_once(self._nobody())
                self._news.clear()
                await either(self._news, SETTLE / 2)

    def _hear(self, found: Found) -> None:
        if self.address:
            fits = found.address == self.address
        else:
            fits = self.wanted.fits(found.address, found.name, found.services)
        if fits:
            self._heard[found.address] = found
            self._news.set()

    def _is_the_one(self, found: Found) -> bool:
        return found.address == self.address or self.wanted.is_address(found.address)

    def _may_be(self, found: Found) -> bool:
        return self._is_the_one(found) or not self.barred(found.address)

    def _choose(self, there: list[Found], settled: bool) -> Found | None:
        for one in there:
            if self._is_the_one(one):
                return one
            if says_its_site(self.wanted.profile or one.profile):
                return one  # and is asked, once it is connected
        if len(there) == 1 and settled:
            return there[0]
        if len(there) > 1:
            addresses = ", ".join(sorted(one.address for one in there))
            what = f"{len(there)} devices answer to {self.wanted.words} ({addresses}): say which by its address"
            self._complain_once(what)
        return None

    def _complain_once(self, what: str) -> None:
        if not self._complained:
            self._complained = True
            self.complain(what)

    def _nobody(self) -> str:
        return (
            f"no {self.wanted.words} is heard: switch it on, bring it near, "
            "and see that no other program or phone holds it"
        )


async def either(event: asyncio.Event, seconds: float | None) -> None:
    """Until `event`, or so long; None: however long."""
    try:
        async with asyncio.timeout(seconds):
            await event.wait()
    except TimeoutError:
        pass
