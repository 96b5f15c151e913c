"""Nodes of a schema: a class for each kind of value that a field may have (schema.py)."""

from __future__ import annotations

from enum import Enum
from typing import Any

from ..types.attrs import frozen


@frozen(eq=False)
class ScalarNode:
    """A float, int, bool, str or bytes."""

    kind: type
    row_size: int = 1
    """Size of the rows, in bytes, of which bytes hold a whole number."""


@frozen(eq=False)
class EnumNode:
    """A member of an enum."""

    cls: type[Enum]


@frozen(eq=False)
class MaybeNode:
    """None, or a value of the node `of`."""

    of: Node


@frozen(eq=False)
class TupleNode:
    """A tuple, which `make` makes of a list of its items, with one node for each item."""

    items: tuple[Node, ...]
    make: Any = tuple


@frozen(eq=False)
class SequenceNode:
    """A tuple, list or deque (`kind`) of any length, whose items have the node `of`."""

    kind: type
    of: Node


@frozen(eq=False)
class DictNode:
    """A dict or Counter (`kind`); keys have the node `key`, values the node `of`."""

    key: Node
    of: Node
    kind: type = dict

    @property
    def has_text_keys(self) -> bool:
        """True if the keys become strings, so that the dict becomes an object of JSON."""
        return isinstance(self.key, EnumNode) or (isinstance(self.key, ScalarNode) and self.key.kind is str)


@frozen(eq=False)
class OpenNode:
    """A record of one of several classes."""

    known: dict[str, type]
    """Classes by name."""
    others: bool
    """True if records of other classes are allowed too."""
    made: bool
    """True as in `RecordNode`; even then, a record of another class without state is saved with all fields."""


@frozen(eq=False)
class RecordNode:
    """A record of one class."""

    cls: type
    made: bool
    """True if the holder makes the record again with the same settings, so that `fields` has only the state."""
    fields: dict[str, Node]
    """Nodes of the saved fields, in the order of the class."""
    defaults: dict[str, Any]
    """Defaults of the fields that are not saved; unused for a record that is made again, which has its own values."""


Node = ScalarNode | EnumNode | MaybeNode | TupleNode | SequenceNode | DictNode | OpenNode | RecordNode
