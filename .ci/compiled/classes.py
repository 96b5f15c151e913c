"""Reads the classes of modules that are compiled: their bases, and the fields of those that are records of attrs."""

from __future__ import annotations

import ast
from dataclasses import dataclass, field
from pathlib import Path

RECORD_NAMES = {"define": False, "stateful": False, "frozen": True}
"""Decorators of records, and whether their fields are frozen."""


@dataclass
class Field:
    """A field of a record."""

    name: str
    hint: ast.expr
    default: ast.expr | None = None  # an expression that makes the value; None: `__init__` needs an argument
    init: bool = True
    declared: ast.expr | None = None  # the call of field(), or the default


@dataclass
class Record:
    """A class of a module that is compiled."""

    name: str
    module: str
    bases: list[str]
    is_record: bool = False
    is_stateful: bool = False  # fields with a default are state (types/attrs.py)
    frozen: bool = False
    eq: bool = True
    kw_only: bool = False
    own: list[Field] = field(default_factory=list)
    defaults: dict[str, str] = field(default_factory=dict)  # method that makes a field's default, by field
    properties: set[str] = field(default_factory=set)
    has_post_init: bool = False
    is_protocol: bool = False


def read_classes(paths: dict[str, Path]) -> dict[str, dict[str, Record]]:
    """Return the classes of each of these modules by name."""
    return {
        module: {
            node.name: _read_class(node, module)
            for node in ast.parse(path.read_text("utf-8")).body
            if isinstance(node, ast.ClassDef)
        }
        for module, path in paths.items()
    }


def _read_class(node: ast.ClassDef, module: str) -> Record:
    bases = [ast.unparse(base) for base in node.bases]
    record = Record(node.name, module, bases, is_protocol="Protocol" in bases)
    for decorator in node.decorator_list:
        call = decorator if isinstance(decorator, ast.Call) else None
        name = ast.unparse(call.func if call else decorator)
        if name in RECORD_NAMES:
            record.is_record, record.frozen, record.is_stateful = True, RECORD_NAMES[name], name == "stateful"
            options = {keyword.arg: ast.literal_eval(keyword.value) for keyword in call.keywords} if call else {}
            record.eq, record.kw_only = options.pop("eq", True), options.pop("kw_only", False)
            if options:
                raise SystemExit(f"{node.name}: options {options} of a record are not known")
    for one in node.body:
        if isinstance(one, ast.AnnAssign) and not ast.unparse(one.annotation).startswith("ClassVar"):
            record.own.append(_read_field(one))
        if isinstance(one, ast.FunctionDef):
            record.has_post_init |= one.name == "__attrs_post_init__"
            for decorator in one.decorator_list:
                if ast.unparse(decorator) == "property":
                    record.properties.add(one.name)
                if isinstance(decorator, ast.Attribute) and decorator.attr == "default":
                    record.defaults[ast.unparse(decorator.value)] = one.name
    for one_field in record.own:
        if one_field.name in record.defaults:
            one_field.default = ast.parse(f"self.{record.defaults[one_field.name]}()", mode="eval").body
        if record.is_stateful and one_field.default is not None and one_field.name != "settings":
            one_field.init = False
    return record


def _read_field(node: ast.AnnAssign) -> Field:
    hint = node.annotation
    if isinstance(hint, ast.Subscript) and ast.unparse(hint.value) == "Final":
        hint = hint.slice
    one, value = Field(ast.unparse(node.target), hint, declared=node.value), node.value
    if isinstance(value, ast.Call) and ast.unparse(value.func) in ("field", "state"):
        options = {keyword.arg: keyword.value for keyword in value.keywords}
        if "init" in options:
            one.init = ast.literal_eval(options["init"])
        if "factory" in options:
            one.default = ast.parse(f"({ast.unparse(options['factory'])})()", mode="eval").body
            if isinstance(options["factory"], ast.Lambda):
                one.default = options["factory"].body
        elif "default" in options:
            one.default = options["default"]
    elif isinstance(value, ast.Call) and ast.unparse(value.func) == "limited":
        one.default = value.args[0]
    else:
        one.default = value
    return one


def init_fields(record: Record, classes: dict[str, Record]) -> list[tuple[Record, Field]]:
    """Return the fields of a record in the order of attrs: those of its bases first, unless it declares them again."""
    inherited: list[tuple[Record, Field]] = []
    for base in record.bases:
        if base in classes and classes[base].is_record:
            inherited += init_fields(classes[base], classes)
    own = {one.name for one in record.own}
    return [(owner, one) for owner, one in inherited if one.name not in own] + [(record, one) for one in record.own]


def base_protocols(source: Path, classes: dict[str, Record]) -> set[str]:
    """Return the names of the compiled protocols that a class derives from; others need no class of their own."""
    nodes = [node for path in source.rglob("*.py") for node in ast.parse(path.read_text("utf-8")).body]
    bases = {ast.unparse(base) for node in nodes if isinstance(node, ast.ClassDef) for base in node.bases}
    return {name for name in bases & classes.keys() if classes[name].is_protocol}
