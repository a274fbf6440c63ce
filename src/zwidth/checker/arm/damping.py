"""What damps the joints: δ_m, the torque −δ_m q̇ against a motion of the joints, the power q̇ᵀδ_m q̇ ≥ 0.

Each joint has its own number, the diagonal; or the document has the whole matrix, of joints that damp each
other: belts, differentials, tendons. One of both, so that nothing is said twice. A proof of δ_m ≻ JᵀRJ with
R ⪰ 0 needs δ_m ≻ 0 by itself, and only then is it looked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ..document.fields import List, Number, Read, only_if
from ..document.refusal import Invalid
from ..document.unit import always
from ..exact.enclosed import Enclosed, known
from .cells import BITS, positive

Matrix = list[list[Fraction]]
LARGEST = 1 << 64


def matrix_entry(unit: str, most: int, **more: Any) -> List:
    """Rows of a square matrix."""
    return List(List(Number(), least=1, most=most), unit=always(unit), least=1, most=most, **more)


def damping_matrix(unit: str, most: int) -> List:
    """The entry of an arm whose joints damp each other."""
    return matrix_entry(unit, most, default=None)


def constant(x: Fraction) -> Enclosed:
    """A number of the document."""
    if abs(x) > LARGEST:
        raise Invalid("a number is too large")
    return known(x, BITS)


def damping_of(told: Read, joints: Sequence[Read]) -> Matrix:
    """δ_m of an arm, from the numbers of its joints or legs or from the matrix in their place."""
    whole = told.damping
    own = [only_if(whole is None, joint.damping, "damping of each joint") for joint in joints]
    if whole is None:
        return [[b if i == k else Fraction(0) for k in range(len(own))] for i, b in enumerate(own)]
    if len(whole) != len(own) or any(len(row) != len(own) for row in whole):
        raise Invalid(f"the damping of {len(own)} joints has {len(own)} rows, and as many columns")
    if any(whole[i][k] != whole[k][i] for i in range(len(own)) for k in range(i)):
        raise Invalid("the damping of the joints is not symmetric")
    if not positive([[constant(x) for x in row[i:]] for i, row in enumerate(whole)]):
        raise Invalid(
            "the damping of the joints is not positive definite: some motion of theirs costs nothing"
        )
    return [list(row) for row in whole]
