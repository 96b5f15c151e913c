"""Rewrites modules for mypyc: records of attrs become plain classes with annotations and an `__init__`.

mypyc makes native classes of plain classes only. The source keeps its records, and a copy of it is rewritten for each
build. In a rewritten class, fields have no values and `__init__` sets them, in the order of attrs. What reads records
at run time (saving, `evolve`, comparison) finds attrs' own description of the fields, which records.py adds."""

from __future__ import annotations

import ast

from classes import Field, Record, init_fields

RUNTIME = "solepath._compiled"
"""Module of the build that has the functions of records.py."""
RUNTIME_NAMES = (
    "NOTHING, annotate, astuple, declare, equal, evolve, fields, hashed, hide_slots, made_by, make_record, shown"
)
OPEN = "solepath.types.records"
"""Module of packets and samples, whose fields hold what an app gives: plain.py converts lists and arrays later."""
OPTIONS = "serializable=True, allow_interpreted_subclasses=True"
"""Options of native classes: `__new__` makes one without fields, as restoring a state needs, and apps may derive."""


class ModuleRewriter:
    """Rewrites modules that have these classes."""

    def __init__(self, classes: dict[str, Record], base_protocols: set[str]) -> None:
        self.classes, self.base_protocols = classes, base_protocols

    def rewrite(self, source: str) -> str:
        """Return the source of the module in the form that is compiled."""
        tree = ast.parse(source)
        body: list[ast.stmt] = []
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and self._is_native(node):
                body += self._rewrite_class(node)
            elif isinstance(node, ast.ClassDef) and not node.bases and not node.decorator_list:
                body.append(_opened(node))
            elif isinstance(node, ast.ClassDef) and any(ast.unparse(base) == "NamedTuple" for base in node.bases):
                for one in node.body:  # mypyc looks `object` up in the module
                    if isinstance(one, ast.AnnAssign) and ast.unparse(one.annotation) == "object":
                        one.annotation = ast.Name("Any")
                body.append(node)
                hints = {ast.unparse(one.target): ast.unparse(one.annotation) for one in _annotated(node)}
                # saving reads them; those of mypyc have no names of other types
                body += ast.parse(f"setattr({node.name}, '__annotations__', {hints!r})").body
            elif isinstance(node, ast.AnnAssign) and ast.unparse(node.annotation) == "Final" and _is_tuple(node.value):
                # mypyc 2.4.1 tests a constant tuple wrongly: it says that it was not set
                body.append(ast.Assign([node.target], node.value, lineno=node.lineno))
            elif isinstance(node, ast.Assign) and _is_constant(node):
                target = node.targets[0]
                body.append(ast.AnnAssign(target, ast.Name("Final"), node.value, simple=1))
            else:
                body.append(node)
        head = [
            "from typing import TYPE_CHECKING, Any, Final",
            "if TYPE_CHECKING:\n    from mypy_extensions import mypyc_attr",  # a wheel does not bring it
            f"from {RUNTIME} import {RUNTIME_NAMES}",
        ]
        at = next(k for k, node in enumerate(body) if isinstance(node, ast.ImportFrom) and node.module == "__future__")
        # after all imports of the module, so that evolve, fields and astuple are those of the runtime
        last = max(k for k, node in enumerate(body) if isinstance(node, ast.Import | ast.ImportFrom))
        body[last + 1 : last + 1] = ast.parse("\n".join(head[2:])).body
        body[at + 1 : at + 1] = ast.parse("\n".join(head[:2])).body
        body = [self._without_attrs(node) for node in body]
        tree.body = [node for node in body if node is not None]
        return ast.unparse(ast.fix_missing_locations(tree)) + "\n"

    def _without_attrs(self, node: ast.stmt) -> ast.stmt | None:
        if isinstance(node, ast.ImportFrom) and (node.module or "").endswith("attrs"):
            node.names = [name for name in node.names if name.name not in ("evolve", "fields", "astuple")]
            return node if node.names else None
        return node

    def _is_native(self, node: ast.ClassDef) -> bool:
        return self._native_name(node.name)

    def _native_name(self, name: str) -> bool:
        """Return whether a class becomes native: a record, a protocol that classes derive from, or such a class."""
        record = self.classes[name]
        bases = [base for base in record.bases if base in self.classes]
        return record.is_record or name in self.base_protocols or any([self._native_name(base) for base in bases])

    def _rewrite_class(self, node: ast.ClassDef) -> list[ast.stmt]:
        record = self.classes[node.name]
        node.bases = [base for base in node.bases if ast.unparse(base) not in ("Protocol", "ABC")]
        node.decorator_list = [ast.parse(f"mypyc_attr({OPTIONS})", mode="eval").body]
        body: list[ast.stmt] = []
        inherited = self._inherited_names(record)
        properties = {name for base in record.bases if base in self.classes for name in self.classes[base].properties}
        methods = {one.name for one in node.body if isinstance(one, ast.FunctionDef)}
        for one in node.body:
            if isinstance(one, ast.Assign) and _is_slots(one):
                continue
            if isinstance(one, ast.AnnAssign) and not ast.unparse(one.annotation).startswith("ClassVar"):
                own = next(own for own in record.own if own.name == ast.unparse(one.target))
                if own.name not in inherited:
                    value = None if record.is_record else one.value
                    body.append(ast.AnnAssign(ast.Name(own.name), _native_hint(record, own), value, simple=1))
                continue
            if isinstance(one, ast.AnnAssign) and ast.unparse(one.target) in properties:
                # a class variable in place of a property of the base, which compiled code would call
                hint, value = ast.unparse(one.annotation.slice), ast.unparse(one.value)
                lines = f"@property\ndef {ast.unparse(one.target)}(self) -> {hint}:\n    return {value}"
                body += ast.parse(lines).body
                continue
            if isinstance(one, ast.FunctionDef) and "cached_property" in map(ast.unparse, one.decorator_list):
                body += _kept_property(one)
                continue
            if isinstance(one, ast.FunctionDef):
                if record.module == OPEN and one.name in record.defaults.values():
                    one.returns = ast.Name("Any")
                one.decorator_list = [
                    decorator
                    for decorator in one.decorator_list
                    if not (isinstance(decorator, ast.Attribute) and decorator.attr == "default")
                    and ast.unparse(decorator) != "abstractmethod"
                ]
                if _is_empty(one):
                    one.body.append(ast.parse("raise NotImplementedError").body[0])
            body.append(one)
        if record.is_record:
            body += self._init(record)
            if record.eq and "__eq__" not in methods:
                body += ast.parse("def __eq__(self, other: object) -> Any:\n    return equal(self, other)").body
                if record.frozen:
                    body += ast.parse("def __hash__(self) -> int:\n    return hashed(self)").body
            if "__repr__" not in methods:
                body += ast.parse("def __repr__(self) -> str:\n    return shown(self)").body
        node.body = body or [ast.Pass()]
        bases = [base for base in record.bases if base in self.classes and self._native_name(base)]
        return [*ast.parse("\n".join([f"hide_slots({base})" for base in bases])).body, node, *self._after(record)]

    def _inherited_names(self, record: Record) -> set[str]:
        names: set[str] = set()
        for base in record.bases:
            if base in self.classes:
                names |= {one.name for one in self.classes[base].own} | self._inherited_names(self.classes[base])
        return names

    def _init(self, record: Record) -> list[ast.stmt]:
        arguments, lines, positional = ["self"], [], True
        base = next((base for base in record.bases if base in self.classes and self.classes[base].is_record), None)
        passed = []
        for owner, one in init_fields(record, self.classes):
            own = owner is record
            hint = ast.unparse(_native_hint(record, one)) if own else "Any"
            if record.kw_only and positional:
                arguments.append("*")
                positional = False
            if not one.init:
                if own and one.default is not None:
                    lines.append(f"self.{one.name} = {ast.unparse(one.default)}")
                continue
            if one.default is None:
                arguments.append(f"{one.name}: {hint}")
                value = one.name
            elif isinstance(one.default, ast.Constant):
                arguments.append(f"{one.name}: {hint} = {ast.unparse(one.default)}")
                value = one.name
            else:
                arguments.append(f"{one.name}: Any = NOTHING")
                value = f"{ast.unparse(one.default)} if {one.name} is NOTHING else {one.name}" if own else one.name
            if own:
                lines.append(f"self.{one.name} = {value}")
            else:
                passed.append(f"{one.name}={one.name}")
        if base is not None:
            if self._base_has_post_init(base):
                raise SystemExit(f"{record.name}: a base has __attrs_post_init__, which is not handled")
            lines.insert(0, f"super().__init__({', '.join(passed)})")
        if record.has_post_init:
            lines.append("self.__attrs_post_init__()")
        return ast.parse(f"def __init__({', '.join(arguments)}) -> None:\n    " + "\n    ".join(lines or ["pass"])).body

    def _base_has_post_init(self, name: str) -> bool:
        record = self.classes[name]
        return record.has_post_init or any(
            base in self.classes and self._base_has_post_init(base) for base in record.bases
        )

    def _after(self, record: Record) -> list[ast.stmt]:
        hints = {one.name: ast.unparse(one.hint) for one in record.own}
        lines = [f"annotate({record.name}, {hints!r}, {record.is_protocol})"]
        if record.is_record:
            these = []
            for one in record.own:
                declared = "declare()" if one.declared is None else ast.unparse(one.declared)
                if declared.startswith(("field(", "state(")):
                    declared = f"declare({declared.partition('(')[2]}"
                elif not declared.startswith(("declare(", "limited(")):
                    declared = f"declare(default={declared})"
                if one.name in record.defaults:
                    declared = f"declare(default=made_by({record.defaults[one.name]!r}))"
                if not one.init and "init=" not in declared:
                    declared = f"{declared[:-1]}, init=False)"
                these.append(f"{one.name!r}: {declared}")
            lines.append(f"make_record({record.name}, {{{', '.join(these)}}}, {record.frozen}, {record.kw_only})")
        return ast.parse("\n".join(lines)).body


