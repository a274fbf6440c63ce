"""Gappa, a prover of rounding errors, proves of single steps what the bounds claim of them.

Melquiond, G., "Gappa: Generating Proofs and Arithmetic Properties Automatically", https://gappa.gitlabpages.inria.fr
"""

from __future__ import annotations

from decimal import Decimal, getcontext
from pathlib import Path

import numpy as np
import pytest
from firmware.emulated.built import called
from firmware.emulated.required import require
from firmware.random_laws import PADDLE, laws

from zwidth.machine.firmware.bound import plain
from zwidth.machine.firmware.invariant import Rest, invariant
from zwidth.machine.firmware.law import LawProgram, law_program
from zwidth.machine.firmware.machine import DOUBLE, FLOAT, rest_ends
from zwidth.machine.firmware.program import Constant, Load, Operand, Operation, Store, Variable

MOST = 3000
_FORMATS = {"float": (FLOAT, "ieee_32", 2.0**-24), "double": (DOUBLE, "ieee_64", 2.0**-53)}


def plainly(value: float) -> str:
    getcontext().prec = 1200
    return f"{Decimal(value):f}"


class Script:
    """A program's statements before its first branch, computed and exact, and what is claimed of each."""

    def __init__(self, law: LawProgram, number: str, factor: float) -> None:
        arithmetic, name, unit = _FORMATS[number]
        ends = rest_ends(law, (-MOST, MOST))
        errors = 8 * unit * np.abs(ends).max(axis=0)
        given = {law.program.parameters[0]: plain(-MOST, MOST)}
        found = invariant(law.program, given, Rest(ends, tuple(map(float, errors))), arithmetic)
        self.lines = [f"@rnd = float<{name},ne>;", "n = rnd(n0);", "N = n;"]
        self.suppose, self.claims = [f"n in [{-MOST},{MOST}]"], []
        self.names: dict[Variable, str] = {law.program.parameters[0]: "n"}
        self.constants = np.float32 if number == "float" else np.float64
        for s in law.program.body:
            if isinstance(s, Load):
                low, high, error = found.memory[s.index.value]
                name = self.named(s.result)
                self.lines.append(f"{name} = rnd({name}_0);")
                self.suppose.append(f"{name.upper()} in [{plainly(low)},{plainly(high)}]")
                self.suppose.append(f"{name} - {name.upper()} in [{plainly(-error)},{plainly(error)}]")
            elif isinstance(s, Operation) and s.operator in ("+", "-", "*"):
                of = [self.read(o) for o in s.operands]
                name = self.named(s.result)
                self.lines.append(f"{name} rnd= {of[0]} {s.operator} {of[1]};")
                self.lines.append(f"{name.upper()} = {of[0].upper()} {s.operator} {of[1].upper()};")
                claimed = factor * found.values[s.result].error
                self.claims.append(f"{name} - {name.upper()} in [{plainly(-claimed)},{plainly(claimed)}]")
            elif isinstance(s, Operation) and s.operator == "real":
                self.names[s.result] = self.read(s.operands[0])
            elif not isinstance(s, Store):
                break

    def named(self, variable: Variable) -> str:
        self.names[variable] = f"v{len(self.names)}"
        return self.names[variable]

    def read(self, operand: Operand) -> str:
        """The name of a number; a known one gets one, with its exact value in capitals."""
        if not isinstance(operand, Constant):
            return self.names[operand]
        name = f"c{len(self.lines)}"
        self.lines.append(f"{name} = {plainly(float(self.constants(operand.value)))};")
        self.lines.append(f"{name.upper()} = {plainly(operand.value)};")
        return name

    def text(self) -> str:
        both = " /\\ "
        goal = f"{{ {both.join(self.suppose)} -> {both.join(self.claims)} }}"
        return "\n".join([*self.lines, goal])


NAMES = ["wall", "wall damped", "wall window", "wall one pole", "everywhere fir", "everywhere order 8"]


@pytest.mark.parametrize("number", _FORMATS)
@pytest.mark.parametrize("name", NAMES)
def test_gappa_proves_the_rounding_of_a_step(name: str, number: str, tmp_path: Path) -> None:
    """Every sum and product, of what is remembered within its bound, is off by no more than is claimed."""
    require("gappa")
    script = Script(law_program(PADDLE, laws()[name]), number, 1.0)
    assert len(script.claims) >= 2
    (tmp_path / "step.g").write_text(script.text(), encoding="utf-8")
    called(["gappa", str(tmp_path / "step.g")])


def test_gappa_proves_no_bound_that_is_too_small(tmp_path: Path) -> None:
    require("gappa")
    script = Script(law_program(PADDLE, laws()["wall"]), "float", 0.1)
    (tmp_path / "step.g").write_text(script.text(), encoding="utf-8")
    with pytest.raises(AssertionError):
        called(["gappa", str(tmp_path / "step.g")])
