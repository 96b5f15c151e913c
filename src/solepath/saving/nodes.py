"""What a schema is made of: one node for every kind of value that a field may hold (schema.py)."""

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
    """None, or what is in it."""

    of: Node


@frozen(eq=False)
class TupleNode:
    """A tuple of as many items as there are types."""

    items: tuple[Node, ...]


@frozen(eq=False)
class RowNode:
    """A tuple, list or deque of any length."""

    kind: type
    of: Node


@frozen(eq=False)
class DictNode:
    """A dict."""

    key: Node
    of: Node


@frozen(eq=False)
class OpenNode:
    """A record of one of several classes."""

    known: dict[str, type]
    """By name."""
    others: bool
    """Records of classes that are not known here may stand there too."""
    made: bool
    """As in `RecordNode`; what is not known here and has no state is whole all the same."""


@frozen(eq=False)
class RecordNode:
    """A record of one class."""

    cls: type
    made: bool
    """Its holder makes it again with its settings, so its state alone is in the fields."""
    fields: dict[str, Node]
    """Those that are saved, in the order of the class."""
    defaults: dict[str, Any]
    """Default of fields that are not saved; of what is made again it is not used."""


Node = ScalarNode | EnumNode | MaybeNode | TupleNode | RowNode | DictNode | OpenNode | RecordNode
