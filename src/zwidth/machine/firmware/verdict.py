"""The verdict on a law in a machine's numbers: of the same loop, with ε less of Coulomb friction.

A force that is off by e_k, |e_k| ≤ ε, gives Σ e_k Δx_k ≤ ε Σ |Δx_k| ≤ ε ∫ |v| dt more than the law's own.
Coulomb friction takes f_c ∫ |v| dt.  So if no hand gains from the law with f_c − ε, none gains from the
machine with f_c; whatever the delay is, since the force that is off is held as the law's is.  Behind a
transmission it is so of what the motor's side alone pays for; what is proved of motor, transmission and hand
together is proved of viscous friction, and of none of a force that is off.

A chain of laws that ends in force bounding needs no ε: that law pays for its own rounding, of 53 or 24 bits,
and for the converter, and whatever is commanded before it may be off by anything.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from hashlib import sha256
from math import ceil, floor, inf
from textwrap import wrap

from zwidth.loop.start import unloaded_range
from zwidth.machine.firmware.law import LawProgram
from zwidth.machine.firmware.machine import Machine
from zwidth.machine.servo.proving import claimed, least_friction
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.passivity.bounding import check_bounding, is_bounded
from zwidth.passivity.check import check
from zwidth.passivity.parameter_limits import has_stiffness, max_stiffness
from zwidth.passivity.transmission import seen_at_motor
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.text import told_quantity

Decide = Callable[[Device, Environment], Verdict]

PROVED = ("passive", "theorem")

_NUMBERS = {
    "double": "the rounding of double",
    "float": "the rounding of float",
    "fixed": "the rounding of whole numbers",
}


@dataclass(frozen=True, kw_only=True)
class Judged:
    """A law, a machine, and what is proved of both together.

    `ideal` is of the law in real numbers; `verdict` of the law with what friction the machine's numbers
    leave, or of the law itself where they are not `counted`, for `reason`.  `bounded` where force bounding at
    the end pays for the rounding.
    """

    machine: Machine
    ideal: Verdict
    verdict: Verdict
    counted: bool
    reason: str = ""
    bounded: bool = False

    @property
    def proved(self) -> bool:
        """Whether no hand can take energy out of the loop with this machine in it.

        The rounding of double alone is left out where it cannot be counted; the converter's is not, unless a
        theorem counts it.
        """
        if self.verdict.outcome not in PROVED:
            return False
        return self.counted or (self.machine.number == "double" and self._steps_are_counted)

    @property
    def _steps_are_counted(self) -> bool:
        """Whether the converter has no steps, or the proof of the law itself counts them."""
        if self.machine.half_step == 0.0 or self.verdict.outcome != "theorem":
            return self.machine.half_step == 0.0
        law, device = self.verdict.environment, self.verdict.device
        theorem = laws_of(law)[-1].theorem(LoopContext(device, law.met))
        if theorem is None or not theorem.counts_force_steps:
            return False
        return ends(device.coulomb_friction)[0] >= theorem.coulomb_friction

    @property
    def outcome(self) -> str:
        """Of the law in the machine's numbers: what is proved of the law alone is not proved of them.

        Nor is it known that a hand gains where one gains with ε less of friction only.
        """
        if self.ideal.outcome in PROVED and not self.proved:
            return "undecided"
        return self.verdict.outcome

    @property
    def statement(self) -> str:
        """What the numbers of the machine do to the verdict, in a sentence or two."""
        m = self.machine
        what = _NUMBERS[m.number]
        told = partial(told_quantity, name="force", motion=self.verdict.device.motion, digits=4)
        if self.bounded:
            return f"Force bounding pays for {what} and the converter's steps; what comes before may be off."
        if m.error is None:
            return f"{what} is not in the verdict: {m.reason}."
        parts = f"{told(m.half_step)} by half a step of the converter, {told(m.rounding or 0.0)} by {what}"
        off = f"The force is off by {told(m.error)} at most: {parts}."
        if not self.counted:
            return f"{off} {self.reason}"
        return f"{off} As much Coulomb friction is set aside for it, and the proof holds with what is left."

    def cost(self, device: Device, environment: Environment) -> float | None:
        """By how much the largest passive stiffness is less [N/m; N·m/rad]; None where that is no number."""
        paid = self.counted and self.verdict.scope.transmission != "as given"
        if not (paid and device.is_certain and has_stiffness(environment)):
            return None
        both = map(seen_at_motor, (device, self.verdict.device))
        before, after = (max_stiffness(d, environment, True) for d in both)
        return None if before is None or after is None else before - after


def judged(device: Device, environment: Environment, machine: Machine, decide: Decide = check) -> Judged:
    """The verdict on a machine; `decide` in the place of `zwidth.check`."""
    bounded = _bounded(device, environment, machine)
    if bounded is not None:
        return bounded
    ideal = decide(device, environment)
    uncounted = partial(Judged, machine=machine, ideal=ideal, verdict=ideal, counted=False)
    if machine.error is None:
        return uncounted(reason=machine.reason)
    (friction, most), off = ends(device.coulomb_friction), Fraction(machine.error)
    if friction < off:
        dry = told_quantity(friction, "coulomb_friction", device.motion, 4)
        return uncounted(reason=f"The device has {dry} of Coulomb friction to pay for it.")
    if ideal.outcome not in PROVED:
        return Judged(machine=machine, ideal=ideal, verdict=ideal, counted=True)
    spent = Exact(friction - off) if most == friction else Interval(friction - off, most - off)
    left = device.replace(coulomb_friction=spent)
    found = decide(left, environment)
    if off and found.outcome in PROVED and found.scope.transmission == "as given":
        return uncounted(reason=_OF_A_KNOWN)
    return Judged(machine=machine, ideal=ideal, verdict=found, counted=True)


_OF_A_KNOWN = (
    "The proof is of one transmission, with an exact force: the motor's Coulomb friction pays for none."
)


def _bounded(device: Device, environment: Environment, machine: Machine) -> Judged | None:
    """Of a chain that ends in force bounding, with the roundings that the machine has; None of any other."""
    given = device.transmission
    if given is not None and given.encoder == "handle":
        return None
    if machine.number == "fixed" or not is_bounded(environment) or isinstance(device.delay, Interval):
        return None
    found = check_bounding(least_friction(device), environment, single=machine.number == "float")
    if found.certificate is None:
        return None
    scope = found.scope if given is None else found.scope.replace(transmission="any")
    verdict = Verdict("passive", scope, device, environment, certificate=found.certificate)
    return Judged(machine=machine, ideal=verdict, verdict=verdict, counted=True, bounded=True)


# What stands at the head of an emitted text: what is proved of it, and its numbers.


def digest(text: str) -> str:
    """SHA-256 of a file with this text."""
    return sha256(text.encode()).hexdigest()


def claim(found: Judged) -> str:
    """Of the law in the machine's numbers."""
    if found.proved:
        return claimed(found.verdict)
    if found.verdict.outcome in PROVED:
        return f"NOT PROVED in {found.machine.number}, only in real numbers: {claimed(found.verdict)}"
    return f"NOT PROVED: {found.verdict.claim}"


