"""The decorators `define`, `frozen` and `stateful` of all classes of solepath: those of attrs, but faster to import.

`stateful` is `define` for a class with state: each field with a default is state, which no constructor takes, but
`settings`. mypy sees the same constructor: it takes what is a `field` there, and neither what has a plain default nor
what is a `state`, which is a `field` at run time. A class from which others with settings of their own derive is made
by `define`.

attrs writes and compiles `__repr__`, `__eq__` and `__hash__` of every class when its module is imported. This takes
three fifths of the time to create a class, and took a third of the time of `import solepath`. Here all classes share
one function for each of the three, which reads the fields when it is called. The results are those of attrs. Comparing
and printing are slower, but no code that runs per sample needs them. `python tests/bench/way.py` prints the time of an
import."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import attrs
from attrs import astuple, evolve, field, fields

# saving/schema.py reads these marks of fields
NOT_SAVED = {"saving": "not saved"}
"""Mark of a field that is in no snapshot and no packed state, so that it has its default after loading."""
MADE_AGAIN = {"saving": "made again"}
"""Mark of a field of state whose parts are created again by the object that has the field."""
ROW_SIZE = "row size"
"""Key of the metadata of a field of bytes or `Doubles` that holds whole rows; its value is the size of a row."""
# types/checking.py reads these
LIMITS = "limits"
"""Key of the metadata of a field: smallest and largest number in its value, and their unit."""
COUNT = "count"
"""Key of the metadata of a field with a tuple or dict: smallest and largest number of values in it."""


def limits(least: float, most: float, unit: str = "") -> dict[str, Any]:
    """Return the metadata of a field whose numbers can be from `least` to `most`."""
    return {LIMITS: (least, most, unit)}


def limited(default: Any, least: float, most: float, unit: str = "") -> Any:
    """Return a field with this default, whose numbers can be from `least` to `most`."""
    return field(default=default, metadata=limits(least, most, unit))


if TYPE_CHECKING:
    from collections.abc import Callable

    from attr import s as stateful
    from attrs import define, frozen

    _Value = TypeVar("_Value")

    def state(*, default: _Value = ..., factory: Callable[[], _Value] = ..., **options: Any) -> _Value:
        """Return a field of state, of a class made by `stateful`."""
        raise NotImplementedError

else:

    def _repr(self: Any) -> str:
        """Return `Name(field=value, ...)`, as attrs prints it."""
        shown = [(attribute, getattr(self, attribute.name)) for attribute in fields(type(self)) if attribute.repr]
        texts = [
            f"{attribute.name}={repr(value) if attribute.repr is True else attribute.repr(value)}"
            for attribute, value in shown
        ]
        return f"{type(self).__qualname__.rpartition('>.')[2]}({', '.join(texts)})"

    def _eq(self: Any, other: Any) -> bool:
        """Return whether both are of one class and each field of one equals that of the other."""
        if other.__class__ is not self.__class__:
            return NotImplemented
        return all(
            getattr(self, attribute.name) == getattr(other, attribute.name)
            for attribute in fields(type(self))
            if attribute.eq
        )

    def _hash(self: Any) -> int:
        """Return the hash of the fields that are compared."""
        return hash((type(self), *(getattr(self, attribute.name) for attribute in fields(type(self)) if attribute.eq)))

    def _decorate(cls: type | None = None, *, attrs_decorator: Any, hashed: bool, **options: Any) -> Any:
        if cls is None:
            return partial(_decorate, attrs_decorator=attrs_decorator, hashed=hashed, **options)
        namespace = vars(cls)
        if options.pop("repr", "__repr__" not in namespace):
            cls.__repr__ = _repr
        if options.pop("eq", "__eq__" not in namespace):
            cls.__eq__ = _eq
            cls.__hash__ = _hash if hashed else None
        return attrs_decorator(cls, repr=False, eq=False, **options)

    def _with_state(cls: type, own: list[Any]) -> list[Any]:
        """Return the fields of a part: those with a default are no arguments of the constructor, but `settings`."""
        return [
            one if one.inherited or one.default is attrs.NOTHING or one.name == "settings" else one.evolve(init=False)
            for one in own
        ]

    define = partial(_decorate, attrs_decorator=attrs.define, hashed=False)
    stateful, state = partial(define, field_transformer=_with_state), field
    frozen = partial(_decorate, attrs_decorator=attrs.frozen, hashed=True)

__all__ = [
    "COUNT",
    "LIMITS",
    "MADE_AGAIN",
    "NOT_SAVED",
    "ROW_SIZE",
    "astuple",
    "define",
    "evolve",
    "field",
    "fields",
    "frozen",
    "limited",
    "limits",
    "state",
    "stateful",
]
