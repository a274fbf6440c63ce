"""An arm of several joints renders a linear wall passively wherever it is in its region.

    δ_m − c ≻ Jᵀ R J    or, for a parallel arm, at the hand    Σ b_i w_i w_iᵀ ≻ R    in the whole region
    R = (2d + 1) KT/2 + A,    K ⪰ 0,    A ⪰ B,    A ⪰ −B

K and B of the wall, d whole samples of delay, T the period. A stands for |B|: all that the proof takes from
it is aᵀAa + bᵀAb ± 2aᵀBb ≥ 0. c = h F T/2 where the torque is held over a period, else 0: h bounds the second
derivatives of the hand's position, F the force of the wall. The hand's position is read without steps, or
Coulomb friction covers the steps, `arm_encoders`; then the region is one step larger on every side.
In pose the last coordinates are rotations, `arm_pose`, and c = (h F + h_e M) T/2: M bounds what the wall
gives for them, no less than its moment.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from typing import Any, NamedTuple

from ..document.reading import Invalid, get, integer, number
from ..exact.enclosure import ONE, Jet, enclosed
from .cells import Function, positive_in
from .chain import Chain, bends, chain_surplus, read_chain, vector
from .encoders import columns_below, friction_is_enough, read_encoders, with_steps
from .legs import legs_surplus, read_legs
from .pose import Pose, for_every_rest, in_words, read_pose, turning, turning_bend

MOST_DELAY = 10**6
KEYS = ("stiffness_N_per_m", "virtual_damping_N_s_per_m", "damping_bound_N_s_per_m")
POSE_KEYS = ("stiffness_N_m_rad", "virtual_damping_N_m_s_rad", "damping_bound_N_m_s_rad")

Matrix = list[list[Fraction]]


class Claim(NamedTuple):
    """S(x) ≻ 0 in a box of coordinates x, the joints or the hand's position."""

    box: list[tuple[Fraction, Fraction]]
    matrix: Function
    words: str
    columns: Function | None = None  # that has to be ≻ 0 there, too


def arm(document: Mapping[str, Any]) -> str:
    claim = _claim(document)
    box = tuple((enclosed(low)[0], enclosed(high)[1]) for low, high in claim.box)
    cells = positive_in(box, claim.matrix)
    if claim.columns is not None:
        cells += positive_in(box, claim.columns, "a column of the Jacobian is longer than it is said to be")
    return f"{claim.words}; {cells} cells"


def matrix_at(document: Mapping[str, Any], place: Sequence[Fraction]) -> list[list[float]]:
    """S at one place, its rows from the diagonal on: to see that a document is of the arm that was meant."""
    found = _claim(document).matrix([Jet(enclosed(x)) for x in place])
    return [[sum(s.value) / (2 * ONE) for s in row] for row in found]


def _claim(document: Mapping[str, Any]) -> Claim:
    machine, wall, loop = (get(document, key) for key in ("arm", "wall", "loop"))
    pose, geometry = read_pose(wall), get(machine, "geometry")
    held, counted = _torque(loop), get(loop, "encoder") == "counted"
    given = _matrices(wall, pose)
    need = [[enclosed(x) for x in row] for row in for_every_rest(_need(*given, loop), pose)]
    limits = _limits(loop, pose) if held or counted else (Fraction(0), Fraction(0))
    words = "no motion of the hand with {} takes energy out, " + _how(held, counted, limits, pose)
    if geometry == "chain":
        chain, columns = read_chain(machine), None
        if counted:
            encoders = read_encoders(machine, chain)
            chain = with_steps(chain, encoders)
            friction_is_enough(chain, encoders, given[:2], _period(loop), limits, pose)
            columns = columns_below(chain, encoders)
        price = _price(chain, loop, limits, pose) if held else Fraction(0)
        box = [(joint.low, joint.high) for joint in chain.joints]
        matrix = chain_surplus(chain, need, price, turning(machine, chain, pose) if pose.turns else None)
        words = words.format("every joint in its range") + in_words(wall, pose)
        return Claim(box, matrix, words, columns)
    if geometry != "legs":
        raise Invalid("the geometry is chain or legs")
    if pose.turns:
        raise Invalid("a parallel arm holds a point, and no pose")
    legs = read_legs(machine)
    if len(need) != len(legs.legs):
        raise Invalid("the wall has as many coordinates as the arm has legs")
    if held or counted:
        raise Invalid("the second derivatives of a parallel arm are not bounded here")
    box = list(zip(legs.low, legs.high, strict=True))
    return Claim(box, legs_surplus(legs, need), words.format("its position in the box"))


