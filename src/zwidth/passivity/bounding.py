"""A chain of laws that force bounding ends: passive whatever comes before it, with a certificate.

    β ≤ b/T    φ (1 + u) ≤ f_c    δ ≥ Δ    h ≥ ΔF/2    delay = 0

with β, φ, δ and h the very doubles that the compiled law reckons with.  The proof is in the
documentation, "Laws that bound the force"; the checker goes through its inequalities.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

from zwidth.checker import verify
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.device.amplifier import current_rise
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.passivity.certificate import FORMAT, Certificate
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Scope, scope_of, unit_key
from zwidth.passivity.wording import claim_of_passivity
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import exact_text

ROUNDOFF, SINGLE_ROUNDOFF = Fraction(1, 2**53), Fraction(1, 2**24)
"""u: relative error of one operation on doubles, on floats, at most."""


@dataclass(frozen=True, repr=False)
class Bounding(PassivityAnswer):
    """Whether force bounding at the end of a chain of laws keeps every hand from taking energy out.

    It has no `margin`: the law gives as much force as the device pays for, and no more.

    Attributes
    ----------
    outcome
        "passive" with a certificate that the independent checker accepted; "undecided" otherwise.
    claim
        The outcome in a sentence.
    scope
        What it is about.
    certificate
        The proof; None unless passive.
    """

    _FORMAT = "zwidth bounding 1"
    witness = None

    outcome: Literal["passive", "undecided"]
    claim: str
    scope: Scope
    certificate: Certificate | None


def check_bounding(device: Device, environment: Environment | Any, *, single: bool = False) -> Bounding:
    """Decide whether force bounding, the last law in a chain, makes a loop passive.

    Nothing is asked of the environment and of the laws before it: what they command may be anything.  Where
    the record says that the current rises slowly, nothing is proved.

    Parameters
    ----------
    device
        Every number certain.
    environment
        ``zw.render(…, ForceBounding())``.
    single
        True for a machine that computes the law in float, not in double.

    Raises
    ------
    InputError
        If the last law is another one, or a number of the device is an interval or missing.
    """
    law = as_environment(environment, device=device)
    numbers = _numbers(device, law, single)
    if numbers is None:
        raise InputError(
            f"a chain of laws is proved here if ForceBounding() is the last of them, got {law.describe()}"
        )
    document = _document(device, numbers, SINGLE_ROUNDOFF if single else ROUNDOFF)
    found = verify(document)
    scope = _scope(device, law, single)
    if found.scope is None:
        return Bounding("undecided", f"Not proved: {found.reason}.", scope, None)
    rise = current_rise(device)
    if rise.ok is False:
        claim = f"Not proved: a force is taken as instant, and it is not: {rise.text}."
        return Bounding("undecided", claim, scope, None)
    claim = f"{claim_of_passivity(scope, False)}, whatever comes before force bounding: {found.reason}."
    return Bounding("passive", claim, scope.replace(contact=found.scope.contact), Certificate((document,)))


def is_bounded(environment: Environment) -> bool:
    """True for a chain of laws with force bounding at its end."""
    chain = laws_of(environment)
    return bool(chain) and chain[-1].bounds_the_force


def _numbers(device: Device, law: Environment, single: bool) -> dict[str, Fraction] | None:
    """What the compiled law reckons with, each double as the rational that it is."""
    if not is_bounded(law):
        return None
    credit, friction, count, half_step, _, hair = laws_of(law)[-1].numbers(
        LoopContext(device, law.met, single)
    )
    kept = {"credit": credit, "friction": friction, "count": count, "half_step": half_step, "hair": hair}
    return {name: Fraction(value) for name, value in kept.items()}


def _document(device: Device, numbers: dict[str, Fraction], roundoff: Fraction) -> dict[str, Any]:
    keys = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
    loop = {key: device.exact(key) for key in keys}
    known = device.force_resolution is not None
    loop["force_resolution"] = device.exact("force_resolution") if known else Fraction(0)
    force, length, slope = (
        unit_suffix(GLOSSARY[name].unit_for(device.motion)) for name in ("force", "position", "stiffness")
    )
    units = {"credit": slope, "friction": force, "count": length, "half_step": force}
    law = {
        f"{name}_{units[name]}" if name in units else name: exact_text(value)
        for name, value in numbers.items()
    }
    return {
        "format": FORMAT,
        "kind": "force bounding",
        "loop": {unit_key(name, device.motion): exact_text(value) for name, value in loop.items()},
        "law": {**law, "roundoff": exact_text(roundoff)},
    }


def _scope(device: Device, law: Environment, single: bool) -> Scope:
    """Nothing is asked of what is rendered: whatever is commanded before the last law is paid for."""
    return scope_of(device, law).replace(
        contact="made and broken",
        force_limit=True,
        force_steps=device.force_resolution is not None,
        law=("any before the last", "floats" if single else "doubles"),
    )
