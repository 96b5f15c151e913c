"""The decorators `define` and `frozen` of all classes here: attrs, but quicker to import.

attrs writes and compiles `__repr__`, `__eq__` and `__hash__` of every class when its module is imported. That is three
fifths of the cost of a class then, and was a third of `import solepath`. Here all classes share one of each, which
reads the fields when it is called. They give the same results as those of attrs; comparing and printing are slower, but
nothing that runs per sample needs them. `python tests/bench/way.py` prints the time of an import."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import attrs
from attrs import astuple, evolve, field, fields

# saving/schema.py reads these marks of fields
NOT_SAVED = {"saving": "not saved"}
"""Mark of a field that is in no snapshot and in no packed state: it has its default after loading."""
MADE_AGAIN = {"saving": "made again"}
"""Mark of a field of state whose parts are made again by their holder."""

if TYPE_CHECKING:
    from attrs import define, frozen
else:

    def _repr(self: Any) -> str:
        """Return `Name(field=value, ...)`, as attrs prints it."""
        shown = [(one, getattr(self, one.name)) for one in fields(type(self)) if one.repr]
        texts = [f"{one.name}={repr(value) if one.repr is True else one.repr(value)}" for one, value in shown]
        return f"{type(self).__qualname__.rpartition('>.')[2]}({', '.join(texts)})"

    def _eq(self: Any, other: Any) -> bool:
        """Return whether both are of one class and each field of one equals that of the other."""
        if other.__class__ is not self.__class__:
            return NotImplemented
        return all(getattr(self, one.name) == getattr(other, one.name) for one in fields(type(self)) if one.eq)

    def _hash(self: Any) -> int:
        """Return the hash of the fields that are compared."""
        return hash((type(self), *(getattr(self, one.name) for one in fields(type(self)) if one.eq)))

    def _declared(cls: type | None = None, *, made: Any, hashed: bool, **options: Any) -> Any:
        if cls is None:
            return partial(_declared, made=made, hashed=hashed, **options)
        own = vars(cls)
        if options.pop("repr", "__repr__" not in own):
            cls.__repr__ = _repr
        if options.pop("eq", "__eq__" not in own):
            cls.__eq__ = _eq
            cls.__hash__ = _hash if hashed else None
        return made(cls, repr=False, eq=False, **options)

    define = partial(_declared, made=attrs.define, hashed=False)
    frozen = partial(_declared, made=attrs.frozen, hashed=True)

__all__ = ["MADE_AGAIN", "NOT_SAVED", "astuple", "define", "evolve", "field", "fields", "frozen"]
