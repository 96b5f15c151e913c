"""Rewrites statements that mypyc compiles to slow code into equal ones that it compiles to fast code.

- `(x, y), k = v, w` makes a tuple of both values and iterates over it. Here each target has an assignment of its own.
- `for a, b in zip(v, w, strict=True)` makes a tuple for each pair. Without `strict`, it is a loop over an index. The
  pure form raises ValueError for values of different lengths, and its tests would show that.
- `KINDS.issuperset(map(type, values))` calls `type` for each value. Here it is a loop that compares types.
- A named tuple is made by its class in Python code. Here it is made by `tuple` itself."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path


class Faster(ast.NodeTransformer):
    """Rewrites the statements of a module."""

    def __init__(self, tree: ast.Module, named_tuples: dict[str, ast.ClassDef]) -> None:
        self.count, self.named_tuples = 0, named_tuples
        self.kinds = {name: kinds for node in tree.body for name, kinds in _sets_of_types(node)}

    def visit_Call(self, node: ast.Call) -> ast.AST:
        self.generic_visit(node)
        name = ast.unparse(node.func)
        if name == "zip":
            node.keywords = []
        owner, _, method = name.partition(".")
        if method == "issuperset" and owner in self.kinds and ast.unparse(node.args[0]).startswith("map(type, "):
            values = ast.unparse(node.args[0].args[1])
            tests = " or ".join([f"type(one) is {kind}" for kind in self.kinds[owner]])
            return ast.parse(f"all({tests} for one in {values})", mode="eval").body
        if name in self.named_tuples:
            return self._made_named(node, name)
        return node

    def _made_named(self, node: ast.Call, name: str) -> ast.AST:
        """Return the expression that makes a named tuple, or the call itself if it has stars or lacks a field."""
        given = {keyword.arg: keyword.value for keyword in node.keywords}
        fields = [one for one in self.named_tuples[name].body if isinstance(one, ast.AnnAssign)]
        defaults = {ast.unparse(one.target): one.value for one in fields if _is_plain(one.value)}
        named = {**defaults, **given}
        values = [*node.args, *[named.get(ast.unparse(one.target)) for one in fields[len(node.args) :]]]
        if None in values or None in given or any(isinstance(one, ast.Starred) for one in node.args):
            return node
        call = ast.parse(f"cast({name}, new_tuple({name}, ()))", mode="eval").body
        call.args[1].args[1] = ast.Tuple(values, ast.Load())
        return call

    def visit_Assign(self, node: ast.Assign) -> ast.AST | list[ast.stmt]:
        self.generic_visit(node)
        target, value = node.targets[0], node.value
        if not (isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple)) or len(node.targets) > 1:
            return node
        has_stars = any(isinstance(one, ast.Starred) for one in [*target.elts, *value.elts])
        if has_stars or not any(isinstance(one, ast.Tuple) for one in target.elts):
            return node  # without a tuple in a tuple it is compiled well
        pairs = list(zip(target.elts, value.elts, strict=True))
        if all(_names(one, ast.Store) and not _has_places(one) for one in target.elts):
            stored = [_names(one, ast.Store) for one in target.elts]
            if not any(stored[i] & _names(later, ast.Load) for i in range(len(pairs)) for later in value.elts[i + 1 :]):
                return [ast.Assign([one], given, lineno=node.lineno) for one, given in pairs]
        self.count += 1
        kept = [f"given_{self.count}_{i}" for i in range(len(pairs))]
        first = [ast.Assign([ast.Name(name, ast.Store())], given) for name, (_, given) in zip(kept, pairs, strict=True)]
        then = [ast.Assign([one], ast.Name(name, ast.Load())) for name, (one, _) in zip(kept, pairs, strict=True)]
        return [*first, *then]


def named_tuples(paths: Iterable[Path]) -> dict[str, ast.ClassDef]:
    """Return the named tuples of these modules by name."""
    nodes = [node for path in paths for node in ast.parse(path.read_text("utf-8")).body]
    classes = [node for node in nodes if isinstance(node, ast.ClassDef)]
    return {node.name: node for node in classes if [ast.unparse(base) for base in node.bases] == ["NamedTuple"]}


def _sets_of_types(node: ast.stmt) -> Iterator[tuple[str, list[str]]]:
    """Yield the name and the types of a set of built-in types that a module declares."""
    if isinstance(node, ast.Assign) and ast.unparse(node.value).startswith("frozenset(("):
        kinds = [ast.unparse(one) for one in node.value.args[0].elts]
        if all(kind in ("float", "int", "bool") for kind in kinds):
            yield ast.unparse(node.targets[0]), kinds


def _is_plain(node: ast.AST | None) -> bool:
    """Return whether a default is a constant or the empty tuple, which mean the same in every module."""
    return isinstance(node, ast.Constant) or (isinstance(node, ast.Tuple) and not node.elts)


def _names(node: ast.AST, context: type) -> set[str]:
    return {one.id for one in ast.walk(node) if isinstance(one, ast.Name) and isinstance(one.ctx, context)}


def _has_places(node: ast.AST) -> bool:
    return any(isinstance(one, ast.Attribute | ast.Subscript) for one in ast.walk(node))