def about(name: str, device: Device, environment: Environment, found: Judged) -> list[str]:
    """The comment at the head of the text."""
    parts = [
        f"{name}: {environment.describe(device.motion)}.",
        repr(device).strip("<>"),
        f"{claim(found)} {found.statement}",
        f"Proof: {name}.certificate.json, to be checked by: zwidth verify {name}.certificate.json",
        "Written by zwidth from the functions that it simulates; do not edit.",
    ]
    return [line for part in parts for line in (*wrap(part, 96), "")][:-1]


Define = tuple[str, str, str]
"""Name, value and meaning of a constant."""

_START = 0.01
"""Of the force limit: up to which a main program lets a law begin."""


def begins(environment: Environment, numbers: Machine) -> list[Define]:
    """Where the law may begin, if not everywhere: on the top of a detent it would give what it holds."""
    law, (lowest, highest) = numbers.law, numbers.counts
    low, high = unloaded_range(environment, _START * law.limit, 0.0)
    if law.resolution == 0.0 or (low, high) == (-inf, inf):
        return []
    least, most = ceil(max(low / law.resolution, lowest)), floor(min(high / law.resolution, highest))
    return [
        ("BEGINS_MIN", f"({least})", "a main program lets the law begin from this reading"),
        ("BEGINS_MAX", f"({most})", "to this one"),
    ]


def defines(
    device: Device, environment: Environment, law: LawProgram, numbers: Machine, certificate: str
) -> list[Define]:
    """Name, value and meaning of the constants of a text."""
    linear = device.motion == "linear"
    force, length = ("N", "m") if linear else ("N*m", "rad")
    period = float(device.exact("sample_period"))
    unit = 1.0 if numbers.fixed is None else numbers.fixed.units.scale.size(numbers.fixed.result)
    low, high = numbers.counts
    rows = [
        ("SAMPLE_PERIOD_S", repr(period), "s"),
        ("DELAY_S", repr(float(ends(device.delay)[1])), "s from reading to force, at most"),
        ("RATE_HZ", f"{1 / period:.10g}", "Hz"),
        ("ROTARY", str(int(not linear)), "1 where positions are in rad and forces in N*m"),
        ("RESOLUTION", repr(law.resolution), f"{length} per count"),
    ]
    if law.resolution > 0:
        rows += [
            ("COUNTS_MIN", f"({int(low)})", "readings below are taken as this"),
            ("COUNTS_MAX", str(int(high)), "readings above are taken as this"),
        ]
    else:
        rows += [
            ("POSITION_MIN", f"({low!r})", f"{length}; readings below are taken as this"),
            ("POSITION_MAX", repr(high), f"{length}; readings above are taken as this"),
        ]
    rows += begins(environment, numbers)
    rows.append(("FORCE_PER_UNIT", repr(unit), f"{force} per unit of the force"))
    if law.limit > 0:
        rows.append(("FORCE_LIMIT", repr(law.limit), force))
    return [*rows, ("CERTIFICATE_SHA256", f'"{digest(certificate)}"', "of the certificate beside this")]
