"""Small mistakes made in a source on purpose: every comparison, sign, constant, condition and early return,
every term of a sum and element of a tuple left out, every name taken for another one of its type.

A mutant is one change of one node of the syntax tree.  What is only said to people is left alone: messages,
docstrings, annotations; and what is no condition of a proof: imports, decorators, `strict=True`.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

_COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq, ast.LtE, ast.GtE),
    ast.NotEq: (ast.Eq, ast.Lt, ast.Gt),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
}
_OPERATORS: dict[type[ast.operator], tuple[type[ast.operator], ...]] = {
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.FloorDiv: (ast.Mult,),
    ast.Mod: (ast.FloorDiv,),
    ast.Pow: (ast.Mult,),
    ast.LShift: (ast.RShift,),
    ast.RShift: (ast.LShift,),
    ast.BitAnd: (ast.BitOr,),
    ast.BitOr: (ast.BitAnd,),
}
_FUNCTIONS = {
    "min": "max", "max": "min", "any": "all", "all": "any", "floor": "ceil", "ceil": "floor",
    "maximum": "minimum", "minimum": "maximum", "ones": "zeros", "zeros": "ones",
}  # fmt: skip
_SILENT = frozenset({"Verification", "Invalid", "TypeVar", "Context"})
"""Calls that make messages or types."""
_TYPES = frozenset({"Callable", "Literal", "Mapping", "dict", "list", "tuple"})
"""Of what is in their brackets nothing is looked at when it runs."""
_IN_ANY_ORDER = frozenset({"min", "max", "multiply", "dot", "_dot"})
"""Calls whose arguments may change places."""
_NO_CONDITION = frozenset({"strict", "dtype", "cache", "parallel", "ndigits"})


class Mutant(NamedTuple):
    """One change; `make` does it, in the tree that the mutant was found in."""

    line: int
    column: int
    change: str
    make: Callable[[], None]
    everywhere: bool
    """True outside functions: what is run when the module is loaded concerns whoever uses it."""


def mutants_of(tree: ast.Module) -> Iterator[Mutant]:
    """Every mutant of a module, in the order of its source; names taken for others last."""
    yield from _of_body(tree, "body", False)
    yield from _exchanged(tree)


def _of_body(owner: ast.AST, field: str, inside: bool) -> Iterator[Mutant]:
    """The statements of a block, and what they hold."""
    for at, statement in enumerate(getattr(owner, field)):
        if isinstance(statement, (ast.Import, ast.ImportFrom, ast.Assert, ast.Global)) or _is_text(statement):
            continue
        if not _names_only(statement):
            for found in _of_statement(statement, getattr(owner, field), at, owner):
                yield found._replace(everywhere=not inside)
        within = inside or isinstance(statement, ast.FunctionDef)
        for inner in ("body", "orelse", "finalbody"):
            if isinstance(getattr(statement, inner, None), list):
                yield from _of_body(statement, inner, within)
        for handler in getattr(statement, "handlers", []):
            yield from _of_body(handler, "body", within)


def _is_text(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)


def _names_only(statement: ast.stmt) -> bool:
    """`__all__ = …`: what others may import."""
    return isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == "__all__"


def _of_statement(statement: ast.stmt, block: list[ast.stmt], at: int, owner: ast.AST) -> Iterator[Mutant]:
    """What may be wrong with one statement, blocks in it apart."""
    if _may_go(statement, block, at, owner):
        yield _mutant(statement, "removed", _put(block, at, _nothing(statement)))
    if isinstance(statement, (ast.Raise, ast.ClassDef)):
        return
    if isinstance(statement, ast.AugAssign):
        yield from _operators(statement)
    if isinstance(statement, (ast.If, ast.While)):
        yield from _conditions(
            statement, "test", (False,) if isinstance(statement, ast.While) else (True, False)
        )
    for field, value in ast.iter_fields(statement):
        if field in ("body", "orelse", "finalbody", "handlers", "decorator_list", "annotation", "returns"):
            continue
        if field == "args":
            value = [*statement.args.defaults, *statement.args.kw_defaults]  # type: ignore[attr-defined]
        for expression in value if isinstance(value, list) else [value]:
            if isinstance(expression, (ast.expr, ast.withitem)):
                yield from _of_expression(expression, isinstance(statement, ast.Return))


def _may_go(statement: ast.stmt, block: list[ast.stmt], at: int, owner: ast.AST) -> bool:
    """A refusal, a step out of a loop, a call for its own sake, or a return before the end."""
    if isinstance(statement, ast.Return):
        return not (isinstance(owner, ast.FunctionDef) and at == len(block) - 1)
    called = isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call)
    kinds = (ast.Raise, ast.Continue, ast.Break, ast.AugAssign)
    return called or isinstance(statement, kinds)


def _of_expression(root: ast.AST, returned: bool) -> Iterator[Mutant]:
    """The mutants of an expression and its parts."""
    if isinstance(root, ast.JoinedStr) or (returned and _is_said(root)):
        return
    if isinstance(root, ast.Call) and ast.unparse(root.func) in _SILENT:
        return
    if isinstance(root, ast.Subscript) and ast.unparse(root.value) in _TYPES:
        return
    yield from _FOUND.get(type(root), lambda _: iter(()))(root)  # type: ignore[arg-type, return-value]
    for field, value in ast.iter_fields(root):
        if field == "annotation" or (isinstance(root, ast.keyword) and root.arg in _NO_CONDITION):
            continue
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, (ast.expr, ast.keyword, ast.comprehension)):
                yield from _of_expression(part, returned)
            elif isinstance(part, ast.arguments):
                for default in part.defaults:
                    yield from _of_expression(default, False)
    if isinstance(root, ast.comprehension):
        for at in range(len(root.ifs)):
            yield from _conditions(root, "ifs", (True, False), at)


def _is_said(node: ast.AST) -> bool:
    """A sentence, or one put together."""
    if isinstance(node, ast.Constant):
        return isinstance(node.value, str) and " " in node.value
    return isinstance(node, ast.BinOp) and (_is_said(node.left) or isinstance(node.left, ast.JoinedStr))


def _compared(node: ast.Compare) -> Iterator[Mutant]:
    for at, operator in enumerate(node.ops):
        only = _is_equality(operator) and _is_constant(node.comparators[at])
        for other in _COMPARISONS[type(operator)][: 1 if only else None]:
            yield _changed(node, _put(node.ops, at, other()))


def _is_constant(node: ast.expr) -> bool:
    """A number, or a word, by itself or by the name of it: words have no order that means anything."""
    return isinstance(node, ast.Constant) or (isinstance(node, ast.Name) and node.id.isupper())


def _is_equality(operator: ast.cmpop) -> bool:
    return isinstance(operator, (ast.Eq, ast.NotEq))


def _joined(node: ast.BoolOp) -> Iterator[Mutant]:
    yield _changed(node, _set(node, "op", ast.Or() if isinstance(node.op, ast.And) else ast.And()))
    for at in range(len(node.values)):
        yield _changed(node, _drop(node, "values", at))


def _operators(node: Any) -> Iterator[Mutant]:
    for other in _OPERATORS.get(type(node.op), ()):
        yield _changed(node, _set(node, "op", other()))
    if isinstance(node, ast.BinOp) and _is_sum(node):
        yield _changed(node, lambda: _become(node, node.left))
        if not _is_sum(node.left):
            added = isinstance(node.op, ast.Add)
            yield _changed(
                node, lambda: _become(node, node.right if added else ast.UnaryOp(ast.USub(), node.right))
            )


def _is_sum(node: ast.expr) -> bool:
    """A sum or a difference of two, and no text put together."""
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, (ast.Add, ast.Sub)):
        return False
    return not any(
        isinstance(side, ast.JoinedStr) or (isinstance(side, ast.Constant) and isinstance(side.value, str))
        for side in (node.left, node.right)
    )


def _signed(node: ast.UnaryOp) -> Iterator[Mutant]:
    if isinstance(node.op, ast.USub):
        yield _changed(node, _set(node, "op", ast.UAdd()))
    elif isinstance(node.op, ast.Not):
        yield _changed(
            node, lambda: _become(node, ast.Call(ast.Name("bool", ast.Load()), [node.operand], []))
        )


def _constant(node: ast.Constant) -> Iterator[Mutant]:
    n = node.value
    if isinstance(n, bool):
        others: list[Any] = [not n]
    elif isinstance(n, int):
        others = [n + 1, n - 1, 0, -n, 2 * n, n // 2]
    elif isinstance(n, float):
        others = [0.0, -n, 2 * n, n / 2]
    elif isinstance(n, str) and n and " " not in n and n.isidentifier():
        others = [f"{n}_"]
    else:
        others = []
    for other in dict.fromkeys(others):
        if other != n:
            yield _changed(node, _set(node, "value", other))


def _called(node: ast.Call) -> Iterator[Mutant]:
    name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
    if name in _FUNCTIONS:
        place = "id" if isinstance(node.func, ast.Name) else "attr"
        yield _changed(node, _set(node.func, place, _FUNCTIONS[name]))
    if name in ("min", "max") and len(node.args) > 1:
        for at in range(len(node.args)):
            yield _changed(node, _drop(node, "args", at))
    for at, pair in enumerate(zip(node.args, node.args[1:], strict=False)):
        named = all(isinstance(one, (ast.Name, ast.Attribute)) for one in pair)
        if named and name not in _IN_ANY_ORDER and len(set(map(ast.unparse, pair))) == 2:
            yield _changed(node, _turned(node.args, at))
    if name in ("abs", "reversed", "bool") and len(node.args) == 1:
        yield _changed(node, lambda: _become(node, node.args[0]))


def _listed(node: Any) -> Iterator[Mutant]:
    """One of several left out."""
    if len(node.elts) > 1 and isinstance(getattr(node, "ctx", ast.Load()), ast.Load):
        for at in range(len(node.elts)):
            yield _changed(node, _drop(node, "elts", at))


def _table(node: ast.Dict) -> Iterator[Mutant]:
    for at, key in enumerate(node.keys):
        told = "**" if key is None else ast.unparse(key)
        yield _mutant(key or node.values[at], f"no entry {told}", _without_entry(node, at))


def _chosen(node: ast.IfExp) -> Iterator[Mutant]:
    yield from _conditions(node, "test", (True, False))


_FOUND: dict[type, Callable[[Any], Iterator[Mutant]]] = {
    ast.Compare: _compared,
    ast.BoolOp: _joined,
    ast.BinOp: _operators,
    ast.UnaryOp: _signed,
    ast.Constant: _constant,
    ast.Call: _called,
    ast.Tuple: _listed,
    ast.List: _listed,
    ast.Set: _listed,
    ast.Dict: _table,
    ast.IfExp: _chosen,
}


def _exchanged(tree: ast.Module) -> Iterator[Mutant]:
    """A name taken for another of its type: parameters and fields of one annotation, names bound together."""
    fields = _next_of_type(
        (part.target.id, ast.unparse(part.annotation), owner.name)
        for owner in ast.walk(tree)
        if isinstance(owner, ast.ClassDef)
        for part in owner.body
        if isinstance(part, ast.AnnAssign) and isinstance(part.target, ast.Name)
    )
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef):
            continue
        names = _next_of_type(_typed(function))
        for node in _computed(function.body):
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id in names:
                yield _changed(node, _set(node, "id", names[node.id]))
            elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load) and node.attr in fields:
                yield _changed(node, _set(node, "attr", fields[node.attr]))


def _typed(function: ast.FunctionDef) -> Iterator[tuple[str, ...]]:
    """The names that a function is given or binds side by side, and what tells their type."""
    for given in (*function.args.args, *function.args.kwonlyargs):
        yield given.arg, ast.unparse(given.annotation) if given.annotation else ""
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple):
            for bound in node.targets[0].elts:
                if isinstance(bound, ast.Name):
                    yield bound.id, str(node.lineno)


def _next_of_type(typed: Iterable[tuple[str, ...]]) -> dict[str, str]:
    """For each name the next one of its type, for the last one the first."""
    groups: dict[tuple[str, ...], list[str]] = {}
    for name, *told in typed:
        groups.setdefault(tuple(told), []).append(name)
    return {
        name: other
        for names in groups.values()
        if len(set(names)) > 1
        for name, other in zip(names, (*names[1:], names[0]), strict=True)
    }


def _computed(block: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """What is computed in a block: neither what is said, nor functions in it, which come by themselves."""
    for node in block:
        if isinstance(node, (ast.FunctionDef, ast.Raise, ast.JoinedStr, ast.Assert)):
            continue
        if isinstance(node, ast.Call) and ast.unparse(node.func) in _SILENT:
            continue
        yield node
        parts = (
            value
            for field, value in ast.iter_fields(node)
            if field not in ("annotation", "returns", "decorator_list")
        )
        for value in parts:
            inner = value if isinstance(value, list) else [value]
            yield from _computed(part for part in inner if isinstance(part, ast.AST))


def _conditions(node: Any, field: str, values: tuple[bool, ...], at: int | None = None) -> Iterator[Mutant]:
    """A condition that is always met, or never."""
    old = getattr(node, field) if at is None else getattr(node, field)[at]
    for value in values:
        new = ast.copy_location(ast.Constant(value), old)
        make = _set(node, field, new) if at is None else _put(getattr(node, field), at, new)
        yield _mutant(old, f"{_short(old)} → {value}", make)


def _changed(node: Any, make: Callable[[], None]) -> Mutant:
    """A mutant told by how its node reads before and after."""
    before, kept = ast.unparse(node), dict(vars(node))
    lists = {name: list(value) for name, value in kept.items() if isinstance(value, list)}
    inner = dict(vars(node.func)) if isinstance(node, ast.Call) else {}
    kind = type(node)
    make()
    after = ast.unparse(ast.fix_missing_locations(node))
    node.__class__ = kind
    vars(node).clear()
    vars(node).update(kept)
    for name, value in lists.items():
        getattr(node, name)[:] = value
    if inner:
        vars(node.func).update(inner)
    return _mutant(node, f"{_cut(before)} → {_cut(after)}", make)


def _mutant(node: Any, change: str, make: Callable[[], None]) -> Mutant:
    return Mutant(node.lineno, node.col_offset, change, make, False)


def _short(node: ast.AST) -> str:
    return _cut(ast.unparse(node))


def _cut(text: str) -> str:
    return text if len(text) <= 90 else f"{text[:60]} … {text[-25:]}"


def _nothing(statement: ast.stmt) -> ast.stmt:
    return ast.copy_location(ast.Pass(), statement)


def _put(values: list[Any], at: int, value: Any) -> Callable[[], None]:
    def make() -> None:
        values[at] = value

    return make


def _set(node: Any, field: str, value: Any) -> Callable[[], None]:
    return lambda: setattr(node, field, value)


def _turned(values: list[Any], at: int) -> Callable[[], None]:
    """Two neighbours change places."""

    def make() -> None:
        values[at], values[at + 1] = values[at + 1], values[at]

    return make


def _drop(node: Any, field: str, at: int) -> Callable[[], None]:
    """One of several left out; of two that are joined the other is all."""

    def make() -> None:
        left = [v for i, v in enumerate(getattr(node, field)) if i != at]
        joined = isinstance(node, (ast.BoolOp, ast.Call))
        if joined and len(left) == 1 and not isinstance(left[0], ast.Starred):
            _become(node, left[0])
        else:
            setattr(node, field, left)

    return make


def _without_entry(node: ast.Dict, at: int) -> Callable[[], None]:
    def make() -> None:
        del node.keys[at]
        del node.values[at]

    return make


def _become(node: Any, other: ast.expr) -> None:
    """The node is turned into another one, in place."""
    place = {name: getattr(node, name) for name in ("lineno", "col_offset", "end_lineno", "end_col_offset")}
    fields = dict(vars(other))
    node.__class__ = other.__class__
    vars(node).clear()
    vars(node).update({**place, **fields})
