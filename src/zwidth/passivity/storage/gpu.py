"""The rounds of the game on a graphics card: the functions of the processor, a group and a knot per thread.

States are improved in place and in any order there; all numbers are whole, and
every order ends at the same least storage function above the first guess.  So the
two agree to the bit.
"""

from __future__ import annotations

import numpy as np

from zwidth.loop.gpu import _cuda as cuda_or_message
from zwidth.passivity.storage.board import Board, Integers

_THREADS = 128

_SCRATCH = 2**26
"""Points in the hulls of all threads at once, each of three 64-bit numbers: 1.5 GiB."""


class OnCard:
    """V and the best moves of a board in the memory of a graphics card.

    Parameters
    ----------
    board
        What is played.
    value, choice
        As `sweep` has them; they stay as they are until `fetch`.

    Raises
    ------
    InputError
        If there is no card or no CUDA.
    """

    def __init__(self, board: Board, value: Integers, choice: Integers) -> None:
        cuda = cuda_or_message()
        points = board.width * board.knots.size
        self.steps, self.reach = board.steps, board.domain.reach
        self.groups = value.size // points if board.memory else len(value)
        self.items = self.groups * board.knots.size
        threads = min(self.items, max(_SCRATCH // points, _THREADS))
        self.own = value, choice
        self.states = [cuda.to_device(array.reshape(-1)) for array in self.own]
        self.rules = [cuda.to_device(array) for array in (board.forces, board.costs, board.knots)]
        self.ranges = cuda.device_array((3, self.groups), np.int64)
        self.points = [cuda.device_array((points, self.groups), np.int64) for _ in range(3)]
        self.hulls = [cuda.device_array((points, threads), np.int64) for _ in range(3)]
        self.improved = cuda.device_array(threads, np.int64)

    def round(self) -> int:
        """Improve every state; returns how many improved."""
        from zwidth.passivity.storage.cuda_kernel import gather, improve_all

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
        return int(self.improved.copy_to_host().sum())

    def fetch(self) -> None:
        """Bring V and the best moves back into the arrays that were given."""
        for array, on_card in zip(self.own, self.states, strict=True):
            array.reshape(-1)[:] = on_card.copy_to_host()


def _blocks(threads: int) -> int:
    return -(-threads // _THREADS)
