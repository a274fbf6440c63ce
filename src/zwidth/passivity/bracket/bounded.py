"""A bracket of bounded hands: by what covers slow ones, and by value iteration on finer and finer grids."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from zwidth.errors import InputError
from zwidth.passivity.bracket.bracket import Bracket
from zwidth.passivity.bracket.search import Found, Search
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.storage.evidence.coarse import CELLS
from zwidth.passivity.storage.evidence.gain import Gain
from zwidth.passivity.storage.evidence.storage_function import StorageFunction
from zwidth.passivity.storage.program import FINE, STEPS, DynamicProgram, program_scope
from zwidth.passivity.storage.row.program import RowProgram
from zwidth.passivity.storage.row.storage_function import RowStorage
from zwidth.passivity.storage.row.table import DoesNotClose
from zwidth.passivity.storage.solve.effort import Until
from zwidth.passivity.storage.two_sides import approach
from zwidth.quantity.exact import Exact

Proof = Certificate | StorageFunction | RowStorage


class BoundedSearch:
    """Looks for the two values of a bounded hand, and keeps the evidence at each.

    Parameters
    ----------
    search
        The parameter, and how much may still be done.
    program
        The dynamic program at a value.
    slow
        A closed form that covers this hand at a value, or None.
    every
        What is known of every hand.
    """

    def __init__(
        self,
        search: Search,
        program: Callable[[Exact], DynamicProgram | RowProgram],
        slow: Callable[[Exact], Certificate | None],
        every: Found,
    ) -> None:
        self.search, self.program, self.slow, self.every = search, program, slow, every
        self.at_first = program(search.first)
        self.proofs: dict[Exact, Proof] = {}
        self.motions: dict[Exact, Gain] = {}
        self.proving, self.refuting = search.sides(self._covers_slow_hands, partial(self._gains, FINE[0]))

    def bracket(self) -> Bracket:
        """The values, once they are close enough or enough was done."""
        slowest = self._slow_limit()
        every, towards = self.every, self.proving.towards
        closed = _nearer(every.passive, slowest, towards)
        if closed is None and self.at_first.too_large is not None and not self.at_first.has_cells:
            raise InputError(self.at_first.too_large)
        if every.passive is not None and every.certificate is not None:
            self.proofs[every.passive] = every.certificate
        by_closed_form = None if closed is None else self.proofs.get(closed)
        if self.at_first.is_large:
            self.proving.good = closed
            self._on_cells()
        self._on_steps()
        passive, active = _nearer(self.proving.good, every.passive, towards), self.refuting.good
        if not self.search.is_close(passive, active):
            passive = _nearer(passive, slowest, towards)
        proof = None if passive is None else self.proofs[passive]
        storage = None if isinstance(proof, Certificate) else proof
        certificate = proof if isinstance(proof, Certificate) else None
        if storage is not None:
            certificate = storage.certificate()
            if not certificate.verify():  # nothing is claimed that the checker does not accept
                passive, storage = closed, None
                certificate = by_closed_form if isinstance(by_closed_form, Certificate) else None
        motion = None if active is None else self.motions[active]
        scope = program_scope(*self.search.parameter.change(self.search.first), self.at_first)
        known = Found(passive, active, certificate, motion, scope)
        beyond = every.passive, _nearer(every.active, active, self.refuting.towards)
        return self.search.bracket(known, beyond, self.at_first.bounds, storage)

    def _slow_limit(self) -> Exact | None:
        """The last value at which a closed form covers this hand; None without one."""
        side, nobody = self.search.sides(self._covers_slow_hands, lambda *_: False)
        approach(side, nobody, self.search.tolerance / 40, self.search.most, self.search.effort)
        return side.good

    def _on_cells(self) -> None:
        """Proofs on coarse cells where counts are too many, each with half of what may still be done."""
        for cells in CELLS:
            self.proving.holds = partial(self._is_proved_on_cells, cells)
            self._approach(self.search.share(0.5))
            if self._is_done():
                break

    def _on_steps(self) -> None:
        """Proofs and motions on finer and finer steps; no more once nothing is proved on one of them."""
        for steps, fine in zip(STEPS, (FINE[0], *[FINE[1]] * 3), strict=True):
            if self.search.effort() >= self.search.most or self._is_done():
                break
            self.proving.holds, self.refuting.holds = (
                partial(self._is_proved, steps),
                partial(self._gains, fine),
            )
            self._approach(self.search.most)
            if self.proving.good is None:
                break

    def _approach(self, most: float) -> None:
        approach(self.proving, self.refuting, self.search.tolerance / 4, most, self.search.effort)

    def _until(self, most: float) -> Until:
        return Until(self.search.effort, most)

    def _is_done(self) -> bool:
        return self.search.is_close(self.proving.good, self.refuting.good)

    def _covers_slow_hands(self, value: Exact, _: float) -> bool:
        self.search.count()
        return self._keep_proof(value, self.slow(value))

    def _is_proved_on_cells(self, cells: int, value: Exact, most: float) -> bool:
        self.search.count()
        proof = self.program(value).prove_on_cells(cells, self._until(most), self.search.report)
        return self._keep_proof(value, proof)

    def _is_proved(self, steps: int, value: Exact, most: float) -> bool:
        self.search.count()
        try:
            program = self.program(value)
            until = self._until(min(most, self.search.most - program.checking(steps)))
            return self._keep_proof(value, program.prove(steps, until, self.search.report))
        except DoesNotClose:
            return False

    def _gains(self, fine: int, value: Exact, most: float) -> bool:
        self.search.count()
        try:
            motion = self.program(value).refute(fine, self._until(most), self.search.report)
        except DoesNotClose:
            return False
        if motion is not None:
            self.motions[value] = motion
        return motion is not None

    def _keep_proof(self, value: Exact, proof: Proof | None) -> bool:
        """Whether there is one; of storage functions, which are large, only the last is kept."""
        if proof is None:
            return False
        if not isinstance(proof, Certificate):
            self.proofs = {v: other for v, other in self.proofs.items() if isinstance(other, Certificate)}
        self.proofs[value] = proof
        return True


def _nearer(a: Exact | None, b: Exact | None, towards: int) -> Exact | None:
    """The value at which a claim reaches farther; the one there is, if there is only one."""
    known = [value for value in (a, b) if value is not None]
    return max(known, key=lambda value: towards * value) if known else None
