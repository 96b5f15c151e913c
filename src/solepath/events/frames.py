"""Events and samples as tables of pandas, polars or Arrow: one row per record, with the units of the columns."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

import attrs

from ..types import Sample
from ..types.attrs import define, fields, frozen
from ..types.extras import install_hint
from .happening import FIRST_KEYS, BaseEvent, json_ready

_NAMES = {
    "s": "t known_at sampled_at t_start t_end t_toe_off t_heel_strike revises stride_time stance_time swing_time "
    "step_time initial_double_support terminal_double_support single_support offset offset_sigma duration silent_for "
    "seconds longest longest_gap double_support",
    "m": "height stride_length length_sigma own_length distance position by sigma compensation displacement length "
    "height_change features_clearance features_rise features_cop clearance rise centre spread height_off "
    "layout_length legs",
    "m^2": "covariance",
    "m/s": "error_index features_peak_speed features_error_index speed velocity",
    "m/s^2": "acc",
    "rad": "angle turn heading_change features_swing_pitch features_toe_off_angle features_heel_strike_angle "
    "toe_off_angle heel_strike_angle turning_angle heading_sigma north heading_off",
    "rad/s": "gyro",
    "1/min": "cadence",
    "Pa": "air_pressure",
    "T": "mag",
    "dBm": "signal",
    "N": "layout_scale",
    "1": "probability similarity coefficient phase level quat missing stance_share swing_share double_support_share "
    "single_support_share",
}
UNITS = {name: unit for unit, names in _NAMES.items() for name in names.split()}
"""Unit of each column that has one, by the column's name without its component; "1" for shares and unit quaternions.

