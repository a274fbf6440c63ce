"""Value iteration on a graphics card: the functions of the processor, a group and a node per thread.

States are improved in place and in any order there; all numbers are whole, and
every order ends at the same least storage function above the first guess.  So the
two agree to the bit.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from zwidth.loop.gpu import _cuda as cuda_or_message
from zwidth.passivity.storage.losses import Integers
from zwidth.passivity.storage.solve.effort import Until
from zwidth.passivity.storage.solve.hull import sweep
from zwidth.passivity.storage.solve.value_iteration import BestMoves, Move

_THREADS = 128

_STATE = 5e-9
"""What a state costs in a round, in the unit of `effort`."""

_SCRATCH = 2**26
"""Points in the hulls of all threads at once, each of three 64-bit numbers: 1.5 GiB."""


class OnCard(BestMoves):
    """V and the best moves of a grid in the memory of a graphics card.

    Parameters
    ----------
    value, groups, move_at
        As `BestMoves` has them; V is brought back when nothing improves any more.
    forces, costs, nodes, reach, steps
        As `sweep` has them.

    Raises
    ------
    InputError
        If there is no card or no CUDA.
    """

    def __init__(
        self,
        value: Integers,
        groups: int,
        move_at: Callable[[int], Move],
        forces: Integers,
        costs: Integers,
        nodes: Integers,
        reach: int,
        steps: int,
    ) -> None:
        cuda = cuda_or_message()
        super().__init__(value, groups, move_at, sweep, (), work=_STATE)
        points = (2 * reach + 1) * nodes.size
        self.steps, self.reach, self.groups = steps, reach, groups
        threads = min(groups * nodes.size, max(_SCRATCH // points, _THREADS))
        self.states = [cuda.to_device(array.reshape(-1)) for array in (self.value, self.choice)]
        self.rules = [cuda.to_device(array) for array in (forces, costs, nodes)]
        self.ranges = cuda.device_array((3, groups), np.int64)
        self.points = [cuda.device_array((points, groups), np.int64) for _ in range(3)]
        self.hulls = [cuda.device_array((points, threads), np.int64) for _ in range(3)]
        self.improved = cuda.device_array(threads, np.int64)

    def improve(self, pool: ThreadPoolExecutor, until: Until) -> int:
        """One round; returns how many states improved."""
        from zwidth.passivity.storage.solve.cuda_kernel import gather, improve_all

        values, choices = self.states
        gather[_blocks(self.groups), _THREADS](
            values, *self.rules, self.steps, self.reach, self.ranges, *self.points
        )
        improve_all[_blocks(self.improved.size), _THREADS](
            values,
            choices,
            *self.rules,
            self.reach,
            self.ranges,
            *self.points[1:],
            *self.hulls,
            self.improved,
        )
        improved = int(self.improved.copy_to_host().sum())
        if improved == 0:
            self._fetch()
        return improved

    def gaining_cycle(self) -> tuple[Move, ...]:
        """The moves of a cycle among the best moves."""
        self._fetch()
        return super().gaining_cycle()

    def _fetch(self) -> None:
        for array, on_card in zip((self.value, self.choice), self.states, strict=True):
            array.reshape(-1)[:] = on_card.copy_to_host()


def _blocks(threads: int) -> int:
    return -(-threads // _THREADS)
