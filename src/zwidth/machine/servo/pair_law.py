"""The law of a served pair: the simulator's own, on arrays that end, run for as long as it is served.

    f_l(k) = K_l (x_l(k) − x_f(k − n)) + …        see `zwidth.model.pairs`

A reading is looked back at for as long as the link is late, so of full arrays that much is put in front, and
they are filled again.
"""

from __future__ import annotations

from zwidth.loop.pair.kernel import Arm, command, hear
from zwidth.loop.pair.setup import prepare_pair
from zwidth.model.operator import PrescribedMotion
from zwidth.model.pairs import LONGEST, Pair
from zwidth.native.compiled import Array, compiled
from zwidth.quantity.exact import Exact

_BACK = 2 * LONGEST + 2
"""Samples that are looked back at, at most: there, back, and one before that for the speed."""

_ROOM = 8 * _BACK


@compiled
def _forces(leader: Arm, follower: Arm, k: int, x: float, y: float) -> None:
    for arm, reading in ((leader, x), (follower, y)):
        arm.readings[k] = arm.sent[k] = reading
    hear(leader, follower, k)
    hear(follower, leader, k)
    command(leader, k, 1)
    command(follower, k, 1)


@compiled
def _moved_to_the_front(kept: Array, count: int) -> None:
    last = kept.shape[0] - count
    for i in range(count):
        kept[i] = kept[last + i]


class PairLaw:
    """The forces of both sides, sample by sample; before the first both arms had always been where they are.

    Of a pair of one rate, at which everything is computed.
    """

    def __init__(self, pair: Pair) -> None:
        still = PrescribedMotion(lambda t: 0.0)
        duration = Exact(_ROOM * pair.sample_period)
        setup = prepare_pair(
            pair, still, still, duration, encoder_phase=(0.0, 0.0), amplifier=None, points_per_sample=1
        )
        self._arms = setup.arms
        self.begin()
        self.forces(0.0, 0.0)  # found in their library before the clock runs
        self.begin()

    def begin(self) -> None:
        """The next sample is the first."""
        self._k = 0

    def forces(self, x: float, y: float) -> tuple[float, float]:
        """Of leader and follower at these readings, positive against x [N; N·m]."""
        leader, follower = self._arms
        if self._k == leader.commands.shape[0]:
            for arm in self._arms:
                _moved_to_the_front(arm.readings, _BACK)
                _moved_to_the_front(arm.sent, _BACK)
            self._k = _BACK
        _forces(leader, follower, self._k, x, y)
        found = float(leader.commands[self._k]), float(follower.commands[self._k])
        self._k += 1
        return found
