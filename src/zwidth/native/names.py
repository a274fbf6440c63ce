"""What a name means in a module of the package, read from its text alone: nothing is imported.

A step function speaks of numbers, tuples of them, named tuples, other step functions and the modules they
stand in.  All of these are found from the text, so that the package can be translated before anything that
it needs is installed.
"""

from __future__ import annotations

import ast
import builtins
import math
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple


class OutsideError(Exception):
    """What cannot be translated, with file and line."""


class Defined(NamedTuple):
    """A function or a class, and the module in which it stands."""

    module: Module
    node: ast.FunctionDef | ast.ClassDef

    def takes(self) -> list[ast.arg]:
        """The arguments of a function."""
        assert isinstance(self.node, ast.FunctionDef)
        given = self.node.args
        if given.vararg or given.kwarg or given.kwonlyargs or given.posonlyargs:
            raise self.module.outside(self.node, "a step function takes its arguments one by one")
        return given.args


class Expression(NamedTuple):
    """What a name is given at the top of a module; `part` of it where several names are given at once."""

    module: Module
    node: ast.expr
    part: int | None


class Octets(tuple[int, ...]):
    """A table of bytes."""


def floor(x: float) -> float:
    """That of numpy: it stays a real number."""
    return x if x == 0 else float(math.floor(x))


_DOUBLE = SimpleNamespace(eps=2.0**-52, tiny=2.0**-1022, max=(2.0 - 2.0**-52) * 2.0**1023)
_NUMPY = SimpleNamespace(
    frombuffer=lambda octets, _: Octets(octets),
    uint8=None,
    inf=math.inf,
    nan=math.nan,
    pi=math.pi,
    sqrt=math.sqrt,
    floor=floor,
    array=tuple,
    float64=float,
    int64=int,
    finfo=lambda _: _DOUBLE,
)
_LIBRARIES: dict[str, Any] = {"math": math, "numpy": _NUMPY}
_HARMLESS = (
    "range", "tuple", "len", "sum", "min", "max", "abs", "float", "int", "zip", "enumerate", "sorted", "ord",
)  # fmt: skip


class Package:
    """The modules below a folder, each read when it is first asked for."""

    def __init__(self, root: Path) -> None:
        self.root, self._read = root, dict[str, Module | None]()

    def module(self, name: str) -> Module | None:
        """By its dotted name, None if there is no such file."""
        if name not in self._read:
            at = self.root.parent.joinpath(*name.split("."))
            path = at / "__init__.py" if at.is_dir() else at.with_suffix(".py")
            self._read[name] = Module(self, name, path) if path.is_file() else None
        return self._read[name]

    def read(self) -> list[Path]:
        """The files that were read so far, in their order."""
        return sorted(module.path for module in self._read.values() if module)

    def step_functions(self) -> Iterator[Defined]:
        """All that are decorated with `compiled`, file by file."""
        for path in sorted(self.root.rglob("*.py")):
            if not any(word in path.read_bytes() for word in (b"@compiled", b"@exchanged")):
                continue
            module = self.module(".".join(path.relative_to(self.root.parent).with_suffix("").parts))
            assert module is not None
            for node in module.tree.body:
                if isinstance(node, ast.FunctionDef) and is_step_function(node):
                    yield Defined(module, node)


def is_step_function(node: ast.AST) -> bool:
    """True of a function that is decorated with `compiled`, or with `exchanged` as those of a connection."""
    return isinstance(node, ast.FunctionDef) and any(
        isinstance(d, ast.Name) and d.id in ("compiled", "exchanged") for d in node.decorator_list
    )


def _top(tree: ast.Module) -> Iterator[ast.stmt]:
    """The statements of a file, those for type checkers alone among them."""
    for node in tree.body:
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            yield from node.body
        else:
            yield node


