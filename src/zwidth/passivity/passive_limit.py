"""How far one parameter may go: a bracket, proved passive below and refuted above."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, fields
from fractions import Fraction
from math import inf
from typing import Any, NamedTuple

from zwidth.device.device import Device
from zwidth.device.friction import FrictionCurve
from zwidth.environment.environment import Environment
from zwidth.environment.hunt_crossley import HuntCrossley
from zwidth.environment.nonlinear_spring import NonlinearSpring
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.document import unit_suffix
from zwidth.passivity.result import Result, evidence_of
from zwidth.passivity.scope import Scope
from zwidth.passivity.storage.evidence.coarse import CELLS
from zwidth.passivity.storage.evidence.gain import Gain
from zwidth.passivity.storage.evidence.storage_function import StorageFunction
from zwidth.passivity.storage.hand_bounds import HandBounds
from zwidth.passivity.storage.program import FINE, STEPS, DynamicProgram, program_of, program_scope
from zwidth.passivity.storage.row.program import RowProgram, row_program
from zwidth.passivity.storage.row.storage_function import RowStorage
from zwidth.passivity.storage.row.table import DoesNotClose
from zwidth.passivity.storage.slow_hands import slow_hands
from zwidth.passivity.storage.solution import patience
from zwidth.passivity.storage.solve.value_iteration import Progress
from zwidth.passivity.storage.two_sides import Side, approach
from zwidth.passivity.witness.violation import Violation
from zwidth.passivity.witness.witness import Witness
from zwidth.passivity.wording import describe_hands, lines
from zwidth.quantity.exact import Exact, RealLike, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import in_unit, in_words
from zwidth.rendering.rendered import Rendered

MORE_IS_SAFER = frozenset({"device.damping", "device.coulomb_friction", "device.rate"})
"""Parameters of which a loop needs enough; of all others it may have too much."""

_Holds = Callable[[Exact, float], bool]
"""Whether a claim is shown at a value by a time."""


@dataclass(frozen=True, repr=False)
class Bracket(Result):
    """The last value of a parameter that is proved passive, and the first that is refuted.

    Attributes
    ----------
    parameter, unit
        Which, and its SI unit.
    passive, active
        Proved passive; refuted.  None where no such value was found.
    certificate, witness
        The evidence at either value.
    scope
        What it is about: every hand, or hands within bounds; contact; what of the actuator is counted.
    every_hand
        What is known of every hand, where the bracket is about bounded ones: the
        last value proved passive and the first refuted; None where there is none.
    evaluations, seconds
        Loops decided, and the time that took [s].
    storage
        The storage function at `passive`, to look at; None where a closed condition proves it.
    bounds
        The bounds on the hand, exact; None where the bracket is about every hand.
    violation
        What of the linear criterion is violated at `active`, where closed conditions found it.
    """

    FORMAT = "zwidth limit 1"
    PICTURE = "limit_figure"

    parameter: str
    unit: str
    passive: float | None
    active: float | None
    certificate: Certificate | None
    witness: Gain | Witness | None
    scope: Scope
    every_hand: tuple[float | None, float | None]
    evaluations: int
    seconds: float
    storage: StorageFunction | RowStorage | None = None
    bounds: HandBounds | None = None
    violation: Violation | None = None

    @property
    def hand(self) -> str:
        """The hands that the bracket is about, in words: "every hand", or bounds."""
        return describe_hands(self.scope.hands, self.scope.motion)

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What the proof covers and takes for granted, line by line."""
        return lines(self.scope)

    @property
    def relative_width(self) -> float:
        """|active − passive| over the larger of the two; inf where one is missing."""
        if self.passive is None or self.active is None:
            return inf
        return abs(self.active - self.passive) / max(self.active, self.passive)

    def describe(self) -> str:
        """The bracket in a sentence."""
        name = in_words(self.parameter).replace("environment.", "").replace("device.", "device ")
        if self.passive is None and self.active is None:
            return f"{name}: nothing was decided in the time given"
        passive, active = in_unit(self.passive, self.unit), in_unit(self.active, self.unit)
        if self.active is None:
            return f"{name}: {passive} is proved passive, and nothing is refuted"
        if self.passive is None:
            return f"{name}: no value is proved passive; {active} is active"
        return f"{name}: {passive} is proved passive, {active} is active, for {self.hand}"

    def to_dict(self) -> dict[str, Any]:
        """Values, assumptions and evidence as plain data."""
        suffix = unit_suffix(self.unit)
        return {
            "format": self.FORMAT,
            "parameter": self.parameter,
            f"proved_passive_{suffix}": self.passive,
            f"proved_active_{suffix}": self.active,
            "relative_width": None if self.relative_width == inf else self.relative_width,
            "hand": self.hand,
            "scope": self.scope.to_dict(),
            f"every_hand_{suffix}": list(self.every_hand),
            "assumptions": list(self.assumptions),
            "evaluations": self.evaluations,
            **evidence_of(self),
        }


