"""What a result is about, as data: which hands, which contact, what of encoder and actuator is counted.

A verdict means no more than the theorem behind it.  So every result carries this record, the words of its
claim are made from it (`wording`), last and in one place, and what it says of contact is what the
independent checker found in the proof.  With it stand the outcomes, and proofs and motions as plain data.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from zwidth.errors import InputError
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.quantity.exact import Interval, ends
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.text import exact_text

if TYPE_CHECKING:
    from zwidth.model.device import Device, FrictionCurve
    from zwidth.model.environment.environment import Environment


Contact = Literal["made and broken", "kept", "both sides"]
"""The hand touches and leaves at will; it stays inside; the law has no surface at all."""

Encoder = Literal["ideal", "counted", "not counted"]
"""No steps; steps in the proof; steps that the device has and the proof leaves out."""

Sampling = Literal["constant", "any"]
"""A constant period and delay; or whatever the clock does."""

Torque = Literal["", "follows the arm", "follows the readings", "held"]
"""Of an arm, within a period: it is always that of the arm, or of its readings; or computed once."""

Transmission = Literal["rigid", ""]
"""Motor, encoder and hand move as one, no cable, belt or gear gives way between them; "" without a device."""

FedWith = Literal["position", "penetration", ""]
"""Its memory hears the position outside too, or the depth max(x, 0); or that makes no difference."""

Law = Literal[
    "rounded coefficients",
    "rounded power",
    "table",
    "doubles",
    "floats",
    "any before the last",
    "behind a coupling",
    "covered by a wall",
    "covered with less friction",
    "potential bounded below",
    "energy at first bounded",
]
"""What of the law is not exact, or not looked at."""

Also = Literal["springs", "clamped"]
"""What else a proof covers: every spring of slope 0 to K; the same wall if it never pulls."""


@dataclass(frozen=True, kw_only=True)
class Hands:
    """Which hands: every hand, unless a bound stands here.

    Parameters
    ----------
    speed
        Largest mean speed over a sample, or over `part` of one [m/s; rad/s].
    in_each_part
        True if the bound on speed is for each part of a sample with one force.
    inside, outside
        How deep, and how far outside it goes [m; rad]; None: any distance.
    counts_a_sample, counts_inside
        The speed and the depth in counts of the encoder, told beside them; None: they are not.
    impedance
        The one hand that is known, in words; None for all others.
    activity, below
        What a hand gives out at most, as a damping [N·s/m; N·m·s/rad], at frequencies below this [Hz]; None:
        at all.
    """

    speed: float | None = None
    in_each_part: bool = False
    inside: float | None = None
    outside: float | None = None
    counts_a_sample: float | None = None
    counts_inside: float | None = None
    impedance: str | None = None
    activity: float | None = None
    below: float | None = None

    @property
    def every(self) -> bool:
        """True if nothing is asked of the hand."""
        return self == Hands()


@dataclass(frozen=True, kw_only=True)
class Scope:
    """What a result is about.

    Parameters
    ----------
    hands
        Which hands.
    contact
        Made and broken, kept, or with a law on both sides.  Of a motion that takes energy out: what it does.
    encoder
        Whether the encoder's steps are in it.
    force_limit, force_steps
        Whether the actuator's force limit, and its converter's steps, are in it; else the actuator is ideal.
    largest_force, largest_moment
        Forces of the wall [N; N·m], and of an arm in pose moments [N·m], up to which it holds; None: any.
    transmission
        What is between motor, encoder and hand: no claim counts what gives way there.
    torque
        Of an arm: what becomes of the torque within a period; "" for a device of one axis.
    sampling
        What is asked of the clock.
    damping, coulomb_friction
        b [N·s/m; N·m·s/rad] and f_c [N; N·m] that the device takes out at least; None where `friction` says
        it, or where there are several joints.
    friction_speed
        Speed up to which the device's friction was measured [m/s; rad/s]; None: it is taken for every speed.
    friction
        The measured curve in the place of both, or None.
    fed_with
        What a law with a memory must be fed with for a proof to hold; "": either.
    clamped
        True if the law never pulls: a force below 0 is given as 0.
    region
        Where in its workspace an arm is, in words; None for a device of one axis.
    intervals
        Parameters that stand for every value in an interval.
    bounds
        The ends of those that are the device's: (parameter, low, high), SI.
    assumed
        Parameters of the device that were not given and are taken as 0.
    law
        What of the law is not exact, or not looked at.
    also
        What else a proof covers.
    motion
        "linear" or "rotary": the units.
    """

    hands: Hands = Hands()
    contact: Contact = "made and broken"
    encoder: Encoder = "ideal"
    force_limit: bool = False
    force_steps: bool = False
    largest_force: float | None = None
    largest_moment: float | None = None
    transmission: Transmission = "rigid"
    torque: Torque = ""
    sampling: Sampling = "constant"
    damping: float | None = None
    coulomb_friction: float | None = None
    friction_speed: float | None = None
    friction: FrictionCurve | None = None
    fed_with: FedWith = ""
    clamped: bool = False
    region: str | None = None
    intervals: tuple[str, ...] = ()
    bounds: tuple[tuple[str, float, float], ...] = ()
    assumed: tuple[str, ...] = ()
    law: tuple[Law, ...] = ()
    also: tuple[Also, ...] = ()
    motion: str = "linear"

    def replace(self, **changes: Any) -> Scope:
        """The same record with some entries changed."""
        return replace(self, **changes)

    def to_dict(self) -> dict[str, Any]:
        """The record as plain data, a unit in every key of a physical quantity."""
        return _document(self)


def _document(scope: Scope) -> dict[str, Any]:
    """See `Scope.to_dict`."""
    written: dict[str, Any] = {
        "hands": _hands_document(scope.hands, scope.motion),
        "contact": scope.contact,
        "encoder": scope.encoder,
        "force_limit_counted": scope.force_limit,
        "force_steps_counted": scope.force_steps,
        "sampling": scope.sampling,
        "clamped": scope.clamped,
    }
    if scope.fed_with:
        written["fed_with"] = scope.fed_with
    for name in ("damping", "coulomb_friction"):
        written[unit_key(name, scope.motion)] = getattr(scope, name)
    if scope.friction_speed is not None:
        written[unit_key("friction_speed", scope.motion)] = scope.friction_speed
    if scope.largest_force is not None:
        force = unit_suffix(GLOSSARY["force"].unit_for(scope.motion))
        written[f"largest_force_{force}"] = scope.largest_force
    if scope.largest_moment is not None:
        written["largest_moment_N_m"] = scope.largest_moment
    if scope.transmission:
        written["transmission"] = scope.transmission
    if scope.torque:
        written["torque"] = scope.torque
    if scope.friction is not None:
        written["friction"] = "curve"
    if scope.region is not None:
        written["region"] = scope.region
    if scope.bounds:
        written["bounds"] = {unit_key(name, scope.motion): [low, high] for name, low, high in scope.bounds}
    for name in ("intervals", "assumed", "law", "also"):
        values: Sequence[str] = getattr(scope, name)
        if values:
            written[name] = list(values)
    return written


def _hands_document(hands: Hands, motion: str) -> dict[str, Any]:
    length = unit_suffix(GLOSSARY["position"].unit_for(motion))
    damping = unit_suffix(GLOSSARY["damping"].unit_for(motion))
    if hands.impedance is not None:
        return {"which": "known", "hand": hands.impedance}
    if hands.activity is not None:
        return {"which": "activity", f"activity_{damping}": hands.activity, "below_Hz": hands.below}
    if hands.every:
        return {"which": "every"}
    return {
        "which": "bounded",
        f"speed_{length}_per_s": hands.speed,
        "in_each_part_of_a_sample": hands.in_each_part,
        f"inside_{length}": hands.inside,
        f"outside_{length}": hands.outside,
    }


def scope_of(device: Device, environment: Environment) -> Scope:
    """What is asked of a loop, before anything is found: every hand, contact as the law has it."""
    certain = device.is_certain
    friction, damping = ends(device.coulomb_friction)[0], ends(device.damping)[0]
    uncertain = {k: v for k, v in device.parameters().items() if isinstance(v, Interval)}
    return Scope(
        contact="made and broken" if environment.unilateral else "both sides",
        encoder="counted" if ends(device.resolution)[1] else "ideal",
        damping=float(device.exact("damping") if certain else damping),
        coulomb_friction=float(device.exact("coulomb_friction") if certain else friction),
        friction_speed=None if device.friction_speed is None else float(ends(device.friction_speed)[0]),
        clamped=environment.clamped and not environment.spring,
        intervals=(*uncertain, *(() if environment.is_certain else ("the environment's intervals",))),
        bounds=tuple((k, float(v.low), float(v.high)) for k, v in uncertain.items()),
        assumed=device.assumed,
        law=("rounded coefficients",) if environment.coefficients_rounded else (),
        motion=device.motion,
    )


def as_contact(value: object) -> Contact:
    """Read the keyword that says which contact is asked about."""
    if value == "made and broken":
        return "made and broken"
    if value == "kept":
        return "kept"
    raise InputError(
        f'contact is "made and broken", as a hand does, or "kept", for one that never leaves; got {value!r}'
    )


# What may come of a question, and by which word, colour and exit status each is told.
#
# passive             a proof, with contact made and broken at will, or as was asked
# passive in contact  a proof of hands that stay inside alone, where nothing else was asked
# passive without encoder steps
#                     a proof of an arm, or of a scene, that is read without steps, where this one has them
# theorem             a proof on paper, reckoned in doubles, without a certificate
# active              a motion that takes energy out, or a proof that there is one
# undecided           neither


Outcome = Literal[
    "passive", "passive in contact", "passive without encoder steps", "theorem", "active", "undecided"
]


class Told(NamedTuple):
    """How an outcome is told."""

    status: int  # the exit status of a command.  2 is bad input.
    # its colour in a terminal, and in a page
    terminal: str
    colour: str


TOLD: Mapping[str, Told] = MappingProxyType(
    {
        "passive": Told(0, "green", "#2a7d4f"),
        "passive in contact": Told(4, "blue", "#1f5fa8"),
        "passive without encoder steps": Told(4, "blue", "#1f5fa8"),
        "theorem": Told(4, "blue", "#1f5fa8"),
        "active": Told(1, "red", "#b3261e"),
        "undecided": Told(3, "yellow", "#8a6d00"),
    }
)
"""By outcome."""

COLOUR: Mapping[str, str] = MappingProxyType(
    {outcome: told.colour for outcome, told in TOLD.items()}
    | {"stable": TOLD["passive"].colour, "unstable": TOLD["active"].colour}
)
"""By outcome, in a page; of a hand that is known too."""


# Numbers are written exactly: as a decimal where one exists, otherwise as text "p/q".  Every key of a
# physical quantity carries its unit.


def unit_key(name: str, motion: str = "linear") -> str:
    """The JSON key of a quantity: its name and its SI unit, `damping_N_s_per_m`."""
    return GLOSSARY[name].key_for(motion)


def loop_document(
    loop: LinearLoop, coulomb_friction: Fraction, resolution: Fraction, unilateral: bool, motion: str
) -> dict[str, Any]:
    """The loop that a proof or a motion speaks of, exact; H(z) in descending powers of z."""
    size = max(len(loop.numerator), len(loop.denominator))
    delay = (loop.whole_delay + loop.part_delay) * loop.period
    quantities = {
        "damping": loop.damping,
        "coulomb_friction": coulomb_friction,
        "resolution": resolution,
        "sample_period": loop.period,
        "delay": delay,
    }
    return {
        **{unit_key(name, motion): exact_text(value) for name, value in quantities.items()},
        "numerator": [str(c) for c in (*loop.numerator, *[0] * (size - len(loop.numerator)))],
        "denominator": [str(c) for c in (*loop.denominator, *[0] * (size - len(loop.denominator)))],
        "unilateral": unilateral,
    }
