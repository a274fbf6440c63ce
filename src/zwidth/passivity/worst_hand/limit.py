"""How far one parameter may go: a bracket, proved passive below and refuted above."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from math import inf, log2, sqrt
from pathlib import Path
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
from zwidth.passivity.document import save_json, unit_suffix
from zwidth.passivity.scope import Scope
from zwidth.passivity.violation import Violation
from zwidth.passivity.witness import Witness, rounded_energy
from zwidth.passivity.wording import describe_hands, lines
from zwidth.passivity.worst_hand.gain import Gain
from zwidth.passivity.worst_hand.hand import FINE, STEPS, Game, Tell, game_of, game_scope, patience
from zwidth.passivity.worst_hand.row_game import RowGame, row_game
from zwidth.passivity.worst_hand.row_table import DoesNotClose
from zwidth.passivity.worst_hand.storage import Storage
from zwidth.quantity.exact import Exact, RealLike, ends
from zwidth.quantity.glossary import GLOSSARY
from zwidth.rendering.rendered import Rendered

MORE_IS_SAFER = frozenset({"device.damping", "device.coulomb_friction", "device.rate"})
"""Parameters of which a loop needs enough; of all others it may have too much."""

_FARTHEST = 60
"""Doublings from the first guess after which there is no limit."""


@dataclass(frozen=True)
class Bracket:
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
    violation
        What of the linear criterion is violated at `active`, where closed conditions found it.
    """

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
    storage: Storage | None = None
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
        name = self.parameter.replace("_", " ").replace("environment.", "").replace("device.", "device ")
        if self.passive is None and self.active is None:
            return f"{name}: nothing was decided in the time given"
        if self.active is None:
            return f"{name}: {self.passive:.6g} {self.unit} is proved passive, and nothing is refuted"
        if self.passive is None:
            return f"{name}: no value is proved passive; {self.active:.6g} {self.unit} is active"
        return (
            f"{name}: {self.passive:.6g} {self.unit} is proved passive, {self.active:.6g} {self.unit} is "
            f"active, for {self.hand}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Values, assumptions and evidence as plain data."""
        suffix = unit_suffix(self.unit)
        document: dict[str, Any] = {
            "format": "zwidth limit 1",
            "parameter": self.parameter,
            f"proved_passive_{suffix}": self.passive,
            f"proved_active_{suffix}": self.active,
            "relative_width": None if self.relative_width == inf else self.relative_width,
            "hand": self.hand,
            "scope": self.scope.to_dict(),
            f"every_hand_{suffix}": list(self.every_hand),
            "assumptions": list(self.assumptions),
            "evaluations": self.evaluations,
        }
        if self.certificate is not None:
            document["certificate"] = self.certificate.to_dict()
        if self.violation is not None:
            document["violation"] = self.violation.to_dict()
        if self.witness is not None:
            document["witness"] = rounded_energy(self.witness.to_dict())
        return document

    def save(self, path: str | Path) -> None:
        """Write the bracket with its evidence as JSON for `zwidth verify`."""
        save_json(path, self.to_dict())

    def __repr__(self) -> str:
        return f"<Bracket {self.describe()}>"

    def _repr_html_(self) -> str:
        assumed = "".join(f"<li>{a}</li>" for a in self.assumptions)
        return (
            f"<div>{self.describe()}<details><summary>assumptions</summary><ul>{assumed}</ul></details></div>"
        )


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
        Time after which the bracket so far is returned.
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
    _refuse_without_part(parameter.removeprefix("device."), force_limit, force_resolution)
    law = as_environment(environment)
    search = _Search(
        _parameter(device, law, parameter), tolerance, time.monotonic(), patience(seconds), progress
    )
    if friction is not None and search.parameter.name in ("device.damping", "device.coulomb_friction"):
        raise InputError(f"{parameter} plays no part beside a friction curve: leave out one of the two")
    closed = not (force_limit or force_resolution or friction is not None)
    bracket = search.by_closed_forms() if closed else None
    bounded = penetration is not None or speed is not None
    if bracket is not None and not bounded:
        settled = bracket.passive is not None or bracket.active is not None
        if bracket.relative_width <= tolerance or (settled and ends(device.resolution)[1] == 0):
            return bracket  # with an ideal encoder there is no game that would narrow it
    known = (None, None) if bracket is None else (bracket.passive, bracket.active)

    counted = penetration, speed, force_limit, force_resolution, friction
    boards = _one_board(device, law, *counted) if isinstance(law, Rendered) else ()

    def game(value: Exact) -> Game | RowGame:
        changed, environment = search.parameter.change(value)
        if isinstance(environment, Rendered):
            return row_game(changed, environment, *counted, boards)
        return game_of(changed, environment, *counted)

    return search.by_games(device, game, known)


def _one_board(device: Device, law: Rendered, *counted: Any) -> tuple[tuple[int, int]]:
    """The board on which laws in a row close as they are given, for all values of a parameter."""
    return (row_game(device, law, *counted).board,)


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

    def by_closed_forms(self) -> Bracket | None:
        """A bracket from certificates and motions for every hand; None for a law that has none."""
        verdicts: dict[Exact, Any] = {}

        def verdict(value: Exact) -> Any:
            if value not in verdicts:
                self._count()
                verdicts[value] = check_by_closed_forms(*self.parameter.change(value))
            return verdicts[value]

        def proved(value: Exact) -> bool:
            found = verdict(value)
            return bool(found.outcome == "passive")

        def refuted(value: Exact) -> bool:
            return bool(verdict(value).outcome == "active")

        try:
            verdict(self._first())
        except InputError:  # a law without H(z), which only the game can decide
            return None
        passive, active = self._both_sides(proved, refuted)
        good = None if passive is None else verdict(passive)
        bad = None if active is None else verdict(active)
        scope = (good or bad or verdict(self._first())).scope
        proof, motion = good and good.certificate, bad and bad.witness
        bracket = self._bracket(passive, active, proof, motion, (passive, active), scope)
        return replace(bracket, violation=bad and bad.violation)

    def by_games(
        self,
        device: Device,
        game: Callable[[Exact], Game | RowGame],
        every_hand: tuple[float | None, float | None],
    ) -> Bracket:
        """A bracket from games on finer and finer boards."""
        proofs: dict[Exact, Any] = {}
        motions: dict[Exact, Any] = {}
        passive: Exact | None = None
        active: Exact | None = None
        for steps, fine in zip(STEPS, (FINE[0], *[FINE[1]] * 3), strict=True):
            tell = self._tell()

            def proved(value: Exact, steps: int = steps, tell: Tell = tell) -> bool:
                self._count()
                try:
                    storage = game(value).prove(steps, self.deadline, tell)
                except DoesNotClose:
                    return False
                if storage is not None:
                    proofs.clear()
                    proofs[value] = storage
                return storage is not None

            def refuted(value: Exact, fine: int = fine, tell: Tell = tell) -> bool:
                self._count()
                try:
                    motion = game(value).refute(fine, self.deadline, tell)
                except DoesNotClose:
                    return False
                if motion is not None:
                    motions[value] = motion
                return motion is not None

            passive, active = self._both_sides(proved, refuted, passive, active)
            if passive is None or self._late():
                break
            if active is not None and abs(active - passive) <= self.tolerance * max(active, passive):
                break
        at_first = game(self._first())
        storage = None if passive is None else proofs[passive]
        proof = None if storage is None else storage.certificate()
        if proof is not None and not proof.verify():  # nothing is claimed that the checker does not accept
            passive, proof, storage = None, None, None
        motion = None if active is None else motions.get(active)
        scope = game_scope(*self.parameter.change(self._first()), at_first)
        return self._bracket(passive, active, proof, motion, every_hand, scope, storage)

    def _first(self) -> Exact:
        return Exact(self.parameter.now or 1.0)

    def _both_sides(
        self,
        proved: Callable[[Exact], bool],
        refuted: Callable[[Exact], bool],
        passive: Exact | None = None,
        active: Exact | None = None,
    ) -> tuple[Exact | None, Exact | None]:
        """The last proved value and the first refuted one, better than those known already."""
        down = -1.0 if self.parameter.more_is_safer else 1.0
        fine = self.tolerance / 4
        best, unproved = self._edge(proved, passive or self._first(), passive, active, down, fine)
        passive = best if best is not None else passive
        if passive is None and unproved is None:
            return None, active
        start = unproved if unproved is not None else passive
        assert start is not None
        if active is None or abs(active - start) > fine * abs(active):
            found, _ = self._edge(refuted, start, active, passive, -down, fine)
            active = found if found is not None else active
        return passive, active

    def _edge(
        self,
        holds: Callable[[Exact], bool],
        start: Exact,
        known: Exact | None,
        other: Exact | None,
        towards: float,
        fine: float,
    ) -> tuple[Exact | None, Exact | None]:
        """The farthest value towards which a claim holds, and the nearest beyond at which it was not shown.

        It is taken to hold on the near side of some value: each answer is evidence by
        itself, so that a law for which this is not so loses only the best bracket.
        """
        good, bad = known, other
        value, factor = start, 1.0 + 4 * fine
        for _ in range(_FARTHEST + 40):
            if good is not None and bad is not None:
                break
            if self._late():
                return good, None
            if holds(value):
                good = value
            else:
                bad = value
            forward = good is not None
            if good is None or bad is None:
                value = _decimal(value * (factor if (towards > 0) == forward else 1 / factor))
                factor = min(factor**2, 4.0)
            if max(abs(log2(value / origin)) for origin in (start, self._first())) > _FARTHEST:
                break
        while good is not None and bad is not None and abs(bad - good) > fine * max(bad, good):
            if self._late():
                break
            value = _decimal(sqrt(good * bad))
            if value in (good, bad):
                break
            if holds(value):
                good = value
            else:
                bad = value
        return good, bad

    def _bracket(
        self,
        passive: Exact | None,
        active: Exact | None,
        certificate: Certificate | None,
        witness: Any,
        every_hand: tuple[float | None, float | None],
        scope: Scope,
        storage: Storage | None = None,
    ) -> Bracket:
        return Bracket(
            self.parameter.name,
            self.parameter.unit,
            _plain(passive),
            _plain(active),
            certificate,
            witness,
            scope,
            (_plain(every_hand[0]), _plain(every_hand[1])),
            self.evaluations,
            time.monotonic() - self.start,
            storage,
        )

    def _late(self) -> bool:
        return time.monotonic() >= self.deadline

    def _count(self) -> None:
        self.evaluations += 1
        if self.progress is not None:
            self.progress(self.evaluations, max(30, self.evaluations + 1))

    def _tell(self) -> Tell:
        def tell(_: int) -> None:
            if self.progress is not None:
                self.progress(self.evaluations, max(30, self.evaluations + 1))

        return tell


def _plain(value: float | None) -> float | None:
    return None if value is None else float(value)


def _decimal(value: float) -> Exact:
    """A value of six digits, as a person would write it down."""
    return Exact(f"{value:.6g}")


_NO_PART = {
    "mass": "a hand without a limit on its force moves every mass as it likes",
    "stiction": "only sliding friction is counted",
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
