"""A reader and writer generated from a construct: one call of the module struct for a whole packet.

For every part that it reads, construct makes a stream, a context and a container, which takes five times as long as
reading the numbers. If the sizes in a packet follow from its header, all of its parts have one notation in `struct`,
which `flat_struct` derives from the construct. So the construct stays the only definition of the format."""

from __future__ import annotations

from struct import Struct as Packing
from typing import Any

from construct import Array, Container, FormatField, IfThenElse, Pass, Renamed, Sequence, Struct

from .cells import Packed12, packed_size
from .fields import Definition, Fields


def flat_struct(definition: Definition, **context: Any) -> Packing:
    """Return the struct of all numbers of `definition`, in order; a block of 12-bit values is one `bytes`.

    `context` has what the parts before are to have been parsed to, by their names, as in construct. TypeError for a
    construct without a notation in `struct`; ValueError if its numbers have different byte orders, or none."""
    notations = _notations(definition, Container(context))
    if any([notation[0] not in "<>" for notation in notations]):
        raise ValueError("a notation without its byte order")
    orders = {notation[0] for notation in notations if notation[1:].strip("0123456789bBs")}
    if len(orders) > 1:
        raise ValueError("numbers of different byte orders have no common notation")
    return Packing("".join([*(orders or "<"), *[notation[1:] for notation in notations]]))


def _in_context(number: Any, context: Container[Any]) -> int:
    return int(number(context) if callable(number) else number)


def _notations(definition: Any, context: Container[Any]) -> list[str]:
    """Return the notation of each part: its byte order, and its numbers."""
    if isinstance(definition, Renamed):
        return _notations(definition.subcon, context)
    if isinstance(definition, Fields):
        return [definition.notation]
    if isinstance(definition, FormatField):
        return [definition.fmtstr]
    if isinstance(definition, Packed12):
        return [f"<{packed_size(definition.count(context))}s"]
    if isinstance(definition, Array):
        return _in_context(definition.count, context) * _notations(definition.subcon, context)
    if isinstance(definition, IfThenElse):
        chosen = definition.thensubcon if _in_context(definition.condfunc, context) else definition.elsesubcon
        return [] if chosen is Pass else _notations(chosen, context)
    if isinstance(definition, (Struct, Sequence)):
        within = Container(context, _=context)
        return [notation for part in definition.subcons for notation in _notations(part, within)]
    raise TypeError(f"{type(definition).__name__} has no notation in struct")
