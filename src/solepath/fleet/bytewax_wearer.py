"""One wearer of a fleet on bytewax: what `gait` keeps of each."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from itertools import chain
from typing import Any

from attrs import define
from bytewax.operators import StatefulBatchLogic

from .fleet import Fleet
from .step.keyed import Keyed
from .step.sent import NumberedEvent


@define
class KeyedWearer(StatefulBatchLogic[tuple[str, Any], NumberedEvent, tuple[bytes | None, datetime | None]]):
    """One wearer: a session, or its state as bytes, or both while they are the same. `ended`: when the last row came,
    once the wearer has ended."""

    fleet: Fleet
    idle: timedelta | None
    forget: timedelta | None
    state: bytes | None
    ended: datetime | None
    keyed: Keyed | None = None

    def on_batch(self, values: list[tuple[str, Any]]) -> tuple[Iterable[NumberedEvent], bool]:
        keyed = self.keyed = self.keyed or self.fleet.open(values[0][0], self.state)
        self.state = None
        told = [keyed.feed(sent if isinstance(sent, list | tuple) else [sent]) for _, sent in values]
        self.ended = datetime.now(UTC) if keyed.ended else None
        return list(chain.from_iterable(told)), self.RETAIN

    def notify_at(self) -> datetime | None:
        idle = [datetime.now(UTC) + self.idle] if self.idle is not None and self.keyed is not None else []
        return min([*idle, *self._forget_at()], default=None)

    def on_notify(self) -> tuple[Iterable[NumberedEvent], bool]:
        if any([at <= datetime.now(UTC) for at in self._forget_at()]):
            return [], self.DISCARD
        self.snapshot()
        self.keyed = None
        return [], self.RETAIN

    def _forget_at(self) -> list[datetime]:
        return [self.ended + self.forget] if self.ended is not None and self.forget is not None else []

    def snapshot(self) -> tuple[bytes | None, datetime | None]:
        if self.state is None and self.keyed is not None:
            self.state = self.keyed.state()
        return self.state, self.ended
