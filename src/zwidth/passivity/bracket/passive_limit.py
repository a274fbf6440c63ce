"""How far one parameter may go: a bracket, proved passive below and refuted above."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import inf
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device.device import Device
from zwidth.model.device.friction import FrictionCurve
from zwidth.model.device.instead import instead_of_device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.passivity.bracket.bracket import Bracket, parameter_of, refuse_without_part
from zwidth.passivity.bracket.search import NOTHING, Found, Search, approach, is_stepped
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.scope import Contact, as_contact
from zwidth.passivity.storage.chain_document import ChainStorage
from zwidth.passivity.storage.chain_program import ChainProgram, chain_program
from zwidth.passivity.storage.chain_table import DoesNotClose
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.hand_bounds import bounds_given, slow_hands
from zwidth.passivity.storage.program import FINE, STEPS, DynamicProgram, program_of, program_scope
from zwidth.passivity.storage.storage_function import CELLS, StorageFunction
from zwidth.passivity.storage.value_iteration import EFFORT, Effort, Until, checked_effort, time_limit
from zwidth.quantity.exact import Exact, RealLike

_SOME_SECONDS = 10.0  # what needs no announcement


def passive_limit(
    device: Device,
    environment: Environment | Any,
    parameter: str = "stiffness",
    *,
    penetration: RealLike | None = None,
    speed: RealLike | None = None,
    force_limit: bool = False,
    force_resolution: bool = False,
    friction: FrictionCurve | None = None,
    tolerance: float = 0.01,
    effort: float = EFFORT,
    seconds: float | None = None,
    iterate: bool = True,
    contact: str = "made and broken",
    progress: Callable[[int, int], None] | None = None,
    told: Callable[[float], None] | None = None,
) -> Bracket:
    """How far a parameter may go: proved passive on one side, refuted by a motion on the other.

    Contact is made and broken at will, unless `contact` says otherwise.  Without bounds on the hand the
    closed conditions are tried first, which cover every hand; where they end, and always where the hand is
    bounded, values are iterated as in `available_storage`.

    Parameters
    ----------
    device, environment
        The loop, without intervals.
    parameter
        A parameter of the environment ("stiffness", "damping") or of the device
        ("coulomb_friction", "device.damping", "sample_period", "resolution", …);
        of a wall, a solid, a `HuntCrossley` contact, a `NonlinearSpring` or a transfer function "gain", a
        factor on its force; of a `HuntCrossley` contact "stiffness" or "dissipation" too.  Of laws in a
        chain one of the environment that they render.
    penetration, speed
        Bounds on the hand [m; rad], [m/s; rad/s], or with units, as for `available_storage`.
    force_limit, force_resolution
        True to count in the device's force limit, the steps of its converter.
    friction
        Friction measured at several speeds, in place of the device's b and f_c.
    tolerance
        Relative width of the bracket that is wanted.
    effort
        How much is done before the bracket so far is returned: 1 is about a second of one core. Work is
        counted, not time, so that every machine finds the same, to the last bit.
    seconds
        Time after which it is returned as well [s]; `cut_by_time` says where it was. Default: none.
    iterate
        False for closed conditions alone, however long they take.
    contact
        "kept": of hands that stay inside alone, as `check` takes it; by closed conditions.
    progress
        Told (loops decided, about how many there will be).
    told
        Told up to how many seconds it may take, about, before values are iterated on a large grid.

    Raises
    ------
    InputError
        If there is no such parameter, or values cannot be iterated (see `available_storage`).
    """
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, {instead_of_device(device)}")
    if not isinstance(tolerance, int | float) or not 1e-6 <= tolerance < 1:
        raise InputError(
            f"tolerance must be a number from 1e-6 to 1, got {tolerance!r}: it is the relative width wanted"
        )
    if not isinstance(parameter, str):
        raise InputError(f"parameter is the name of one, such as 'stiffness', got {parameter!r}")
    law = as_environment(environment, device=device)
    refuse_without_part(parameter.removeprefix("device."), force_limit, force_resolution)
    asked = parameter_of(device, law, parameter)
    most = checked_effort(effort)
    time_limit(seconds)
    penetration, speed = bounds_given(device, penetration, speed)
    counted = penetration, speed, force_limit, force_resolution, friction
    of = as_contact(contact)
    if not iterate or of == "kept" or device.transmission is not None:  # of these closed forms alone know
        return _by_closed_forms(Search(asked, tolerance, Effort(), inf, progress), counted, of)
    in_a_chain = bool(laws_of(law))
    built: Callable[..., DynamicProgram | ChainProgram] = chain_program if in_a_chain else program_of
    closed = not (force_limit or force_resolution or friction is not None)
    every_hand = closed and penetration is None and speed is None
    no_grid: InputError | None = None
    if not is_stepped(law):
        try:
            at_first = built(device, law, *counted)
        except InputError as error:  # refused before anything is searched, unless closed forms may know
            if not every_hand:
                raise
            no_grid = error
    search = Search(asked, tolerance, Effort(time_limit(seconds)), most, progress)
    if friction is not None and asked.name in ("device.damping", "device.coulomb_friction"):
        raise InputError(f"{parameter} plays no part beside a friction curve: leave out one of the two")
    every = search.by_closed_forms() if closed else NOTHING
    known = every.passive, every.active
    settled = (no_grid is not None or is_stepped(law)) and known != (None, None)  # nothing narrows it
    if every_hand and (settled or search.is_close(*known)):
        return search.bracket(every, known)
    if no_grid is not None:
        raise no_grid
    if is_stepped(law):
        raise InputError(
            "a scene that is not linear, or of many elements, is decided for every hand, behind a virtual "
            "coupling, and read without encoder steps: give it one, the device resolution=0, and no bounds"
        )
    if isinstance(at_first, ChainProgram):  # one grid for all values: where the laws close as they are given
        built = partial(chain_program, domains=(at_first.counts,))

    def program(value: Exact) -> DynamicProgram | ChainProgram:
        return built(*asked.change(value), *counted)

    def slow(value: Exact) -> Certificate | None:
        return slow_hands(*asked.change(value), program(value).bounds.speed)

    has_closed_form = closed and not in_a_chain
    bounded_search = BoundedSearch(search, program, slow if has_closed_form else lambda _: None, every)
    left = min(most, time_limit(seconds)) - search.effort.spent
    if told is not None and bounded_search.at_first.takes_long and left > _SOME_SECONDS:
        told(left)
    return bounded_search.bracket()


def _by_closed_forms(search: Search, counted: tuple[Any, ...], contact: Contact) -> Bracket:
    if any(entry is not None and entry is not False for entry in counted):
        raise InputError(
            "bounds on the hand, what the actuator gives and a friction curve are counted in by value "
            "iteration alone, which knows no contact that is kept and no transmission: leave them out, or "
            "iterate"
        )
    every = search.by_closed_forms(contact)
    return search.bracket(every, (every.passive, every.active))


# A bracket of bounded hands: by what covers slow ones, and by value iteration on finer and finer grids.


Proof = Certificate | StorageFunction | ChainStorage


class BoundedSearch:
    """Looks for the two values of a bounded hand, and keeps the evidence at each.

    `search`: the parameter, and how much may still be done; `program`: the dynamic program at a value;
    `slow`: a closed form that covers this hand at a value, or None; `every`: what is known of every hand.
    """

    def __init__(
        self,
        search: Search,
        program: Callable[[Exact], DynamicProgram | ChainProgram],
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
            self.proving.holds = partial(self._is_proved, steps)
            self.refuting.holds = partial(self._gains, fine)
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
