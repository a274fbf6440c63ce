"""An arm of several joints renders a linear wall passively wherever it is in its region.

    δ_m − c ≻ Jᵀ R J    or, for a parallel arm, at the hand    Σ b_i w_i w_iᵀ ≻ R    in the whole region
    R = (2d + 1) KT/2 + A,    K ⪰ 0,    A ⪰ B,    A ⪰ −B

K and B of the wall, d whole samples of delay, T the period. A stands for |B|: all that the proof takes from
it is aᵀAa + bᵀAb ± 2aᵀBb ≥ 0. c = h F T/2 where the torque is held over a period, else 0: h bounds the second
derivatives of the hand's position, F the force of the wall. The hand's position is read without steps.
In pose the last coordinates are rotations, `arm_pose`, and c = (h F + h_e M) T/2: M bounds what the wall
gives for them, no less than its moment.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from .arm_cells import Function, positive_in
from .arm_chain import bends, chain_surplus, read_chain, vector
from .arm_legs import legs_surplus, read_legs
from .arm_pose import Pose, for_every_rest, in_words, read_pose, turning, turning_bend
from .enclosure import ONE, Jet, enclosed
from .reading import Invalid, get, integer, number

MOST_DELAY = 10**6
KEYS = ("stiffness_N_per_m", "virtual_damping_N_s_per_m", "damping_bound_N_s_per_m")
POSE_KEYS = ("stiffness_N_m_rad", "virtual_damping_N_m_s_rad", "damping_bound_N_m_s_rad")

Matrix = list[list[Fraction]]


class Claim(NamedTuple):
    """S(x) ≻ 0 in a box of coordinates x, the joints or the hand's position."""

    box: list[tuple[Fraction, Fraction]]
    matrix: Function
    words: str


def arm(document: Mapping[str, Any]) -> str:
    claim = _claim(document)
    cells = positive_in(tuple((enclosed(low)[0], enclosed(high)[1]) for low, high in claim.box), claim.matrix)
    return f"{claim.words}; {cells} cells"


def matrix_at(document: Mapping[str, Any], place: Sequence[Fraction]) -> list[list[float]]:
    """S at one place, its rows from the diagonal on: to see that a document is of the arm that was meant."""
    found = _claim(document).matrix([Jet(enclosed(x)) for x in place])
    return [[sum(s.value) / (2 * ONE) for s in row] for row in found]


def _claim(document: Mapping[str, Any]) -> Claim:
    machine, wall, loop = (get(document, key) for key in ("arm", "wall", "loop"))
    pose, force, geometry = read_pose(wall), _held_force(loop), get(machine, "geometry")
    need = [[enclosed(x) for x in row] for row in for_every_rest(_need(wall, loop, pose), pose)]
    torque = "follows the arm" if force is None else f"is held, for forces up to {float(force):g} N"
    words = "no motion of the hand with {} takes energy out, read without encoder steps; the torque " + torque
    if geometry == "chain":
        chain = read_chain(machine)
        price = Fraction(0) if force is None else _price(bends(chain), loop, force)
        if pose.turns and force is not None:
            moment = _moment(loop)
            price += turning_bend(chain, pose) * moment * number(get(loop, "sample_period_s")) / 2
            words += f" and moments up to {float(moment):g} N·m"
        box = [(joint.low, joint.high) for joint in chain.joints]
        matrix = chain_surplus(chain, need, price, turning(machine, chain, pose) if pose.turns else None)
        return Claim(box, matrix, words.format("every joint in its range") + in_words(wall, pose))
    if geometry != "legs":
        raise Invalid("the geometry is chain or legs")
    if pose.turns:
        raise Invalid("a parallel arm holds a point, and no pose")
    legs = read_legs(machine)
    if len(need) != len(legs.legs):
        raise Invalid("the wall has as many coordinates as the arm has legs")
    if force is not None:
        raise Invalid("the second derivatives of a parallel arm are not bounded here")
    box = list(zip(legs.low, legs.high, strict=True))
    return Claim(box, legs_surplus(legs, need), words.format("its position in the box"))


def _need(wall: Mapping[str, Any], loop: Mapping[str, Any], pose: Pose) -> Matrix:
    """R [N·s/m; in pose N·s/rad and N·m·s/rad, too]."""
    if get(loop, "encoder") != "ideal":
        raise Invalid("the proof is of an ideal encoder")
    period, delay = number(get(loop, "sample_period_s")), integer(get(loop, "delay_samples"))
    if period <= 0 or delay > MOST_DELAY:
        raise Invalid("T must be > 0, and the delay not too many samples")
    keys = POSE_KEYS if pose.turns else KEYS
    stiffness, damping, bound = (_symmetric(get(wall, key), pose.sizes) for key in keys)
    if not len(stiffness) == len(damping) == len(bound):
        raise Invalid("the matrices of the wall differ in size")
    if not _semidefinite(stiffness):
        raise Invalid("the stiffness has a negative eigenvalue")
    if not (_semidefinite(_sum(bound, damping, 1)) and _semidefinite(_sum(bound, damping, -1))):
        raise Invalid("the bound on the virtual damping is no bound")
    return _sum(bound, stiffness, (2 * delay + 1) * period / 2)


def _held_force(loop: Mapping[str, Any]) -> Fraction | None:
    torque = get(loop, "torque")
    if torque == "follows the arm":
        return None
    if torque != "held":
        raise Invalid("the torque follows the arm, or is held")
    force = number(get(loop, "largest_force_N"))
    if force < 0 or integer(get(loop, "delay_samples")):
        raise Invalid("a held torque needs a largest force ≥ 0, and no delay")
    return force


def _price(most: Matrix, loop: Mapping[str, Any], force: Fraction) -> Fraction:
    """h F T/2, where h − N ⪰ 0 with N_ij ≥ |∂²p/∂q_i∂q_j|."""
    curvature = number(get(loop, "curvature_m_per_rad2"))
    room = [[(curvature if i == k else 0) - x for k, x in enumerate(row)] for i, row in enumerate(most)]
    if not _semidefinite(room):
        raise Invalid("the hand's path can bend more than the curvature says")
    return curvature * force * number(get(loop, "sample_period_s")) / 2


def _moment(loop: Mapping[str, Any]) -> Fraction:
    moment = number(get(loop, "largest_moment_N_m"))
    if moment < 0:
        raise Invalid("a held torque needs a largest moment ≥ 0")
    return moment


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