class _Parameter(NamedTuple):
    """One number of the loop, and how to change it."""

    name: str
    unit: str
    now: float
    change: Callable[[Exact], tuple[Device, Environment]]
    more_is_safer: bool


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
    seconds: float = 60.0,
    progress: Callable[[int, int], None] | None = None,
) -> Bracket:
    """How far a parameter may go: proved passive on one side, refuted by a motion on the other.

    Contact is made and broken at will.  Without bounds on the hand the closed
    conditions are tried first, which cover every hand; where they end, and always
    where the hand is bounded, the game of `worst_hand` is played.

    Parameters
    ----------
    device, environment
        The loop, without intervals.
    parameter
        A parameter of the environment ("stiffness", "damping") or of the device
        ("coulomb_friction", "device.damping", "sample_period", "resolution", …);
        of a `NonlinearSpring` "gain", a factor on its forces; of a `HuntCrossley` contact
        "stiffness" or "dissipation".  Of laws in a row one of the environment that they render.
    penetration, speed
        Bounds on the hand [m; rad], [m/s; rad/s], as for `worst_hand`.
    force_limit, force_resolution
        True to count in the device's force limit, the steps of its converter.
    friction
        Friction measured at several speeds, in place of the device's b and f_c.
    tolerance
        Relative width of the bracket that is wanted.
    seconds
        Time after which the bracket so far is returned; that of compiling, once, is not counted.
    progress
        Told (loops decided, about how many there will be).

    Raises
    ------
    InputError
        If there is no such parameter, or the game cannot be played (see `worst_hand`).
    """
    if not isinstance(device, Device):
        raise InputError(f"the first argument is a Device, got {type(device).__name__}")
    if not isinstance(tolerance, int | float) or not 1e-6 <= tolerance < 1:
        raise InputError(
            f"tolerance must be a number from 1e-6 to 1, got {tolerance!r}: it is the relative width wanted"
        )
    if not isinstance(parameter, str):
        raise InputError(f"parameter is the name of one, such as 'stiffness', got {parameter!r}")
    law = as_environment(environment)
    _refuse_without_part(parameter.removeprefix("device."), force_limit, force_resolution)
    asked = _parameter(device, law, parameter)
    patience(seconds)
    counted = penetration, speed, force_limit, force_resolution, friction
    ideal = ends(device.resolution)[1] == 0
    if not (ideal or isinstance(law, Rendered)) and isinstance(
        first := program_of(device, law, *counted), DynamicProgram
    ):
        first.warm_up()
    search = _Search(asked, tolerance, time.monotonic(), patience(seconds), progress)
    if friction is not None and search.parameter.name in ("device.damping", "device.coulomb_friction"):
        raise InputError(f"{parameter} plays no part beside a friction curve: leave out one of the two")
    closed = not (force_limit or force_resolution or friction is not None)
    every = (search.by_closed_forms() if closed else None) or _NOTHING
    bounded = penetration is not None or speed is not None
    settled = every.passive is not None or every.active is not None
    if not bounded and (search.is_close(every.passive, every.active) or (settled and ideal)):
        return search.bracket(every, (every.passive, every.active))  # no game narrows an ideal encoder's

    boards = _one_board(device, law, *counted) if isinstance(law, Rendered) else ()

    def game(value: Exact) -> DynamicProgram | RowProgram:
        changed, environment = search.parameter.change(value)
        if isinstance(environment, Rendered):
            return row_program(changed, environment, *counted, boards)
        return program_of(changed, environment, *counted)

    def slow(value: Exact) -> Certificate | None:
        if not closed or isinstance(law, Rendered):
            return None
        return slow_hands(*search.parameter.change(value), game(value).bounds.speed)

    return search.by_games(device, game, slow, every)


