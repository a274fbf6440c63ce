"""A scene stepped by itself, with the account of its energy."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from zwidth.errors import InputError
from zwidth.model.scene import forces as at
from zwidth.model.scene.scene import Scene
from zwidth.model.scene.step import across, scene_force
from zwidth.native.compiled import compiled
from zwidth.quantity.exact import RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

PERIOD_WHY = "a step takes time"


@compiled
def _follow(numbers: Array, memory: Array, readings: Array, forces: Array) -> None:
    for k in range(readings.shape[0]):
        forces[k] = scene_force(numbers, 0, memory, 0, readings[k])


class SceneRun:
    """A scene that is moved at its port, one step after the other.

    Parameters
    ----------
    scene
        What is moved; it begins at rest.
    sample_period
        T > 0 of a step [s].

    Raises
    ------
    InputError
        If T is no time > 0, or a node is held by nothing but what may let go of it.
    """

    def __init__(self, scene: Scene, sample_period: RealLike) -> None:
        period: Fraction = read_number(
            sample_period, GLOSSARY["sample_period"], "sample_period", bound="> 0", why=PERIOD_WHY
        ).fraction
        self.scene = scene
        self._packed = scene.packed(period)
        self._places = scene.ties.places
        self._memory = self._packed.memory.copy()
        self._stored_at_first = self._packed.stored(self._memory)
        self._lines = {e.title: i for i, e in enumerate(self._packed.linear) if e.leads_elsewhere}
        self._speed = 0.0

    def step(self, move: float = 0.0, forces: Mapping[str, float] | None = None) -> float:
        """The mean force [N; N·m] over a step in which the port moves by `move` [m; rad].

        Parameters
        ----------
        move
            0 for a scene without a port.
        forces
            Of lines that end here, by their names, the force that each gives its node over the step
            [N; N·m]; of a line that is left out 0.

        Raises
        ------
        InputError
            If no line of such a name ends here, or a number is not finite.
        """
        for name, force in (forces or {}).items():
            if name not in self._lines or not isfinite(force):
                raise InputError(
                    f"forces are finite and of the lines that end here, {', '.join(self._lines) or 'none'}; "
                    f"got {force!r} of {name!r}"
                )
            self._memory[self._packed.waves + self._lines[name]] = -force
        return float(self.follow([self._memory[at.READING] + move])[0])

    def moved(self, line: str) -> float:
        """By how much the node where a line ends has moved in the last step [m; rad]."""
        numbers, row = self._packed.numbers, at.HEADER + at.ROW * self._lines[line]
        velocities = self._packed.places - len(self._packed.nodes)
        return float(numbers[at.PERIOD] * across(numbers, row, self._memory, velocities, self._speed))

    def follow(self, positions: ArrayLike) -> Array:
        """The mean forces of steps that end with the port at these positions [m; rad].

        Raises
        ------
        InputError
            If there is no position, or one is not finite.
        """
        try:
            readings = np.atleast_1d(np.asarray(positions, dtype=np.float64))
        except (TypeError, ValueError):
            readings = np.empty(0)
        if readings.ndim != 1 or not readings.size or not np.isfinite(readings).all():
            raise InputError(
                f"positions of the port are finite numbers, one at least, in a row, got {positions!r}"
            )
        forces = np.empty_like(readings)
        before = self._memory[at.READING] if len(readings) < 2 else readings[-2]
        _follow(self._packed.numbers, self._memory, readings, forces)
        self._speed = float(readings[-1] - before) / self._packed.numbers[at.PERIOD]
        return forces

    @property
    def energy_at_first(self) -> float:
        """What contacts and springs through points held at rest, before the first step [J]."""
        return float(self._stored_at_first.sum())

    @property
    def positions(self) -> Mapping[str, float]:
        """Where every node is [m; rad], counted from where it was at first."""
        packed = self._packed
        first = packed.places
        known = dict(zip(packed.nodes, self._memory[first : first + len(packed.nodes)], strict=True))
        if self.scene.port:
            known[self.scene.port] = self._memory[at.READING]
        return {
            node: float(known.get(root, 0.0)) * float(ratio) for node, (root, ratio) in self._places.items()
        }

    @property
    def velocities(self) -> Mapping[str, float]:
        """The velocity of every mass at the end of the last step, by its node [m/s; rad/s]."""
        packed, numbers = self._packed, self._packed.numbers
        return {
            e.nodes[0]: float(-self._memory[packed.waves + i] / numbers[at.HEADER + at.ROW * i])
            for i, e in enumerate(packed.linear)
            if e.reflection < 0
        }

    def account(self) -> xr.Dataset:
        """Where the energy of the port went, element by element.

        Returns
        -------
        xarray.Dataset
            Along `element` the work into it, what it has stored since the start and what it has lost [J]; in
            the attributes the work of the port, and what is left over, which is rounding.
        """
        import xarray as xr

        packed, m = self._packed, self._memory
        count = len(packed.linear) + len(packed.others)
        own = dict(zip(map(id, self.scene.elements), self.scene.titles, strict=True))
        columns = {
            "work": (m[packed.work : packed.work + count], "energy into the element"),
            "stored": (packed.stored(m) - self._stored_at_first, "energy stored since the start"),
            "lost": (m[packed.work + count : packed.work + 2 * count], "energy turned into heat"),
        }
        return xr.Dataset(
            {
                name: ("element", values.copy(), {"units": "J", "long_name": meaning})
                for name, (values, meaning) in columns.items()
            },
            coords={"element": [own[id(e)] for e in (*packed.linear, *packed.others)]},
            attrs={"port_work_J": float(m[at.WORK]), "left_over_J": float(m[at.LEFT_OVER])},
        )
