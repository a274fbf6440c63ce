"""What a name may stand for while a function is read, besides a number."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

from zwidth.machine.firmware.arithmetic import as_operand, converted, kind_of
from zwidth.machine.firmware.program import Cells, Statement, Variable, set_to
from zwidth.native.names import Defined
from zwidth.native.types import fields


@dataclass(eq=False)
class Changing:
    """A name that a loop changes: its variable keeps its place."""

    variable: Variable


@dataclass(eq=False)
class Unknown:
    """A name that only one branch has given: it cannot be read."""


@cache
def record(of: Defined) -> Any:
    """The class of a named tuple."""
    return namedtuple(of.node.name, fields(of).names)


def flat(value: Any) -> list[Any]:
    """The numbers of a tuple, and of those inside it; of one number that alone, of None none."""
    if value is None:
        return []
    return [x for part in value for x in flat(part)] if isinstance(value, tuple) else [value]


def rebuilt(like: Any, parts: list[Any]) -> Any:
    """A tuple, or a record, of the same kind with other parts."""
    return type(like)(*parts) if hasattr(like, "_fields") else tuple(parts)


def each(value: Any, of: Callable[[Any], Any]) -> Any:
    """What is made of a number, or of each of a tuple and of those inside it; of None nothing."""
    if isinstance(value, tuple):
        return rebuilt(value, [each(part, of) for part in value])
    return None if value is None else of(value)


def same(a: Any, b: Any) -> bool:
    """Whether two values are known to be one."""
    if a is b:
        return True
    if isinstance(a, tuple) and isinstance(b, tuple) and len(a) == len(b):
        return all(same(x, y) for x, y in zip(a, b, strict=True))
    plain = (bool, int, float)
    if isinstance(a, plain) and isinstance(b, plain) and type(a) is type(b):
        return a == b and str(a) == str(b)  # -0.0 is another number
    return isinstance(a, Cells) and a == b


def joined(
    a: Any,
    b: Any,
    first: list[Statement],
    second: list[Statement],
    hint: str,
    refuse: Callable[[str], Exception],
) -> Any:
    """What is one thing at the end of one block and another at the end of the other."""
    if same(a, b):
        return a
    if isinstance(a, Unknown) or isinstance(b, Unknown):
        return Unknown()
    if isinstance(a, tuple) and isinstance(b, tuple) and len(a) == len(b):
        parts = [joined(x, y, first, second, hint, refuse) for x, y in zip(a, b, strict=True)]
        return rebuilt(a, parts)
    if not all(isinstance(v, bool | int | float | Variable) for v in (a, b)):
        raise refuse(f"{hint} is a number on one way and something else on the other")
    kinds = {kind_of(a), kind_of(b)}
    kind = kinds.pop() if len(kinds) == 1 else "real"
    if kinds and "truth" in kinds:
        raise refuse(f"{hint} is a truth on one way and a number on the other")
    variable = Variable(kind, hint, changes=True)
    first.append(set_to(variable, as_operand(converted(a, kind, first))))
    second.append(set_to(variable, as_operand(converted(b, kind, second))))
    return variable


def set_all(variables: Any, value: Any, block: list[Statement], refuse: Callable[[str], Exception]) -> None:
    """Set such variables."""
    if isinstance(variables, tuple) and isinstance(value, tuple) and len(variables) == len(value):
        for one, part in zip(variables, value, strict=True):
            set_all(one, part, block, refuse)
    elif isinstance(variables, Variable) and isinstance(value, bool | int | float | Variable):
        value = converted(value, variables.kind, block)
        if kind_of(value) != variables.kind:
            raise refuse("a function returns numbers of one kind: write 0.0 for a real 0")
        block.append(set_to(variables, as_operand(value)))
    elif variables is not None or value is not None:
        raise refuse("a function returns as many numbers on every way")
