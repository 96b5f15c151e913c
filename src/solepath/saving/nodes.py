"""Nodes of a schema: one class for every kind of value that a field may hold (schema.py)."""

from __future__ import annotations

from enum import Enum
from typing import Any

from ..types.attrs import frozen


@frozen(eq=False)
class ScalarNode:
    """A float, int, bool, str or bytes."""

    kind: type


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
    """A tuple with one node for each item."""

    items: tuple[Node, ...]


@frozen(eq=False)
class RowNode:
    """A tuple, list or deque of any length."""

    kind: type
    of: Node


@frozen(eq=False)
class DictNode:
    """A dict of keys and values of two kinds."""

    key: Node
    of: Node


@frozen(eq=False)
class OpenNode:
    """A record of one of several classes."""

    known: dict[str, type]
    """Classes by name."""
    others: bool
    """True if records of other classes are allowed too."""
    made: bool
    """Like `RecordNode.made`; a record of an unknown class without state is whole all the same."""


@frozen(eq=False)
class RecordNode:
    """A record of one class."""

    cls: type
    made: bool
    """True if its holder makes it again with its settings, so that `fields` holds its state alone."""
    fields: dict[str, Node]
    """Nodes of the saved fields, in the order of the class."""
    defaults: dict[str, Any]
    """Defaults of the fields that are not saved; unused for a record that is made again."""


Node = ScalarNode | EnumNode | MaybeNode | TupleNode | RowNode | DictNode | OpenNode | RecordNode
