"""A motion that is prescribed and repeated: what each round takes out, and nothing else.

The same forces as `kernel.run`, for a regular clock and an amplifier that gives its force at once.  A round
takes out

    −∫ f dx − f_c Σ|Δx| − (b/T) Σ Δx²

Once the law has begun two rounds in the same state to the bit, all that follow are the same: they are
counted, not run.  So are those of a hand that has lost the same to the bit in very many rounds: the law only
adds to its account what the hand loses.
"""

from __future__ import annotations

from zwidth.loop.kernel import commanded
from zwidth.loop.law import PHASE, RESOLUTION, measured
from zwidth.native.compiled import Array, compiled

LOSING = 40
"""Rounds with the same loss after which a hand goes on losing."""


@compiled
def run_rounds(
    positions: Array,
    law: Array,
    memory: Array,
    before: Array,
    state: Array,
    waiting: Array,
    late: int,
    share: float,
    coulomb: float,
    drag: float,
    taken: Array,
) -> float:
    """Fill in what is taken out in all after each round [J]; returns what friction takes in them all.

    Parameters
    ----------
    positions
        One round; its end leads to its beginning.
    law, memory, state
        See `law` and `plant`; memory is that of a hand at rest at the first position, state is scratch.
    before
        Scratch, as long as the memory.
    waiting
        Scratch for the commands that wait, late + 2 of them, zeros.
    late, share
        d and α of a delay (d + α) T.
    coulomb, drag
        f_c, and b/T.
    taken
        One for each round.
    """
    samples, kept, rounds = positions.shape[0], waiting.shape[0], taken.shape[0]
    needed = 1 + (late + 1 + samples - 1) // samples  # rounds until no command of another one is waiting
    total, paid, same, losing, last, k = 0.0, 0.0, 0, 0, 0.0, 0
    for r in range(rounds):
        for i in range(memory.shape[0]):
            before[i] = memory[i]
        gain, lost = 0.0, 0.0
        for i in range(samples):
            x = positions[i]
            moved = (positions[i + 1] if i + 1 < samples else positions[0]) - x
            waiting[k % kept] = commanded(state, law, memory, measured(x, law[RESOLUTION], law[PHASE]))
            force = waiting[(k + kept - late) % kept]
            if share > 0.0:
                force += share * (waiting[(k + kept - late - 1) % kept] - force)
            friction = coulomb * abs(moved) + drag * moved * moved
            gain -= force * moved + friction
            lost += friction
            k += 1
        total += gain
        paid += lost
        taken[r] = total
        same = same + 1 if unchanged(memory, before) else 0
        losing = losing + 1 if gain < 0.0 and gain == last else 0
        last = gain
        if same > needed or losing > LOSING:
            for later in range(r + 1, rounds):
                total += gain
                taken[later] = total
            return paid + (rounds - 1 - r) * lost
    return paid


@compiled
def unchanged(memory: Array, before: Array) -> bool:
    """True if every number is the same."""
    same = True
    for i in range(memory.shape[0]):
        same = same and memory[i] == before[i]
    return same
