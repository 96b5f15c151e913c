"""What compiled modules need at run time: a native class becomes the attrs record that it is in the source."""

from __future__ import annotations

from operator import methodcaller
from typing import Any

import attrs

NOTHING: Any = attrs.NOTHING
evolve: Any = attrs.evolve
fields: Any = attrs.fields
astuple: Any = attrs.astuple
declare: Any = attrs.field


def made_by(method: str) -> Any:
    """Return a default that a method of the record makes."""
    return attrs.Factory(methodcaller(method), takes_self=True)


def equal(one: Any, other: Any) -> Any:
    """Return whether both are of one class and each field of one equals that of the other."""
    if other.__class__ is not one.__class__:
        return NotImplemented
    names = [attribute.name for attribute in attrs.fields(type(one)) if attribute.eq]
    return all([getattr(one, name) == getattr(other, name) for name in names])


def hashed(one: Any) -> int:
    """Return the hash of the fields that are compared."""
    cls = type(one)
    return hash((cls, *[getattr(one, attribute.name) for attribute in attrs.fields(cls) if attribute.eq]))


def shown(one: Any) -> str:
    """Return `Name(field=value, ...)`, as attrs prints it."""
    texts = []
    for attribute in attrs.fields(type(one)):
        if attribute.repr:
            show = repr if attribute.repr is True else attribute.repr
            texts.append(f"{attribute.name}={show(getattr(one, attribute.name))}")
    return f"{type(one).__qualname__}({', '.join(texts)})"


def _set_state(one: Any, state: dict[str, Any]) -> None:
    for name, value in state.items():
        object.__setattr__(one, name, value)


def hide_slots(cls: Any) -> None:
    """Delete the slots that `annotate` has set, because a native class with slots cannot have native subclasses."""
    for one in cls.__mro__:
        if "__slots__" in vars(one) and "__mypyc_attrs__" in vars(one):
            del one.__slots__


def _derive(cls: Any, **_: object) -> None:
    cls._is_protocol = False


def annotate(cls: Any, annotations: dict[str, str], is_protocol: bool = False) -> None:
    """Give a native class the annotations of its source, which compilers drop."""
    cls.__annotations__ = annotations
    cls._is_protocol = is_protocol
    if is_protocol:
        cls.__init_subclass__ = classmethod(_derive)
    for one in cls.__mro__:  # for attrs, so that an interpreted subclass uses the native fields
        if "__mypyc_attrs__" in vars(one):
            one.__slots__ = tuple([name for name in one.__annotations__ if name in vars(one)])


def make_record(cls: Any, these: dict[str, Any], frozen: bool, kw_only: bool) -> None:
    """Make a native class, which has an `__init__` of its own, an attrs class with these fields."""
    unset = {"init": False, "repr": False, "eq": False, "slots": False, "auto_detect": False}
    attrs.define(cls, these=these, frozen=frozen, kw_only=kw_only, **unset)
    if frozen:
        cls.__setstate__ = _set_state