def _one_board(device: Device, law: Rendered, *counted: Any) -> tuple[tuple[int, int]]:
    """The board on which laws in a row close as they are given, for all values of a parameter."""
    return (row_program(device, law, *counted).counts,)


class _Found(NamedTuple):
    """Two values and their evidence."""

    passive: Exact | None
    active: Exact | None
    certificate: Certificate | None
    witness: Gain | Witness | None
    scope: Scope
    violation: Violation | None = None


_NOTHING = _Found(None, None, None, None, Scope())


class _Search:
    """Looks for the two values, counting loops and time."""

    def __init__(
        self,
        parameter: _Parameter,
        tolerance: float,
        start: float,
        seconds: float,
        progress: Callable[[int, int], None] | None,
    ) -> None:
        self.parameter, self.tolerance = parameter, tolerance
        self.start, self.deadline, self.progress = start, start + seconds, progress
        self.evaluations = 0
        self.first = Exact(parameter.now or 1.0)

    def by_closed_forms(self) -> _Found | None:
        """What certificates and motions show of every hand; None for a law that has none."""
        verdicts: dict[Exact, Any] = {}

        def verdict(value: Exact) -> Any:
            if value not in verdicts:
                self._count()
                verdicts[value] = check_by_closed_forms(*self.parameter.change(value))
            return verdicts[value]

        def proved(value: Exact, _: float) -> bool:
            found = verdict(value)
            return bool(found.outcome == "passive")

        def refuted(value: Exact, _: float) -> bool:
            return bool(verdict(value).outcome == "active")

        try:
            verdict(self.first)
        except InputError:  # a law without H(z), which only the game can decide
            return None
        sides = self._sides(proved, refuted)
        approach(*sides, self.tolerance / 4, self.deadline)
        passive, active = (side.good for side in sides)
        good = None if passive is None else verdict(passive)
        bad = None if active is None else verdict(active)
        known = next((each for each in (good, bad) if each is not None), verdict(self.first))
        proof = None if good is None else good.certificate
        motion, violation = (None, None) if bad is None else (bad.witness, bad.violation)
        return _Found(passive, active, proof, motion, known.scope, violation)

    def by_games(
        self,
        device: Device,
        game: Callable[[Exact], DynamicProgram | RowProgram],
        slow: Callable[[Exact], Certificate | None],
        every: _Found,
    ) -> Bracket:
        """A bracket of a bounded hand: by what covers slow hands, and by games on finer and finer boards."""
        at_first = game(self.first)
        proofs: dict[Exact, Certificate | StorageFunction | RowStorage] = {}
        motions: dict[Exact, Gain] = {}
        tell = self._tell()

        def slowly(value: Exact, _: float) -> bool:
            self._count()
            return _kept(proofs, value, slow(value))

        def coarsely(cells: int) -> _Holds:
            def holds(value: Exact, deadline: float) -> bool:
                self._count()
                return _kept(proofs, value, game(value).prove_on_cells(cells, deadline, tell))

            return holds

        def proved(steps: int) -> _Holds:
            def holds(value: Exact, deadline: float) -> bool:
                self._count()
                try:
                    found = game(value)
                    in_time = min(deadline, self.deadline - found.checking_time(steps))
                    return _kept(proofs, value, found.prove(steps, in_time, tell))
                except DoesNotClose:
                    return False

            return holds

        def refuted(fine: int) -> _Holds:
            def holds(value: Exact, deadline: float) -> bool:
                self._count()
                try:
                    return _kept(motions, value, game(value).refute(fine, deadline, tell))
                except DoesNotClose:
                    return False

            return holds

        first, second = self._sides(slowly, refuted(FINE[0]))
        slowest = self._slow_limit(slowly)
        closed = _nearer(every.passive, slowest, first.towards)
        if closed is None and at_first.too_large is not None and not at_first.has_cells:
            raise InputError(at_first.too_large)
        if every.passive is not None and every.certificate is not None:
            proofs[every.passive] = every.certificate
        shown: dict[Exact | None, Certificate] = {
            value: proof for value, proof in proofs.items() if isinstance(proof, Certificate)
        }
        if at_first.is_large:
            first.good = closed
            for cells in CELLS:
                first.holds = coarsely(cells)
                approach(first, second, self.tolerance / 4, self._share(0.5))
                if self.is_close(first.good, second.good):
                    break
        for steps, fine in zip(STEPS, (FINE[0], *[FINE[1]] * 3), strict=True):
            if self._late() or self.is_close(first.good, second.good):
                break
            first.holds, second.holds = proved(steps), refuted(fine)
            approach(first, second, self.tolerance / 4, self.deadline)
            if first.good is None:
                break
        passive, active = _nearer(first.good, every.passive, first.towards), second.good
        if not self.is_close(passive, active):
            passive = _nearer(passive, slowest, first.towards)
        proof = None if passive is None else proofs[passive]
        storage = None if isinstance(proof, Certificate) else proof
        certificate = proof if isinstance(proof, Certificate) else None
        if storage is not None:
            certificate = storage.certificate()
            if not certificate.verify():  # nothing is claimed that the checker does not accept
                passive, storage, certificate = closed, None, shown.get(closed)
        motion = None if active is None else motions[active]
        scope = program_scope(*self.parameter.change(self.first), at_first)
        known = _Found(passive, active, certificate, motion, scope)
        beyond = every.passive, _nearer(every.active, active, second.towards)
        return self.bracket(known, beyond, at_first.bounds, storage)

    def _slow_limit(self, slowly: Callable[[Exact, float], bool]) -> Exact | None:
        """The last value at which a closed form covers this hand; None without one."""
        side, nobody = self._sides(slowly, lambda *_: False)
        approach(side, nobody, self.tolerance / 40, self.deadline)
        return side.good

    def bracket(
        self,
        found: _Found,
        every_hand: tuple[Exact | None, Exact | None],
        bounds: HandBounds | None = None,
        storage: StorageFunction | RowStorage | None = None,
    ) -> Bracket:
        """What was found, as it is given back."""
        return Bracket(
            self.parameter.name,
            self.parameter.unit,
            _plain(found.passive),
            _plain(found.active),
            found.certificate,
            found.witness,
            found.scope,
            (_plain(every_hand[0]), _plain(every_hand[1])),
            self.evaluations,
            time.monotonic() - self.start,
            storage,
            bounds,
            found.violation,
        )

    def _sides(self, proved: _Holds, refuted: _Holds) -> tuple[Side, Side]:
        """What is sought on either side: a proof as far as it goes, and a motion from beyond."""
        onward = -1 if self.parameter.more_is_safer else 1
        return Side(proved, onward, self.first), Side(refuted, -onward, self.first)

    def is_close(self, passive: Exact | None, active: Exact | None) -> bool:
        """True where the two are as near to each other as is wanted."""
        if passive is None or active is None:
            return False
        return abs(active - passive) <= self.tolerance * max(active, passive)

    def _share(self, part: float) -> float:
        """When a part of the time that is left will be over."""
        now = time.monotonic()
        return now + part * max(self.deadline - now, 0.0)

    def _late(self) -> bool:
        return time.monotonic() >= self.deadline

    def _count(self) -> None:
        self.evaluations += 1
        if self.progress is not None:
            self.progress(self.evaluations, max(30, self.evaluations + 1))

    def _tell(self) -> Progress:
        def tell(_: int) -> None:
            if self.progress is not None:
                self.progress(self.evaluations, max(30, self.evaluations + 1))

        return tell


