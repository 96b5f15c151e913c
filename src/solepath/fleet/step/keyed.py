"""One wearer of a fleet in memory: a session, the order of its input, and the numbers of its events."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from ...events import Event
from ...events.fleet import FleetEvent, NumbersMissing, SentRejected, SentRejection, StateRejected, WearerFailed
from ...saving.codec import SnapshotError
from ...session import Session
from ...types import Packet
from .order import Missing, Order, RejectedItem, check_payload, is_valid
from .sent import LONGEST_DETAIL, MOST, End, NumberedEvent, Sent, Tick, Unreadable
from .sessions import Sessions
from .state import Identity, OtherState, StateError, read_identity, read_rest, write_state

_Kind = TypeVar("_Kind", NumbersMissing, SentRejected, StateRejected, WearerFailed)


class Keyed:
    """One wearer, for engines that keep objects between two snapshots; made by `Fleet.open`.

    `feed` never raises, whatever phones sent, except MemoryError, after which this object must be discarded: the last
    `state()` is good. The number of calls that the input is cut into makes no difference, nor does, if parts of the
    app's own can be saved at any moment (Fleet.step), the number of times that `state()` is taken and opened."""

    __slots__ = (
        "_known_at",
        "_numbered",
        "_opened_state",
        "_order",
        "_pending",
        "_session",
        "_sessions",
        "_next_event",
        "_wearer",
    )

    def __init__(self, sessions: Sessions, wearer: str, state: bytes | None) -> None:
        self._sessions, self._wearer = sessions, wearer
        self._order = Order(sessions.window)
        self._session: Session | None = None
        self._next_event, self._known_at = 0, 0.0
        self._pending: tuple[type[StateRejected | WearerFailed], str] | None = None
        """The failure of the state or session that is reported before anything else."""
        self._opened_state: bytes | None = None
        """The state that caused the pending failure, until it is reported."""
        self._numbered = True
        """False if not even the numbers of the state could be read, until a numbered row comes."""
        if state is not None:
            if not isinstance(state, bytes | bytearray | memoryview):
                raise TypeError(f"a state is bytes, or None for a new wearer, not a {type(state).__name__}")
            self._open(bytes(state))

    @property
    def ended(self) -> bool:
        """True if the wearer has taken the sensors off, and nothing came since that starts a session."""
        return self._order.ended

    def feed(self, sent: Iterable[Sent | Unreadable]) -> list[NumberedEvent]:
        """Return the events of the wearer's session and of the fleet for what was sent.

        Latency: none for rows that come in their turn."""
        emitted: list[NumberedEvent] = []
        if self._pending is not None and self._numbered:
            self._emit_pending(emitted)
        for item in sent:
            if type(item) is Sent and self._is_next_packet(item):
                self._order.next += 1
                self._use(item.what, emitted)
            else:
                self._use_in_order(item, emitted)
        return emitted

    def state(self) -> bytes:
        """Return the whole state, to continue with `Fleet.open` or `Fleet.step`, elsewhere or later."""
        if self._opened_state is not None:
            return self._opened_state
        order, session, known, failure = self._order, None, self._known_at, ""
        if self._session is not None:
            known = self._now()
            try:
                session = self._session.pack()
            except MemoryError:
                raise
            except Exception as error:  # of a part of the app's own
                self._session, self._known_at = None, known
                self._pending = (WearerFailed, _describe(error))
        if self._pending is not None:
            failure = self._pending[1]
        rest = OtherState(order.ended, order.unused, order.strays, order.held, failure, session)
        return write_state(Identity(order.run, order.next, self._next_event, known), rest)

    def _open(self, state: bytes) -> None:
        identity = read_identity(state)
        if identity is None:
            self._pending, self._opened_state = (StateRejected, "nothing of the state can be read"), state
            self._numbered = False
            return
        window, self._next_event, self._known_at = self._sessions.window, identity.next_event, identity.known
        self._order = Order(window, identity.run, identity.next)
        try:
            rest = read_rest(state)
            placed = (identity.run, identity.next, rest.ended, rest.held, rest.unused, rest.strays)
            self._order = Order(window, *placed)
            if rest.failure:
                self._pending = (WearerFailed, rest.failure)
            elif rest.session is not None:
                self._session = self._sessions.unpack(rest.session)
        except (StateError, SnapshotError) as error:
            self._pending = (StateRejected, str(error)[:LONGEST_DETAIL])
        except MemoryError:
            raise
        except Exception as error:  # of a part of the app's own
            self._pending = (WearerFailed, _describe(error))
        if self._pending is not None:
            self._opened_state = state

    def _is_next_packet(self, sent: Sent) -> bool:
        """Return whether this is a valid packet in its turn with nothing held behind it, as nearly all are."""
        order, what = self._order, sent.what
        return (
            type(sent.number) is int
            and sent.number == order.next
            and type(sent.run) is int
            and sent.run == order.run
            and not order.held
            and not order.strays.consecutive
            and not order.ended
            and sent.number <= MOST
            and type(sent.wearer) is str
            and sent.wearer == self._wearer
            and type(what) is Packet
            and is_valid(what)
        )

    def _use_in_order(self, item: object, emitted: list[NumberedEvent]) -> None:
        """Use a row that is not simply the next packet."""
        rejection = self._reject_unnumbered(item)
        if rejection is not None:
            if self._numbered:
                self._emit(emitted, rejection)
            return
        if isinstance(item, Sent):
            run, number, what = item.run, item.number, check_payload(item.what)
        elif isinstance(item, Unreadable) and item.number is not None:
            run, number, what = (
                item.run,
                item.number,
                RejectedItem(SentRejection.UNREADABLE, item.what[:LONGEST_DETAIL]),
            )
        else:
            return
        if not self._numbered:
            self._numbered, self._next_event = True, first_number(run, number)
            self._emit_pending(emitted)
        for of_run, at, passed in self._order.take(run, number, what):
            if isinstance(passed, Missing):
                self._emit(emitted, self._event(NumbersMissing, run=of_run, first=at, count=passed.count))
            elif isinstance(passed, RejectedItem):
                why = {"reason": passed.reason, "count": passed.count, "detail": passed.detail}
                self._emit(emitted, self._event(SentRejected, run=of_run, number=at, **why))
            else:
                self._use(passed, emitted)

    def _reject_unnumbered(self, item: object) -> SentRejected | None:
        """Return the rejection of a row without a place in the order; None if it has a place."""
        if isinstance(item, Unreadable):
            if _is_count(item.number) and _is_count(item.run) and isinstance(item.what, str):
                return None
            detail = item.what if isinstance(item.what, str) else "a row that cannot be read"
            return self._event(SentRejected, reason=SentRejection.UNREADABLE, detail=detail[:LONGEST_DETAIL])
        if not isinstance(item, Sent):
            detail = f"a {type(item).__name__}, not a Sent"
        elif not isinstance(item.wearer, str) or item.wearer != self._wearer:
            detail = "of another wearer"
        elif not _is_count(item.run) or not _is_count(item.number):
            detail = "run and number are whole numbers from 0 to 2**53 - 1"
        else:
            return None
        return self._event(SentRejected, reason=SentRejection.NOT_SENT, detail=detail[:LONGEST_DETAIL])

    def _use(self, what: Packet | Tick | End, emitted: list[NumberedEvent]) -> None:
        """Feed a row that is in its turn to the session."""
        session = self._session
        try:
            if session is None and type(what) is not End:
                session = self._session = self._start_session(emitted)
            if session is None:
                return
            if type(what) is Packet:
                events = session.feed(what)
            else:
                events = session.advance(what.t) if isinstance(what, Tick) else session.finish()
        except MemoryError:
            raise
        except Exception as error:  # raised by a part of the app's own: it must not stop the other wearers
            self._drop_session()
            self._emit(emitted, self._event(WearerFailed, detail=_describe(error)))
            return
        for event in events:
            self._emit(emitted, event)
        if type(what) is End:
            self._drop_session()

    def _start_session(self, emitted: list[NumberedEvent]) -> Session:
        try:
            return self._sessions.make_session(self._wearer)
        except MemoryError:
            raise
        except Exception as error:  # raised for this wearer's calibration
            self._emit(emitted, self._event(WearerFailed, detail=_describe(error)))
            return self._sessions.make_session(self._wearer, calibrated=False)

    def _drop_session(self) -> None:
        self._known_at, self._session = self._now(), None

    def _now(self) -> float:
        """Return the newest time that is known, s; 0 before any."""
        now = None if self._session is None else self._session.now
        return self._known_at if now is None else max(self._known_at, now)

    def _event(self, kind: Callable[..., _Kind], **fields: object) -> _Kind:
        now = self._now()
        return kind(t=now, known_at=now, **fields)

    def _emit(self, emitted: list[NumberedEvent], event: Event | FleetEvent) -> None:
        emitted.append(NumberedEvent(self._wearer, self._next_event, event))
        self._next_event += 1

    def _emit_pending(self, emitted: list[NumberedEvent]) -> None:
        if self._pending is not None:
            kind, detail = self._pending
            self._pending = self._opened_state = None
            now = self._now()
            self._emit(emitted, kind(t=now, known_at=now, detail=detail))


def first_number(run: int, number: int) -> int:
    """Return the number of the first event after a state of which nothing can be read.

    `run` and `number` are those of the next row. The result is larger than all numbers used (protocol/fleet.md)."""
    return 64 * (run + number + 1)


def _is_count(value: object) -> bool:
    return type(value) is int and 0 <= value <= MOST


def _describe(error: Exception) -> str:
    """Return the text of an exception; the text of an app's own exception may itself raise."""
    try:
        text = str(error)
    except Exception:
        text = ""
    return f"{type(error).__name__}: {text}"[:LONGEST_DETAIL] if text else type(error).__name__[:LONGEST_DETAIL]
