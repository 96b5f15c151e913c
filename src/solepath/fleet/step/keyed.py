"""One wearer of a fleet in memory: a session, the order of what is sent to it, and the numbers of what it says."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from ...events import Event
from ...events.fleet import FleetEvent, NumbersMissing, SentRejected, SentRejection, StateRejected, WearerFailed
from ...saving.codec import SnapshotError
from ...session import Session
from ...types import Packet
from .order import Missing, Order, RejectedItem, is_sound, sound
from .sent import LONGEST_DETAIL, MOST, End, NumberedEvent, Sent, Tick, Unreadable
from .sessions import Sessions
from .state import Identity, OtherState, StateError, read_identity, read_rest, write_state

_Kind = TypeVar("_Kind", NumbersMissing, SentRejected, StateRejected, WearerFailed)


class Keyed:
    """One wearer, for engines that keep objects between two snapshots; `Fleet.open` makes it.

    `feed` never raises, whatever phones sent, except MemoryError, after which this is to be thrown away: the last
    `state()` is good. What is fed in how many calls makes no difference, nor, where parts of the app's own can be saved
    at any moment (Fleet.step), how often `state()` is taken and opened.
    """

    __slots__ = ("_known", "_numbered", "_opened", "_order", "_pending", "_session", "_sessions", "_told", "_wearer")

    def __init__(self, sessions: Sessions, wearer: str, state: bytes | None) -> None:
        self._sessions, self._wearer = sessions, wearer
        self._order = Order(sessions.window)
        self._session: Session | None = None
        self._told, self._known = 0, 0.0
        self._pending: tuple[type[StateRejected | WearerFailed], str] | None = None
        """What is to be told before anything else."""
        self._opened: bytes | None = None
        """The state that brought that, until it is told."""
        self._numbered = True
        """False where not even the numbers could be read, until something comes that has one."""
        if state is not None:
            if not isinstance(state, bytes | bytearray | memoryview):
                raise TypeError(f"a state is bytes, or None for a new wearer, not a {type(state).__name__}")
            self._open(bytes(state))

    @property
    def ended(self) -> bool:
        """The wearer has taken the sensors off, and nothing came since that begins anew."""
        return self._order.ended

    def feed(self, sent: Iterable[Sent | Unreadable]) -> list[NumberedEvent]:
        """What the wearer's session, and the fleet, say to what was sent. Latency: none for what comes in its turn."""
        told: list[NumberedEvent] = []
        if self._pending is not None and self._numbered:
            self._tell_pending(told)
        for item in sent:
            if type(item) is Sent and self._is_simply_next(item):
                self._order.next += 1
                self._use(item.what, told)
            else:
                self._sort(item, told)
        return told

    def state(self) -> bytes:
        """All of it, to go on with `Fleet.open` or `Fleet.step`, elsewhere or later."""
        if self._opened is not None:
            return self._opened
        order, session, known, failure = self._order, None, self._known, ""
        if self._session is not None:
            known = self._now()
            try:
                session = self._session.pack()
            except MemoryError:
                raise
            except Exception as error:  # of a part of the app's own
                self._session, self._known = None, known
                self._pending = (WearerFailed, _said(error))
        if self._pending is not None:
            failure = self._pending[1]
        rest = OtherState(order.ended, order.left, order.strays, order.held, failure, session)
        return write_state(Identity(order.run, order.next, self._told, known), rest)

    def _open(self, state: bytes) -> None:
        identity = read_identity(state)
        if identity is None:
            self._pending, self._opened = (StateRejected, "nothing of the state can be read"), state
            self._numbered = False
            return
        window, self._told, self._known = self._sessions.window, identity.told, identity.known
        self._order = Order(window, identity.run, identity.next)
        try:
            rest = read_rest(state)
            placed = (identity.run, identity.next, rest.ended, rest.held, rest.left, rest.strays)
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
            self._pending = (WearerFailed, _said(error))
        if self._pending is not None:
            self._opened = state

    def _is_simply_next(self, sent: Sent) -> bool:
        """A packet as it must be, in its turn, with nothing held that would pass after it: nearly all are."""
        order, what = self._order, sent.what
        return (
            type(sent.number) is int
            and sent.number == order.next
            and type(sent.run) is int
            and sent.run == order.run
            and not order.held
            and not order.strays.straight
            and not order.ended
            and sent.number <= MOST
            and type(sent.wearer) is str
            and sent.wearer == self._wearer
            and type(what) is Packet
            and is_sound(what)
        )

    def _sort(self, item: object, told: list[NumberedEvent]) -> None:
        """Whatever does not simply pass."""
        wrong = self._unnumbered(item)
        if wrong is not None:
            if self._numbered:
                self._tell(told, wrong)
            return
        if isinstance(item, Sent):
            run, number, what = item.run, item.number, sound(item.what)
        elif isinstance(item, Unreadable) and item.number is not None:
            run, number, what = (
                item.run,
                item.number,
                RejectedItem(SentRejection.UNREADABLE, item.what[:LONGEST_DETAIL]),
            )
        else:
            return
        if not self._numbered:
            self._numbered, self._told = True, first_number(run, number)
            self._tell_pending(told)
        for of_run, at, passed in self._order.take(run, number, what):
            if isinstance(passed, Missing):
                self._tell(told, self._event(NumbersMissing, run=of_run, first=at, count=passed.count))
            elif isinstance(passed, RejectedItem):
                why = {"reason": passed.reason, "count": passed.count, "detail": passed.detail}
                self._tell(told, self._event(SentRejected, run=of_run, number=at, **why))
            else:
                self._use(passed, told)

    def _unnumbered(self, item: object) -> SentRejected | None:
        """What is to be said of what has no place in the order; None where it has one."""
        if isinstance(item, Unreadable):
            if _counts(item.number) and _counts(item.run) and isinstance(item.what, str):
                return None
            detail = item.what if isinstance(item.what, str) else "a row that cannot be read"
            return self._event(SentRejected, reason=SentRejection.UNREADABLE, detail=detail[:LONGEST_DETAIL])
        if not isinstance(item, Sent):
            detail = f"a {type(item).__name__}, not a Sent"
        elif not isinstance(item.wearer, str) or item.wearer != self._wearer:
            detail = "of another wearer"
        elif not _counts(item.run) or not _counts(item.number):
            detail = "run and number are whole numbers from 0 to 2**53 - 1"
        else:
            return None
        return self._event(SentRejected, reason=SentRejection.NOT_SENT, detail=detail[:LONGEST_DETAIL])

    def _use(self, what: Packet | Tick | End, told: list[NumberedEvent]) -> None:
        """What is in its turn goes to the session."""
        session = self._session
        try:
            if session is None and type(what) is not End:
                session = self._session = self._begin(told)
            if session is None:
                return
            if type(what) is Packet:
                events = session.feed(what)
            else:
                events = session.advance(what.t) if isinstance(what, Tick) else session.finish()
        except MemoryError:
            raise
        except Exception as error:  # of a part of the app's own: it must not stop the others
            self._drop()
            self._tell(told, self._event(WearerFailed, detail=_said(error)))
            return
        for event in events:
            self._tell(told, event)
        if type(what) is End:
            self._drop()

    def _begin(self, told: list[NumberedEvent]) -> Session:
        try:
            return self._sessions.fresh(self._wearer)
        except MemoryError:
            raise
        except Exception as error:  # of what is known of this wearer
            self._tell(told, self._event(WearerFailed, detail=_said(error)))
            return self._sessions.fresh(self._wearer, calibrated=False)

    def _drop(self) -> None:
        self._known, self._session = self._now(), None

    def _now(self) -> float:
        """The newest moment that anything is known of, s; 0 before any."""
        now = None if self._session is None else self._session.now
        return self._known if now is None else max(self._known, now)

    def _event(self, kind: Callable[..., _Kind], **fields: object) -> _Kind:
        now = self._now()
        return kind(t=now, known_at=now, **fields)

    def _tell(self, told: list[NumberedEvent], event: Event | FleetEvent) -> None:
        told.append(NumberedEvent(self._wearer, self._told, event))
        self._told += 1

    def _tell_pending(self, told: list[NumberedEvent]) -> None:
        if self._pending is not None:
            kind, detail = self._pending
            self._pending = self._opened = None
            now = self._now()
            self._tell(told, kind(t=now, known_at=now, detail=detail))


def first_number(run: int, number: int) -> int:
    """The number of the first event where nothing of the state can be read and this is what comes next: beyond all that
    were used, as protocol/fleet.md has it."""
    return 64 * (run + number + 1)


def _counts(value: object) -> bool:
    return type(value) is int and 0 <= value <= MOST


def _said(error: Exception) -> str:
    """What an exception says; an app's own may not even be able to say it."""
    try:
        said = str(error)
    except Exception:
        said = ""
    return f"{type(error).__name__}: {said}"[:LONGEST_DETAIL] if said else type(error).__name__[:LONGEST_DETAIL]
