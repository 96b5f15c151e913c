"""The types of columns, and a column with its values."""

from __future__ import annotations

from enum import Enum
from typing import Any

from ...types.attrs import frozen


class ValueKind(Enum):
    """The type of the values of a column."""

    FLOAT = "float"
    INT = "int"
    BOOL = "bool"
    TEXT = "text"
    LIST = "list"
    RECORD = "record"


@frozen
class Form:
    """The type of a value, with the types of what is inside of it."""

    kind: ValueKind
    inner: tuple[tuple[str, Form], ...] = ()
    """Names and forms of the fields of a record; of the items of a list, with the name "item"."""


@frozen
class TableColumn:
    """One column of a table."""

    name: str
    form: Form
    unit: str | None
    """Unit of its numbers; None without one, "1" for shares."""
    values: list[Any]
    """One value per row; None where it is missing."""

    @property
    def kind(self) -> ValueKind:
        """Type of the values."""
        return self.form.kind