def _plain(value: float | None) -> float | None:
    return None if value is None else float(value)


def _nearer(a: Exact | None, b: Exact | None, towards: int) -> Exact | None:
    """The value at which a claim reaches farther; the one there is, if there is only one."""
    known = [value for value in (a, b) if value is not None]
    return max(known, key=lambda value: towards * value) if known else None


def _kept(evidence: dict[Exact, Any], value: Exact, found: Any) -> bool:
    """Put evidence where it is looked for; of storage functions, which are large, only the last."""
    if found is None:
        return False
    if not isinstance(found, Certificate | Gain):
        for old in [v for v, other in evidence.items() if not isinstance(other, Certificate)]:
            del evidence[old]
    evidence[value] = found
    return True


_NO_PART = {
    "mass": "a hand without a limit on its force moves every mass as it likes",
    "stiction": "only sliding friction is counted",
    "friction_speed": "a claim names it, no bound contains it",
    "motor_inductance": "the actuator is taken to give every force at once",
    "supply_voltage": "the actuator is taken to give every force at once",
    "current_limit": "the actuator is taken to give every force at once",
}


def _refuse_without_part(key: str, force_limit: bool, force_resolution: bool) -> None:
    """Refuse a parameter on which no outcome depends."""
    if key in _NO_PART:
        raise InputError(
            f"{key} plays no part, so it has no limit: {_NO_PART[key]}. Ask for damping, coulomb_friction, "
            "resolution, delay or rate of the device, or for a parameter of the environment"
        )
    counted = {"force_limit": force_limit, "force_resolution": force_resolution}
    if not counted.get(key, True):
        option = f"--count-{key.replace('_', '-')}"
        raise InputError(f"{key} plays no part unless it is counted in: give {key}=True, {option}")