def _how(held: bool, counted: bool, limits: tuple[Fraction, Fraction], pose: Pose) -> str:
    """How the arm is read, and what becomes of the torque within a period."""
    moment = f" and moments up to {_down(limits[1])} N·m" if pose.turns else ""
    forces = f", for forces up to {_down(limits[0])} N{moment}"
    if counted:
        torque = "is held over a period" if held else "follows the readings"
        steps = "its encoder steps counted: force and Jacobian are those of the readings, and the torque "
        return f"{steps}{torque}{forces}"
    return f"read without encoder steps; the torque {f'is held{forces}' if held else 'follows the arm'}"


def _down(x: Fraction) -> str:
    """Six digits, rounded down: words say no more than is proved."""
    down = Context(prec=6, rounding=ROUND_FLOOR)
    return f"{float(down.divide(Decimal(x.numerator), Decimal(x.denominator))):g}"


def _torque(loop: Mapping[str, Any]) -> bool:
    """Whether it is held."""
    encoder, torque = get(loop, "encoder"), get(loop, "torque")
    if encoder not in ("ideal", "counted"):
        raise Invalid("the encoder is ideal, or counted")
    follows = "follows the arm" if encoder == "ideal" else "follows the readings"
    if torque not in ("held", follows):
        raise Invalid(f"the torque {follows}, or is held")
    return bool(torque == "held")


def _limits(loop: Mapping[str, Any], pose: Pose) -> tuple[Fraction, Fraction]:
    """F, and in pose M."""
    force = number(get(loop, "largest_force_N"))
    moment = number(get(loop, "largest_moment_N_m")) if pose.turns else Fraction(0)
    if min(force, moment) < 0:
        raise Invalid("forces are up to a largest force ≥ 0, and in pose to a largest moment ≥ 0")
    return force, moment


def _period(loop: Mapping[str, Any]) -> Fraction:
    period = number(get(loop, "sample_period_s"))
    if period <= 0:
        raise Invalid("T must be > 0")
    return period


def _need(stiffness: Matrix, _damping: Matrix, bound: Matrix, loop: Mapping[str, Any]) -> Matrix:
    """R [N·s/m; in pose N·s/rad and N·m·s/rad, too]."""
    delay = integer(get(loop, "delay_samples"))
    if delay > MOST_DELAY:
        raise Invalid("the delay is too many samples")
    return _sum(bound, stiffness, (2 * delay + 1) * _period(loop) / 2)


def _matrices(wall: Mapping[str, Any], pose: Pose) -> tuple[Matrix, Matrix, Matrix]:
    """K ⪰ 0, B, and A with A ± B ⪰ 0."""
    keys = POSE_KEYS if pose.turns else KEYS
    stiffness, damping, bound = (_symmetric(get(wall, key), pose.sizes) for key in keys)
    if not len(stiffness) == len(damping) == len(bound):
        raise Invalid("the matrices of the wall differ in size")
    if not _semidefinite(stiffness):
        raise Invalid("the stiffness has a negative eigenvalue")
    if not (_semidefinite(_sum(bound, damping, 1)) and _semidefinite(_sum(bound, damping, -1))):
        raise Invalid("the bound on the virtual damping is no bound")
    return stiffness, damping, bound


def _price(chain: Chain, loop: Mapping[str, Any], limits: tuple[Fraction, Fraction], pose: Pose) -> Fraction:
    """(h F + h_e M) T/2, where h − N ⪰ 0 with N_ij ≥ |∂²p/∂q_i∂q_j|."""
    if integer(get(loop, "delay_samples")):
        raise Invalid("a held torque needs no delay")
    curvature, most = number(get(loop, "curvature_m_per_rad2")), bends(chain)
    room = [[(curvature if i == k else 0) - x for k, x in enumerate(row)] for i, row in enumerate(most)]
    if not _semidefinite(room):
        raise Invalid("the hand's path can bend more than the curvature says")
    return (curvature * limits[0] + turning_bend(chain, pose) * limits[1]) * _period(loop) / 2


def _symmetric(rows: Any, sizes: range) -> Matrix:
    if not isinstance(rows, list) or len(rows) not in sizes:
        raise Invalid(f"a matrix of the wall has {' or '.join(map(str, sizes))} rows")
    matrix = [vector(row, len(rows)) for row in rows]
    if any(matrix[i][k] != matrix[k][i] for i in range(len(rows)) for k in range(i)):
        raise Invalid("a matrix of the wall is not symmetric")
    return matrix


def _sum(a: Matrix, b: Matrix, factor: Fraction | int) -> Matrix:
    return [[x + factor * y for x, y in zip(*rows, strict=True)] for rows in zip(a, b, strict=True)]


def _semidefinite(matrix: Matrix) -> bool:
    """No negative eigenvalue: symmetric elimination, where a pivot 0 has a row of zeros."""
    rest = [list(row) for row in matrix]
    while rest:
        pivot, *row = rest[0]
        if pivot < 0 or (pivot == 0 and any(row)):
            return False
        rest = [
            [x - (row[i] * y / pivot if pivot else 0) for x, y in zip(below[1:], row, strict=True)]
            for i, below in enumerate(rest[1:])
        ]
    return True
