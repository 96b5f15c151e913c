"""One wearer of a fleet as an object: a session, the order of its rows, and the numbers of its events."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeGuard

from attrs import asdict

from ...events import Event
from ...saving.codec import SnapshotError
from ...session import Session
from ...types import Packet
from ..events import FleetEvent, NumbersMissing, SentRejected, SentRejection, StateRejected, WearerFailed
from .order import MissingNumbers, Payload, RejectedItem, RowOrder, check_payload
from .sent import MAX_COUNT, MAX_DETAIL_LENGTH, End, NumberedEvent, Sent, Tick, Unreadable
from .sessions import Sessions
from .state import StateError, StateHead, StateRest, read_head, read_rest, write_state

EVENTS_PER_ROW = 64
"""Largest mean number of events per row of a phone for which identities stay unique (protocol/fleet.md)."""


class Keyed:
    """One wearer, for engines that keep objects between two snapshots; made by `Fleet.open`.

    `feed` raises only MemoryError, whatever phones sent; then discard this object and continue from the last `state()`.
    The output does not depend on how the input is divided among calls, nor on how often `state()` is taken and opened,
    if the app's parts can be saved at any moment (Fleet.step)."""

    __slots__ = (
        "_emitted",
        "_known_at",
        "_has_numbers",
        "_opened_state",
        "_packed",
        "_order",
        "_pending",
        "_session",
        "_fleet",
        "_next_event",
        "_wearer",
    )

    def __init__(self, fleet: Sessions, wearer: str, state: bytes | None) -> None:
        self._fleet, self._wearer = fleet, wearer
        self._order = RowOrder(fleet.window)
        self._session: Session | None = None
        self._next_event, self._known_at = 0, 0.0
        self._emitted: list[NumberedEvent] = []
        """Events that `feed` returns when it has used all rows."""
        self._pending: tuple[type[StateRejected | WearerFailed], str] | None = None
        """Kind and detail of a failure of the state or session, to be reported before other events."""
        self._opened_state: bytes | None = None
        """The state that caused the pending failure, until the failure is reported."""
        self._packed: bytes | None = None
        """The session as it is in the opened state, until a row is used; then it is packed again."""
        self._has_numbers = True
        """False if the state was unreadable and no numbered row has come, so that the next number is unknown."""
        if state is not None:
            if not isinstance(state, bytes | bytearray | memoryview):
                raise TypeError(f"a state is bytes, or None for a new wearer, not a {type(state).__name__}")
            self._open(bytes(state))

    @property
    def ended(self) -> bool:
        """True if the wearer has taken the sensors off and no later row has started a session."""
        return self._order.ended

    def feed(self, sent: Iterable[Sent | Unreadable]) -> list[NumberedEvent]:
        """Return the events of the wearer's session and of the fleet for these rows.

        A row in its turn, neither late nor early, is used at once."""
        if self._pending is not None and self._has_numbers:
            self._report_pending()
        for item in sent:
            self._use_in_order(item)
        emitted, self._emitted = self._emitted, []
        return emitted

    def state(self) -> bytes:
        """Return the whole state, with which `Fleet.open` or `Fleet.step` continues."""
        if self._opened_state is not None:
            return self._opened_state
        order, session = self._order, None
        try:
            session = self._packed
            if session is None and self._session is not None:
                session = self._session.pack()
        except MemoryError:
            raise
        except Exception as error:  # of a part of the app's own
            self._drop_session()
            self._pending = (WearerFailed, _describe(error))
        failure = "" if self._pending is None else self._pending[1]
        rest = StateRest(order.ended, order.unused, order.strays, order.held_rows, failure, session)
        return write_state(StateHead(order.run, order.next_number, self._next_event, self._now()), rest)

    def _open(self, state: bytes) -> None:
        head = read_head(state)
        if head is None:
            self._pending, self._opened_state = (StateRejected, "nothing of the state can be read"), state
            self._has_numbers = False
            return
        window, self._next_event, self._known_at = self._fleet.window, head.next_event, head.known
        self._order = RowOrder(window, head.run, head.next)
        try:
            rest = read_rest(state)
            order_state = (head.run, head.next, rest.ended, rest.held_rows, rest.unused, rest.strays)
            self._order = RowOrder(window, *order_state)
            if rest.failure:
                self._pending = (WearerFailed, rest.failure)
            elif rest.session is not None:
                self._session, self._packed = self._fleet.unpack(rest.session), rest.session
        except (StateError, SnapshotError) as error:
            self._pending = (StateRejected, str(error)[:MAX_DETAIL_LENGTH])
        except MemoryError:
            raise
        except Exception as error:  # of a part of the app's own
            self._pending = (WearerFailed, _describe(error))
        if self._pending is not None:
            self._opened_state = state

    def _use_in_order(self, item: object) -> None:
        """Check a row, put it in order, and use the rows whose turn has come."""
        payload: Payload
        match item:
            case Sent(wearer=self._wearer, run=run, number=number) if _is_count(run) and _is_count(number):
                payload = check_payload(item.what)
            case Unreadable(run=run, number=number, what=str(what)) if _is_count(run) and _is_count(number):
                payload = RejectedItem(SentRejection.UNREADABLE, what[:MAX_DETAIL_LENGTH])
            case _:
                if self._has_numbers:
                    self._reject_unnumbered(item)
                return
        if not self._has_numbers:
            self._has_numbers, self._next_event = True, first_event_number(run, number)
            self._report_pending()
        for row_run, row_number, row in self._order.take(run, number, payload):
            if isinstance(row, MissingNumbers):
                self._report(NumbersMissing, run=row_run, first=row_number, count=row.count)
            elif isinstance(row, RejectedItem):
                self._report(SentRejected, run=row_run, number=row_number, **asdict(row))
            else:
                self._use(row)

    def _reject_unnumbered(self, item: object) -> None:
        """Reject a row of another wearer or without valid run and number."""
        reason = SentRejection.NOT_SENT
        if isinstance(item, Unreadable):
            reason, detail = SentRejection.UNREADABLE, "a row that cannot be read"
            detail = item.what if isinstance(item.what, str) else detail
        elif not isinstance(item, Sent):
            detail = f"a {type(item).__name__}, not a Sent"
        elif item.wearer != self._wearer:
            detail = "of another wearer"
        else:
            detail = "run and number are whole numbers from 0 to 2**53 - 1"
        self._report(SentRejected, reason=reason, detail=detail[:MAX_DETAIL_LENGTH])

    def _use(self, payload: Packet | Tick | End) -> None:
        """Feed the payload of a row that is in its turn to the session."""
        session, self._packed = self._session, None
        try:
            if session is None and not isinstance(payload, End):
                session = self._session = self._start_session()
            if session is None:
                return
            match payload:
                case Packet():
                    events = session.feed(payload)
                case Tick(t):
                    events = session.advance(t)
                case End():
                    events = session.finish()
        except MemoryError:
            raise
        except Exception as error:  # raised by a part of the app's own: it must not stop the other wearers
            self._drop_session()
            self._report(WearerFailed, detail=_describe(error))
            return
        for event in events:
            self._emit(event)
        if isinstance(payload, End):
            self._drop_session()

    def _start_session(self) -> Session:
        try:
            return self._fleet.make_session(self._wearer)
        except MemoryError:
            raise
        except Exception as error:  # raised for this wearer's calibration
            self._report(WearerFailed, detail=_describe(error))
            return self._fleet.make_session(self._wearer, calibrated=False)

    def _drop_session(self) -> None:
        self._known_at, self._session = self._now(), None

    def _now(self) -> float:
        """Return the newest known time, s, packets' clock; 0 before the first."""
        now = None if self._session is None else self._session.now
        return self._known_at if now is None else max(self._known_at, now)

    def _report(self, kind: Callable[..., FleetEvent], **fields: object) -> None:
        """Emit an event of the fleet itself."""
        now = self._now()
        self._emit(kind(t=now, known_at=now, **fields))

    def _report_pending(self) -> None:
        if self._pending is not None:
            kind, detail = self._pending
            self._pending = self._opened_state = None
            self._report(kind, detail=detail)

    def _emit(self, event: Event | FleetEvent) -> None:
        self._emitted.append(NumberedEvent(self._wearer, self._next_event, event))
        self._next_event += 1


def first_event_number(run: int, number: int) -> int:
    """Return the number of the first event after an unreadable state.

    `run` and `number` are those of the next row. The result is larger than all numbers used before (protocol/fleet.md).
    """
    return EVENTS_PER_ROW * (run + number + 1)


def _is_count(value: object) -> TypeGuard[int]:
    return type(value) is int and 0 <= value <= MAX_COUNT


def _describe(error: Exception) -> str:
    """Return class and text of an exception; the class alone when its `__str__` raises."""
    try:
        text = str(error)
    except Exception:
        text = ""
    return f"{type(error).__name__}: {text}"[:MAX_DETAIL_LENGTH] if text else type(error).__name__[:MAX_DETAIL_LENGTH]