def _parameter(device: Device, environment: Environment, name: str) -> _Parameter:
    if isinstance(environment, Rendered):  # one of the environment that is rendered; laws follow it
        row = environment
        inner = _parameter(device, row.environment, name)

        def rendered(value: Exact) -> tuple[Device, Environment]:
            changed, environment = inner.change(value)
            return changed, Rendered(environment, row.stages)

        return inner._replace(change=rendered)
    owner, _, key = name.rpartition(".")
    in_environment = {f.name for f in fields(environment)} - {"exponent"}  # it changes the unit of K
    in_device = {f.name for f in fields(device)} | {"rate"}
    if key == "gain" and isinstance(environment, NonlinearSpring):
        spring = environment

        def scaled(value: Exact) -> tuple[Device, Environment]:
            return device, spring.replace(forces=[f.fraction * value.fraction for f in spring.forces])

        return _Parameter("environment.gain", "1", 1.0, scaled, False)
    if owner in ("", "environment") and key in in_environment:
        now = getattr(environment, key)
        if not isinstance(now, float):
            raise InputError(f"{key} is not one number: give an environment with a certain value of it")
        if isinstance(environment, HuntCrossley):
            unit = environment.unit_of(key, device.motion)
        else:
            unit = GLOSSARY[key].unit_for(device.motion)

        def change(value: Exact) -> tuple[Device, Environment]:
            return device, environment.replace(**{key: value})

        return _Parameter(f"environment.{key}", unit, abs(float(now)) or _guess(device, key), change, False)
    if owner in ("", "device") and key in in_device:
        known = 1 / device.exact("sample_period") if key == "rate" else device.exact(key)

        def change_device(value: Exact) -> tuple[Device, Environment]:
            if key == "rate":
                return device.replace(sample_period=Exact(1 / value.fraction)), environment
            return device.replace(**{key: value}), environment

        unit = GLOSSARY[key].unit_for(device.motion)
        safer = f"device.{key}" in MORE_IS_SAFER
        return _Parameter(f"device.{key}", unit, float(known) or _guess(device, key), change_device, safer)
    raise InputError(
        f"no parameter {name!r}: the environment has {', '.join(sorted(in_environment))}; the device has "
        f"{', '.join(sorted(in_device))}"
    )


def _guess(device: Device, key: str) -> float:
    """A first value of a parameter that is 0, from the device's other numbers."""
    b, f = device.exact("damping"), device.exact("coulomb_friction")
    t, step = device.exact("sample_period"), device.exact("resolution")
    sizes = {"stiffness": 2 * b / t, "damping": b, "coulomb_friction": f}
    fallback = {"stiffness": 2 * f / step if step else Fraction(1), "delay": t}
    return float(sizes.get(key, Fraction(0)) or fallback.get(key, Fraction(1)) or Fraction(1))
