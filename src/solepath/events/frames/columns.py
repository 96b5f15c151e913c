"""Columns of a table of records: which a class has, by the annotations of its fields, and their values."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from enum import Enum
from functools import cache
from operator import attrgetter, itemgetter
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

import attrs

from ...types import Sample, Site
from ...types.attrs import fields, frozen
from ..happening import FIRST_KEYS, Happening, json_ready
from .forms import Form, TableColumn, ValueKind
from .units import UNITS

Extract = Callable[[list[Any]], list[Any]]
"""A function that takes the records of one class and returns one value of each."""

RENAMED = {
    ("DefectFound", "sigma"): "offset_sigma",
    ("FootMoved", "phase"): "phase_name",
    ("Placed", "level"): "level_name",
    ("PositionReported", "level"): "level_name",
    ("TurnMade", "turn"): "turn_name",
}
"""Names of columns, by event and field, where another event has a field of this name with another kind or unit."""
AXES = {2: ("x", "y"), 3: ("x", "y", "z"), 4: ("w", "x", "y", "z"), 6: ("xx", "xy", "xz", "yy", "yz", "zz")}
"""Components of a tuple of so many floats: vectors, a quaternion, and a symmetric matrix."""
NO_AXES = {"north": ("", "sigma")}
"""Components of a pair that is no vector: a value, whose column has the field's name, and its standard deviation."""
SCALARS = {float: ValueKind.FLOAT, int: ValueKind.INT, bool: ValueKind.BOOL, str: ValueKind.TEXT}
"""Kinds of values that a column holds as they are, by their annotation."""


