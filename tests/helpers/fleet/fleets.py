"""Wearers of a fleet that tests share: walks as a phone sends them, and rows whose events show that they were used."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from itertools import pairwise

from attrs import evolve, frozen
from walks import LEFT, RIGHT, ROUGH, SHORT

from solepath import recipes
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.events import Event, PacketRejected
from solepath.fleet import End, Fleet, NumberedEvent, NumbersMissing, Sent, SentRejected, Unreadable
from solepath.session import Session
from solepath.types import Packet

WEARER = "w"
Item = Sent | Unreadable


@frozen
class Walked:
    """A walk as a phone sends it, and the events of a session without a fleet."""

    sent: tuple[Sent, ...]
    events: tuple[Event, ...]


@cache
def walked(recipe: str = "default") -> Walked:
    """Return a short walk with two insoles over a poor radio connection, with an End."""
    worn = Insole(cells=24, rate=50.0)
    packets = emulate(SHORT, devices={LEFT: worn, RIGHT: evolve(worn)}, radio=ROUGH, seed=7).packets
    session = Session(recipes.by_name(recipe))
    events = [event for packet in packets for event in session.feed(packet)] + session.finish()
    sent = [Sent(WEARER, number, packet) for number, packet in enumerate(packets)]
    return Walked((*sent, Sent(WEARER, len(sent), End())), tuple(events))


def shown(number: int, run: int = 0) -> Sent:
    """Return a row whose packet a session rejects in one event that names it, which shows that the row was used."""
    return Sent(WEARER, number, Packet(0.25 * number, LEFT, f"story/{run}-{number}", b""), run)


def stepped(
    fleet: Fleet, cuts: Iterable[Iterable[Item]], state: bytes | None = None
) -> tuple[bytes, list[NumberedEvent]]:
    """Return the events of `Fleet.step` for each piece, with the state passed on as bytes."""
    emitted: list[NumberedEvent] = []
    for piece in cuts:
        state, some = fleet.step(WEARER, state, piece)
        emitted += some
    return fleet.step(WEARER, state, [])[0], emitted


def cut(items: list[Item], at: Iterable[int]) -> list[list[Item]]:
    """The items in pieces that end at these places."""
    ends = sorted({0, len(items), *(place % (len(items) + 1) for place in at)})
    return [items[start:end] for start, end in pairwise(ends)]


def uses(emitted: Iterable[NumberedEvent]) -> list[tuple[str, int | None, int | None, object]]:
    """Return the outcome of rows that `shown` makes: (what, run, number, count or reason)."""
    found: list[tuple[str, int | None, int | None, object]] = []
    for one in emitted:
        match one.event:
            case PacketRejected(channel=channel):
                run, number = channel.removeprefix("story/").split("-")
                found.append(("used", int(run), int(number), None))
            case NumbersMissing(run=run, first=first, count=count):
                found.append(("missing", run, first, count))
            case SentRejected(run=run, number=number, reason=reason, count=count):
                found.append(("rejected", run, number, reason.value if count == 1 else (reason.value, count)))
            case other:
                raise AssertionError(f"{other} is told of no story")
    return found
