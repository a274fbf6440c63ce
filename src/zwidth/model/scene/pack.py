"""A scene as the two arrays that its compiled step runs on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.model.scene import forces as at
from zwidth.model.scene.element import Across, Element, Ties, unheld
from zwidth.model.scene.forces import stored_in
from zwidth.model.scene.nonlinear import COULOMB

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_STICKS = 1e8
"""M/ε of friction: each round of the multipliers leaves about ε/M of the creep of the round before."""

_HELD = 1e12
"""F/ε for each m/s of friction between the port and the ground, where nothing gives way."""


@dataclass(frozen=True, eq=False)
class Packed:
    """A scene ready to be stepped.

    Attributes
    ----------
    numbers, memory
        What the step reads, and what it remembers, at rest.
    linear, others
        The elements in their order there.
    nodes
        The free nodes in their order there.
    """

    numbers: Array
    memory: Array
    linear: tuple[Element, ...]
    others: tuple[Element, ...]
    nodes: tuple[str, ...]

    @property
    def waves(self) -> int:
        """Where b of the linear elements stands in the memory."""
        return at.WAVES

    @property
    def states(self) -> int:
        """Where the states of the others stand."""
        return at.WAVES + len(self.linear)

    @property
    def places(self) -> int:
        """Where the positions of the free nodes stand; their velocities stand before them."""
        return self.states + 2 * len(self.others) + len(self.nodes)

    @property
    def work(self) -> int:
        """Where the work into each element stands, linear ones first; their losses stand behind."""
        return self.places + len(self.nodes)

    def stored(self, m: Array) -> Array:
        """The energy in each element, linear ones first, of what is remembered [J]."""
        p = self.numbers
        waves = m[self.waves : self.states]
        rows = p[at.HEADER : at.HEADER + at.ROW * len(waves)].reshape(-1, at.ROW)
        linear = np.where(rows[:, 1] != 0.0, p[at.PERIOD] * waves**2 / (4.0 * rows[:, 0]), 0.0)
        first = int(p[at.OTHER_ROWS])
        others = [
            stored_in(p, p[first + at.ROW * i], int(p[first + at.ROW * i + 1]), m[self.states + i])
            for i in range(len(self.others))
        ]
        return np.array([*linear, *others])


def pack(elements: Sequence[Element], net: Ties, period: Fraction) -> Packed:
    """The arrays; the elements are those that `net` has, without levers."""
    joined = list(zip(elements, net.across, strict=True))
    linear = [(e, a) for e, a in joined if e.law is None]
    others = [(e, a) for e, a in joined if e.law is not None]
    resistances = [float(e.resistance(period)) for e, _ in linear]
    factor = _factor(linear, resistances, net.roots)
    place = {node: i for i, node in enumerate(factor.order)}
    rows = [[r, float(e.reflection), *_ends(a, place)] for (e, a), r in zip(linear, resistances, strict=True)]
    begins = at.HEADER + at.ROW * len(joined)
    other_rows: list[list[float]] = []
    laws: list[float] = []
    for element, a in others:
        assert element.law is not None
        other_rows.append([element.law.code, float(begins + len(laws)), *_ends(a, place)])
        laws += element.law.numbers
    columns = begins + len(laws)
    heads, pairs = _columns(factor, columns + 3 * len(factor.order))
    coupled = _compliance(factor, [_row(a, place, len(place)) for _, a in others])
    for i, (element, _) in enumerate(others):
        if element.law is not None and element.law.code == COULOMB:
            own = float(coupled[i, i])
            laws[int(other_rows[i][1]) - begins + 1] = (
                _STICKS / own if own else _HELD * element.law.numbers[0]
            )
    header = [
        float(period), float(len(place)), float(len(linear)), float(len(others)),
        float(at.HEADER + at.ROW * len(linear)), float(columns), float(columns + len(heads) + len(pairs)),
    ]  # fmt: skip
    numbers = [*header, *_flat(rows), *_flat(other_rows), *laws, *heads, *pairs]
    packed = np.array([*numbers, *coupled.ravel()])
    return Packed(
        packed,
        at.scene_at_rest(packed, 0, 0.0),
        tuple(e for e, _ in linear),
        tuple(e for e, _ in others),
        tuple(net.roots[i] for i in factor.order),
    )


def _factor(
    linear: Sequence[tuple[Element, Across]], resistances: Sequence[float], roots: Sequence[str]
) -> Factor:
    rows: list[dict[int, float]] = [{} for _ in roots]
    for (_, across), r in zip(linear, resistances, strict=True):
        for i, a in across.free.items():
            for j, b in across.free.items():
                rows[i][j] = rows[i].get(j, 0.0) + r * float(a) * float(b)
    found = factorised(rows)
    if isinstance(found, int):
        raise unheld(roots[found])
    return found


def _ends(across: Across, place: dict[int, int]) -> list[float]:
    """Two free nodes, each with its weight, and the weight of the port."""
    ends = [float(n) for i, weight in across.free.items() for n in (place[i], weight)]
    return [*ends, *[0.0] * (4 - len(ends)), float(across.port)]


def _row(across: Across, place: dict[int, int], size: int) -> Array:
    row = np.zeros(size)
    for i, weight in across.free.items():
        row[place[i]] = float(weight)
    return row


def _columns(factor: Factor, begin: int) -> tuple[list[float], list[float]]:
    heads: list[float] = []
    pairs: list[float] = []
    for inverse, column in zip(factor.inverse, factor.columns, strict=True):
        heads += [float(begin + len(pairs)), float(len(column)), inverse]
        pairs += [number for j, value in column for number in (float(j), value)]
    return heads, pairs


def _compliance(factor: Factor, rows: Sequence[Array]) -> Array:
    """N G⁻¹ Nᵀ."""
    solved = []
    for row in rows:
        x = row.copy()
        for i, column in enumerate(factor.columns):
            for j, value in column:
                x[j] -= value * x[i]
        for i in range(len(x) - 1, -1, -1):
            x[i] = x[i] * factor.inverse[i] - sum(value * x[j] for j, value in factor.columns[i])
        solved.append(x)
    return np.array([[float(a @ x) for x in solved] for a in rows]).reshape(len(rows), len(rows))


def _flat(rows: Sequence[Sequence[float]]) -> list[float]:
    return [number for row in rows for number in row]


# The node matrix of a scene as L D Lᵀ, in the order that fills in least: a chain or a tree costs O(n).
#
# G = Σ R aᵀa over the linear elements does not change from step to step; it is factorised once.  Eliminating
# next the node with the fewest neighbours fills in nothing on a tree (Parter 1961).

_LEAST_PIVOT = 1e-13
"""Below this part of its diagonal a pivot is rounding alone."""


class Factor(NamedTuple):
    """L and D: of each pivot its node, its 1/d, and the column of L below it as (place, value)."""

    order: tuple[int, ...]
    inverse: tuple[float, ...]
    columns: tuple[tuple[tuple[int, float], ...], ...]


def factorised(rows: Sequence[dict[int, float]]) -> Factor | int:
    """L D Lᵀ of a symmetric matrix given by its rows; or the number of a node that nothing holds."""
    left = [dict(row) for row in rows]
    first = [row.get(i, 0.0) for i, row in enumerate(left)]
    heap = [(len(row), i) for i, row in enumerate(left)]
    heapify(heap)
    done: set[int] = set()
    order: list[int] = []
    columns: list[dict[int, float]] = []
    inverse: list[float] = []
    while heap:
        size, i = heappop(heap)
        if i in done or size != len(left[i]):
            continue
        done.add(i)
        row = left[i]
        pivot = row.pop(i, 0.0)
        if not pivot > _LEAST_PIVOT * first[i]:
            return i
        column = {j: value / pivot for j, value in row.items()}
        for j, share in column.items():
            del left[j][i]
            for k, value in row.items():
                left[j][k] = left[j].get(k, 0.0) - share * value
            heappush(heap, (len(left[j]), j))
        order.append(i)
        columns.append(column)
        inverse.append(1.0 / pivot)
    place = {node: at for at, node in enumerate(order)}
    numbered = tuple(tuple(sorted((place[j], value) for j, value in c.items())) for c in columns)
    return Factor(tuple(order), tuple(inverse), numbered)