A test compares them with the fields' docstrings. Loads of pressure cells (`pressure`, `values`, `force`,
`features_contact_load`, `layout_full_scale`) are in newtons or in counts of the device, as LayoutKnown says, so they
have no unit here."""
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
WHOLE = {float: "float64", int: "int64", bool: "bool"}
"""Types of pandas for columns without a missing value, and for all columns of floats, which have NaN instead."""
WITH_MISSING = {int: "Int64", bool: "boolean"}
"""Types of pandas for columns with a missing value."""
TYPES = {
    "polars": {float: "Float64", int: "Int64", bool: "Boolean", str: "String", list: "List", dict: "Struct"},
    "pyarrow": {float: "float64", int: "int64", bool: "bool_", str: "string", list: "list_", dict: "struct"},
}
"""Names of the types in the libraries that have types for lists and records."""


def to_frame(
    records: Iterable[BaseEvent | Sample],
    of: type[BaseEvent] | None = None,
    *,
    library: str | None = None,
    made_by: Mapping[str, Any] | None = None,
) -> Any:
    """Return a data frame with one row per event or sample, of pandas if that is installed, else of polars.

    `of` is a class of events, such as StrideTaken or GaitCycleMeasured: the frame then has only those events, and all
    columns of that class, also without a single row. `library` is "pandas", "polars" or "arrow"; a frame of "arrow" is
    a Table of pyarrow, which any library with the Arrow PyCapsule interface reads without a copy.

    The columns are the fields and what follows from them, in SI units, in the order of their first occurrence; an event
    has its class's name in the column `event`. A vector has one column for each component (position_x, position_y,
    position_z, m), and a record within an event one for each field (features_clearance, m). Any other tuple is one
    column of lists. A value that a record does not have is missing in its row. Four columns are not named as their
    fields, because another event has a value of another kind or unit in a field of that name: level_name, phase_name,
    turn_name and offset_sigma.

    Units are in `frame.attrs["units"]` of pandas, by column, and in the metadata "unit" of a field of Arrow. `made_by`,
    as `provenance` says it (saving/provenance.py), is in `frame.attrs["solepath"]` and in the metadata "solepath" of a
    table of Arrow, as JSON. Polars has no place for them. ImportError when the library is not installed."""
    columns = _columns(records, of)
    modules = {"pandas": "pandas", "polars": "polars", "arrow": "pyarrow"}
    if library is not None:
        if library not in modules:
            raise ValueError(f'library is "pandas", "polars" or "arrow", not {library!r}')
        modules = {library: modules[library]}
    names = [*modules.values()][:2]
    for name in names:
        try:
            module = import_module(name)
        except ImportError:
            continue
        return {"pandas": _pandas, "polars": _polars, "pyarrow": _pyarrow}[name](module, columns, made_by)
    hint = install_hint("frames") if "pandas" in names else f"pip install {names[0]}"
    raise ImportError(f"to_frame needs {' or '.join(names)}: {hint}")


def _pandas(pandas: Any, columns: list[Column], made_by: Mapping[str, Any] | None) -> Any:
    frame = pandas.DataFrame({column.name: _series(pandas, column) for column in columns})
    frame.attrs["units"] = {column.name: column.unit for column in columns if column.unit is not None}
    frame.attrs |= {} if made_by is None else {"solepath": dict(made_by)}
    return frame


def _series(pandas: Any, column: Column) -> Any:
    kinds = WHOLE if column.form.kind is float or None not in column.values else WITH_MISSING
    return pandas.Series(column.values, dtype=kinds.get(column.form.kind, "object"))


def _polars(polars: Any, columns: list[Column], _: Mapping[str, Any] | None) -> Any:
    return polars.DataFrame([polars.Series(one.name, one.values, _type(polars, one.form)) for one in columns])


def _pyarrow(pyarrow: Any, columns: list[Column], made_by: Mapping[str, Any] | None) -> Any:
    units = [{} if column.unit is None else {"unit": column.unit} for column in columns]
    kinds = [_type(pyarrow, column.form) for column in columns]
    rows = zip(columns, kinds, units, strict=True)
    found = [pyarrow.field(column.name, kind, metadata=unit) for column, kind, unit in rows]
    schema = pyarrow.schema(found, metadata=None if made_by is None else {"solepath": json.dumps(dict(made_by))})
    return pyarrow.table([column.values for column in columns], schema=schema)


def _type(module: Any, form: Form) -> Any:
    """Return the type of a library for values of this form."""
    make = getattr(module, TYPES[module.__name__][form.kind])
    inner = {name: _type(module, of) for name, of in form.inner}
    return make(inner) if form.kind is dict else make(*inner.values())


@frozen
class Form:
    """The type of a value: float, int, bool, str, or list or dict with the names and forms of what is inside of it."""

    kind: type
    inner: tuple[tuple[str, Form], ...] = ()


TEXT = Form(str)


@define
class Column:
    """One column of a table."""

    name: str
    form: Form
    unit: str | None
    """Unit of its numbers; None without one, "1" for shares."""
    values: list[Any]
    """One value per row; None where it is missing."""


def _columns(records: Iterable[Any], of: type[Any] | None) -> list[Column]:
    """Return the columns of events or samples; with `of`, only of those of that class, with all of its columns."""
    groups: dict[Any, dict[int, Any]] = {} if of is None else {of: {}}
    chosen = [record for record in records if of is None or isinstance(record, of)]
    for row, record in enumerate(chosen):
        groups.setdefault(type(record), {})[row] = record
    columns: dict[str, Column] = {}
    for cls, members in groups.items():
        for name, form, unit, path in _columns_of(cls):
            column = columns.setdefault(name, Column(name, form, unit, [None] * len(chosen)))
            if column.form != form:
                column.form, column.values = TEXT, [_plain(TEXT, value) for value in column.values]
            if column.form != form or column.unit != unit:
                column.unit = None
            for row, record in members.items():
                column.values[row] = _plain(column.form, _value(record, path))
    first = [columns.pop(name) for name in ("event", *FIRST_KEYS) if name in columns]
    return [*first, *columns.values()]


Path = tuple[str | int, ...]
"""Way from a record to a value: names of fields, and places in tuples."""


@cache
def _columns_of(cls: Any) -> list[tuple[str, Form, str | None, Path]]:
    """Return name, form, unit and way to the value of each column of a class of records."""
    if not (isinstance(cls, type) and issubclass(cls, BaseEvent | Sample)):
        raise TypeError(f"to_frame takes events and samples, not {getattr(cls, '__name__', cls)}")
    found = [*_fields_of(cls, cls.__name__, "", ())]
    if issubclass(cls, BaseEvent):
        found += _derived_of(cls)
        found.append(("event", TEXT, None, ("__class__", "__name__")))
    names = [one.name for one in fields(cls)]
    if "site" in names and "foot" not in names:
        found.append(("foot", TEXT, None, ("site", "foot")))
    return found


def _fields_of(cls: Any, owner: str, prefix: str, path: Path) -> Iterator[tuple[str, Form, str | None, Path]]:
    hints = get_type_hints(cls)
    is_own = cls.__module__.partition(".")[0] == __name__.partition(".")[0]  # else an app's, in any units
    for one in fields(cls):
        name = prefix + RENAMED.get((owner, one.name), one.name)
        hint, inner = _without_none(hints[one.name]), (*path, one.name)
        unit = UNITS.get(name) if is_own or one.name in FIRST_KEYS else None
        arguments = get_args(hint)
        if attrs.has(hint):
            yield from _fields_of(hint, owner, f"{name}_", inner)
        elif get_origin(hint) is tuple and {*arguments} == {float} and len(arguments) in AXES:
            for place, axis in enumerate(NO_AXES.get(name, AXES[len(arguments)])):
                yield f"{name}_{axis}".rstrip("_"), Form(float), unit, (*inner, place)
        else:
            yield name, _form(hint), unit, inner


def _derived_of(cls: type[BaseEvent]) -> Iterator[tuple[str, Form, str | None, Path]]:
    """Yield the columns of what an event derives from its fields: its properties."""
    properties = {name: one for base in cls.__mro__ for name, one in vars(base).items() if isinstance(one, property)}
    for name, one in properties.items():
        yield name, _form(get_type_hints(one.fget).get("return", object)), UNITS.get(name), (name,)


def _without_none(hint: Any) -> Any:
    """Return the annotation without None, or `object` for a union of several types."""
    others = [each for each in get_args(hint) if each is not NoneType]
    return hint if NoneType not in get_args(hint) else others[0] if len(others) == 1 else object


def _form(hint: Any) -> Form:
    """Return the form of a value with this annotation: what no table has, a dict or any class, becomes JSON text."""
    hint = _without_none(hint)
    if hint in WHOLE:
        return Form(hint)
    if attrs.has(hint):
        hints = get_type_hints(hint)
        return Form(dict, tuple([(one.name, _form(hints[one.name])) for one in fields(hint)]))
    arguments = {*get_args(hint)} - {...}
    if get_origin(hint) in (tuple, list) and len(arguments) == 1:
        return Form(list, (("item", _form(arguments.pop())),))
    return TEXT


def _value(record: Any, path: Path) -> Any:
    for key in path:
        if record is not None:
            record = record[key] if isinstance(key, int) else getattr(record, key)
    return record


def _plain(form: Form, value: Any) -> Any:
    """Return a value as plain data of this form."""
    if value is None or form.kind in WHOLE:
        return value
    if form.kind is list:
        return [_plain(form.inner[0][1], item) for item in value]
    if form.kind is dict:
        return {name: _plain(inner, getattr(value, name)) for name, inner in form.inner}
    plain = json_ready(value)
    return plain if isinstance(plain, str) else json.dumps(plain)