def _native_hint(record: Record, one: Field) -> ast.expr:
    """Return the type of a field for the compiler."""
    return ast.Name("Any") if record.module == OPEN else one.hint


def _opened(node: ast.ClassDef) -> ast.ClassDef:
    """Return a class that is no record, from which an app may derive and whose `__new__` can be called."""
    node.decorator_list = [ast.parse(f"mypyc_attr({OPTIONS})", mode="eval").body]
    node.body = [one for one in node.body if not (isinstance(one, ast.Assign) and _is_slots(one))]
    for one in ast.walk(node):
        if isinstance(one, ast.Call) and isinstance(one.func, ast.Attribute) and one.func.attr == "__new__":
            one.func = ast.Call(ast.Name("getattr"), [one.func.value, ast.Constant("__new__")], [])
    return node


def _is_slots(node: ast.Assign) -> bool:
    return ast.unparse(node.targets[0]) == "__slots__"


def _kept_property(function: ast.FunctionDef) -> list[ast.stmt]:
    """Return a property that keeps its value in an attribute: mypyc computes a cached property at every access."""
    name, function.decorator_list = function.name, []
    function.name = f"_make_{name}"
    hint = ast.unparse(function.returns or ast.Name("Any"))
    lines = f"""
_kept_{name}: Any = None
@property
def {name}(self) -> {hint}:
    if self._kept_{name} is None:
        self._kept_{name} = self.{function.name}()
    kept: {hint} = self._kept_{name}
    return kept
"""
    return [function, *ast.parse(lines).body]


def _annotated(node: ast.ClassDef) -> list[ast.AnnAssign]:
    return [one for one in node.body if isinstance(one, ast.AnnAssign)]


def _is_tuple(value: ast.expr | None) -> bool:
    return isinstance(value, ast.Tuple)


def _is_empty(function: ast.FunctionDef) -> bool:
    return all(isinstance(one, ast.Expr) and isinstance(one.value, ast.Constant) for one in function.body)


def _is_constant(node: ast.Assign) -> bool:
    """Return whether an assignment declares a number by numbers and other constants."""
    target = node.targets[0]
    if len(node.targets) != 1 or not isinstance(target, ast.Name) or not target.id.isupper():
        return False
    kinds = (ast.BinOp, ast.UnaryOp, ast.operator, ast.unaryop, ast.expr_context)
    parts = list(ast.walk(node.value))
    return all(
        isinstance(one, kinds)
        or (isinstance(one, ast.Constant) and type(one.value) in (int, float))
        or (isinstance(one, ast.Name) and one.id.isupper())
        for one in parts
    ) and any(isinstance(one, ast.Constant) for one in parts)