class Module:
    """One file of the package."""

    def __init__(self, package: Package, name: str, path: Path) -> None:
        self.package, self.name, self.path = package, name, path
        self.tree = ast.parse(path.read_text(encoding="utf-8"), str(path))

    def outside(self, node: ast.AST, what: str) -> OutsideError:
        """What cannot be translated, and where it stands."""
        return OutsideError(f"{self.path}:{getattr(node, 'lineno', 1)}: {what}")

    @cached_property
    def _given(self) -> dict[str, Any]:
        """Every name that the top of the file gives a meaning, and what that is."""
        found: dict[str, Any] = {}
        for node in _top(self.tree):
            if isinstance(node, ast.ImportFrom) and node.module and not node.level:
                for alias in node.names:
                    found[alias.asname or alias.name] = (node.module, alias.name)
            elif isinstance(node, ast.Import):
                for alias in node.names:
                    found[alias.asname or alias.name] = (alias.name, None)
            elif isinstance(node, ast.FunctionDef | ast.ClassDef):
                found[node.name] = Defined(self, node)
            elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.value:
                found[node.target.id] = Expression(self, node.value, None)
            elif isinstance(node, ast.Assign):
                for target in node.targets:
                    if isinstance(target, ast.Name):
                        found[target.id] = Expression(self, node.value, None)
                    elif isinstance(target, ast.Tuple):
                        for part, inner in enumerate(target.elts):
                            if isinstance(inner, ast.Name):
                                found[inner.id] = Expression(self, node.value, part)
        return found

    def meaning(self, name: str) -> Any:
        """A `Defined`, an `Expression`, a `Module`, a module of a library, or None."""
        given = self._given.get(name)
        if isinstance(given, Expression):
            node = given.node
            if given.part is not None and isinstance(node, ast.Tuple):
                node = node.elts[given.part]
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                owner = self.meaning(node.value.id)  # a function of another module under another name
                if isinstance(owner, Module):
                    return owner.meaning(node.attr)
        if not isinstance(given, tuple) or isinstance(given, Defined | Expression):
            return given
        module, inner = given
        if module in _LIBRARIES:
            return _LIBRARIES[module] if inner is None else getattr(_LIBRARIES[module], inner, None)
        if inner is None:
            return None
        if within := self.package.module(f"{module}.{inner}"):
            return within
        owner = self.package.module(module)
        return owner.meaning(inner) if owner else None

    @cached_property
    def _known(self) -> _Known:
        return _Known(self)

    def told(self, name: str) -> Any:
        """A number, a tuple, `Attributes` of a module, a function of a library, a `Defined`, or None."""
        try:
            return self._known[name]
        except NameError:
            found = self.meaning(name)
            return found if isinstance(found, Defined) else None

    def value(self, node: ast.expr, but: Any = ()) -> Any:
        """The number or tuple that an expression is, None if it is none; the names in `but` have no value."""
        if any(isinstance(n, ast.Name) and n.id in but for n in ast.walk(node)):
            return None
        try:
            found = eval(compile(ast.Expression(node), str(self.path), "eval"), self._known)
        except (NameError, TypeError, AttributeError, ValueError, KeyError, IndexError, ArithmeticError):
            return None
        return None if isinstance(found, Defined) else found


class _Known(dict[str, Any]):
    """The names of a module that are no functions or classes, each evaluated when it is first asked for."""

    def __init__(self, module: Module) -> None:
        super().__init__(__builtins__={})
        self._module = module

    def __missing__(self, name: str) -> Any:
        found = self._module.meaning(name)
        if isinstance(found, Expression):
            value = found.module.value(found.node)
            if value is None:
                raise NameError(name)
            found = value if found.part is None else tuple(value)[found.part]
        elif isinstance(found, Module):
            found = Attributes(found)
        elif found is None and name in _HARMLESS:
            found = getattr(builtins, name)
        elif found is None or isinstance(found, Defined):
            raise NameError(name)
        self[name] = found
        return found


class Attributes:
    """A module as `module.NAME` sees it."""

    def __init__(self, module: Module) -> None:
        self._module = module

    def __getattr__(self, name: str) -> Any:
        found = self._module.told(name)
        if found is None:
            raise AttributeError(name)
        return found


def c_name(module: str, function: str) -> str:
    """What a step function is called in C."""
    return f"{module.removeprefix('zwidth.').replace('.', '_')}_{function}"


# What all do alike that read step functions: the translation to C, and `firmware`, which specialises them.
#
# A reader has one method for each kind of node that it understands, called as the kind is: `_binop` reads an
# `ast.BinOp`.  What it has none for is outside, with file and line.

SPELLED: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.Lt: "<", ast.LtE: "<=", ast.Eq: "==", ast.NotEq: "!=", ast.Gt: ">", ast.GtE: ">=",
    ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
}  # fmt: skip
"""The operators as Python writes them, all but // and % as C does."""


def by_kind(owner: object, node: object) -> Any:
    """The method for a kind of node; None if there is none."""
    return getattr(owner, f"_{type(node).__name__.lower()}", None)


class Reader:
    """Reads one function."""

    of: Defined

    @property
    def module(self) -> Module:
        """Where it stands."""
        return self.of.module

    def outside(self, node: ast.AST, what: str) -> OutsideError:
        """What cannot be translated, and where it stands."""
        return self.module.outside(node, what)

    def method(self, node: ast.AST) -> Any:
        """The one that reads a node."""
        found = by_kind(self, node)
        if found is None:
            text = ast.unparse(node).splitlines()[0]
            raise self.outside(node, f"{text} is outside what is translated")
        return found

    def _pass(self, node: ast.Pass) -> None:
        pass


def counted(node: ast.For) -> tuple[ast.expr, ast.expr, ast.expr] | None:
    """Start, stop and step of a loop over a range; None of another."""
    if not isinstance(node.iter, ast.Call) or ast.unparse(node.iter.func) != "range":
        return None
    zero, one = (ast.copy_location(ast.Constant(n), node.iter) for n in (0, 1))
    given = node.iter.args if len(node.iter.args) > 1 else [zero, *node.iter.args]
    start, stop, step = [*given, one][:3]
    return start, stop, step