@frozen
class ColumnTable:
    """A table of columns that other libraries read through the Arrow PyCapsule interface.

    `pyarrow.table(table)`, `polars.DataFrame(table)` and `pandas.DataFrame.from_arrow(table)` take it as it is, without
    a package of Arrow on this side. The metadata "unit" of each field of Arrow is the unit of its column."""

    columns: tuple[TableColumn, ...]
    rows: int
    """Number of rows."""

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column that has one, by the column's name."""
        return {column.name: column.unit for column in self.columns if column.unit is not None}

    def __len__(self) -> int:
        return self.rows

    def __arrow_c_schema__(self) -> object:
        """Return the types of the columns in a capsule named "arrow_schema"."""
        from .arrow import schema_capsule
        from .nodes import node_of

        return schema_capsule(node_of(self.columns, self.rows))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Return the table as one batch in a capsule named "arrow_array_stream"; other types are not made on request.

        The protocol lets a producer ignore `requested_schema`, so that the reader converts the columns itself."""
        from .arrow import stream_capsule
        from .nodes import node_of

        return stream_capsule(node_of(self.columns, self.rows))


def table_of(records: Iterable[Any], of: type[Any] | None = None) -> ColumnTable:
    """Return a table of events or samples; with `of`, only of those of that class, with all of its columns."""
    groups: dict[Any, tuple[list[int], list[Any]]] = {} if of is None else {of: ([], [])}
    count = 0
    for record in records:
        if of is None or isinstance(record, of):
            rows, members = groups.setdefault(type(record), ([], []))
            rows.append(count)
            members.append(record)
            count += 1
    columns: dict[str, TableColumn] = {}
    for cls, (rows, members) in groups.items():
        for name, form, unit, extract in _columns_of(cls):
            column = columns.get(name)
            if column is None:
                column = columns[name] = TableColumn(name, form, unit, [None] * count)
            elif column.form != form:
                column = columns[name] = TableColumn(
                    name, Form(ValueKind.TEXT), None, [_text(each) for each in column.values]
                )
            elif column.unit != unit:
                column = columns[name] = TableColumn(name, form, None, column.values)
            values = extract(members)
            if column.form != form:
                values = list(map(_text, values))
            if len(rows) == count:
                column.values[:] = values
            else:
                for row, value in zip(rows, values, strict=True):
                    column.values[row] = value
    first = [columns.pop(name) for name in ("event", *FIRST_KEYS) if name in columns]
    return ColumnTable((*first, *columns.values()), count)


@cache
def _columns_of(cls: Any) -> tuple[tuple[str, Form, str | None, Extract], ...]:
    """Return name, form, unit and way to the values of each column of a class of records."""
    if not (isinstance(cls, type) and issubclass(cls, Happening | Sample)):
        raise TypeError(f"to_frame takes events and samples, not {getattr(cls, '__name__', cls)}")
    found = list(_fields_of(cls, cls.__name__, "", lambda members: members))
    if issubclass(cls, Happening):
        found.append(("event", Form(ValueKind.TEXT), None, lambda members: [cls.__name__] * len(members)))
    names = [one.name for one in fields(cls)]
    if "site" in names and "foot" not in names:
        found.append(("foot", Form(ValueKind.TEXT), None, lambda members: [_foot(each.site) for each in members]))
    return tuple(found)


def _foot(site: Site | None) -> str | None:
    return None if site is None or site.foot is None else str(site.foot.value)


def _fields_of(
    cls: type[Any], owner: str, prefix: str, members: Extract
) -> Iterator[tuple[str, Form, str | None, Extract]]:
    hints = get_type_hints(cls)
    is_own = cls.__module__.partition(".")[0] == Happening.__module__.partition(".")[0]  # else an app's, in any units
    for one in fields(cls):
        name = prefix + RENAMED.get((owner, one.name), one.name)
        hint = _without_none(hints[one.name])
        values = _then(members, attrgetter(one.name))
        unit = UNITS.get(name) if is_own or one.name in FIRST_KEYS else None
        arguments = get_args(hint)
        if attrs.has(hint):
            yield from _fields_of(hint, owner, f"{name}_", values)
        elif get_origin(hint) is tuple and set(arguments) == {float} and len(arguments) in AXES:
            for place, axis in enumerate(NO_AXES.get(name, AXES[len(arguments)])):
                yield f"{name}_{axis}".rstrip("_"), Form(ValueKind.FLOAT), unit, _then(values, itemgetter(place))
        else:
            form, plain = _form(hint)
            yield name, form, unit, values if plain is None else _then(values, plain)


def _without_none(hint: Any) -> Any:
    """Return the annotation without None, or `object` for a union of several types."""
    arguments = get_args(hint)
    if NoneType not in arguments:
        return hint
    others = [each for each in arguments if each is not NoneType]
    return others[0] if len(others) == 1 else object


def _then(values: Extract, get: Callable[[Any], Any]) -> Extract:
    """Return the way that goes on from each value that is not None."""
    return lambda members: [None if value is None else get(value) for value in values(members)]


def _form(hint: Any) -> tuple[Form, Callable[[Any], Any] | None]:
    """Return the form of a value with this annotation, and what makes plain data of it; None if it is plain.

    What no table has, a dict or a value of any class, becomes a text of JSON."""
    hint = _without_none(hint)
    if kind := SCALARS.get(hint):
        return Form(kind), None
    if isinstance(hint, type) and issubclass(hint, Enum):
        return Form(ValueKind.TEXT), lambda member: str(member.value)
    if attrs.has(hint):
        hints = get_type_hints(hint)
        inner = {one.name: _form(hints[one.name]) for one in fields(hint)}
        gets = [(name, _plain(hints[name])) for name in inner]
        return Form(ValueKind.RECORD, tuple([(name, form) for name, (form, _) in inner.items()])), lambda record: {
            name: plain(getattr(record, name)) if plain else getattr(record, name) for name, plain in gets
        }
    arguments = {each for each in get_args(hint) if each is not Ellipsis}
    if get_origin(hint) in (tuple, list) and len(arguments) == 1:
        item = arguments.pop()
        plain = _plain(item)
        return Form(ValueKind.LIST, (("item", _form(item)[0]),)), list if plain is None else lambda each: [
            *map(plain, each)
        ]
    return Form(ValueKind.TEXT), _text


def _plain(hint: Any) -> Callable[[Any], Any] | None:
    """Return what makes plain data of a value within another, which may be None if its annotation says so."""
    plain = _form(hint)[1]
    if plain is None or NoneType not in get_args(hint):
        return plain
    return lambda value: None if value is None else plain(value)


def _text(value: Any) -> str | None:
    return value if value is None or isinstance(value, str) else json.dumps(json_ready(value))
