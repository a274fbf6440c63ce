"""What a result is about, as data: which hands, which contact, what of encoder and actuator is counted.

A verdict means no more than the theorem behind it.  So every result carries this record, the words of its
claim are made from it (`wording`), last and in one place, and what it says of contact is what the
independent checker found in the proof.  With it stand the outcomes, and proofs and motions as plain data.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from zwidth.errors import InputError
from zwidth.model.device.device import require_rigid
from zwidth.passivity.linear.loop import LinearLoop
from zwidth.quantity.answered import answered, data_of, known
from zwidth.quantity.exact import Interval, ends
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.parameter import Parametric, parameters_of
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

Transmission = Literal["rigid", "any", "as given", ""]
"""Motor, encoder and hand move as one; whatever stands behind the motor; one with these numbers; or none."""

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
    """Which hands: every hand, unless a bound stands here."""

    speed: float | None = known(
        "largest mean speed over a sample, or over `part` of one", quantity="speed", default=None
    )
    in_each_part: bool = known(
        "True if the bound on speed is for each part of a sample with one force", default=False
    )
    inside: float | None = known("how deep it goes; None: any depth", quantity="position", default=None)
    outside: float | None = known(
        "how far outside it goes; None: any distance", quantity="position", default=None
    )
    counts_a_sample: float | None = known(
        "the speed in counts of the encoder, told beside it; None: it is not", default=None
    )
    counts_inside: float | None = known("the depth likewise", default=None)
    impedance: str | None = known("the one hand that is known, in words; None for all others", default=None)
    activity: float | None = known(
        "what a hand gives out at most, as a damping; None: no such bound", quantity="damping", default=None
    )
    below: float | None = known("at frequencies below this; None: at all", unit="Hz", default=None)

    @property
    def every(self) -> bool:
        """True if nothing is asked of the hand."""
        return self == Hands()


@dataclass(frozen=True, kw_only=True)
class Scope:
    """What a result is about."""

    hands: Hands = known("which hands", default=Hands())
    contact: Contact = answered(
        '`"made and broken"` at will, `"kept"`, or `"both sides"`: the law has no surface. Of a motion that '
        "takes energy out: what it does",
        default="made and broken",
    )
    encoder: Encoder = answered(
        '`"ideal"`, `"counted"`: its steps are in the proof, or `"not counted"`', default="ideal"
    )
    force_limit: bool = answered(
        "whether the actuator's force limit is in the proof; else it is ideal",
        key="force_limit_counted",
        default=False,
    )
    force_steps: bool = answered(
        "the same of its converter's steps", key="force_steps_counted", default=False
    )
    largest_force: float | None = answered(
        "force of the wall up to which it holds; missing for any",
        quantity="force",
        key="largest_force",
        optional=True,
        default=None,
    )
    largest_moment: float | None = answered(
        "of an arm in pose, its moment likewise", unit="N*m", optional=True, default=None
    )
    transmission: Transmission = answered(
        '`"rigid"`: motor, encoder and hand move as one, no cable, belt or gear gives way between them; '
        '`"any"`: the friction of the motor\'s side pays, whatever stands behind it; `"as given"`. Missing '
        "where there is no device",
        optional=True,
        default="rigid",
    )
    torque: Torque = answered(
        'of an arm, what becomes of the torque within a period: `"follows the arm"`, `"follows the readings"`'
        ' or `"held"`',
        optional=True,
        default="",
    )
    sampling: Sampling = answered('`"constant"`, period and delay; or `"any"`', default="constant")
    damping: float | None = answered(
        "b that the device takes out at least; null where a curve says it, where there are several joints, "
        "or where it is left out",
        quantity="damping",
        default=None,
    )
    coulomb_friction: float | None = answered("f_c likewise", quantity="coulomb_friction", default=None)
    friction_speed: float | None = answered(
        "only where it is known: the speed up to which the friction was measured; else it is taken for every "
        "speed",
        quantity="friction_speed",
        optional=True,
        default=None,
    )
    friction: FrictionCurve | None = known("the measured curve in the place of both, or None", default=None)
    fed_with: FedWith = answered(
        "only where it matters: what the law's memory must be fed with for a proof to hold, "
        '`"position"` or `"penetration"`',
        optional=True,
        default="",
    )
    clamped: bool = answered("true for a law that never pulls: a force below 0 is given as 0", default=False)
    region: str | None = answered("of an arm: where it stays, in words", optional=True, default=None)
    intervals: tuple[str, ...] = answered(
        "parameters that stand for every value in an interval", optional=True, default=()
    )
    bounds: tuple[tuple[str, float, float], ...] = known(
        "the ends of those that have a name of their own: (parameter, low, high), SI", default=()
    )
    assumed: tuple[str, ...] = answered(
        "parameters of the device that were not given and are taken as 0", optional=True, default=()
    )
    law: tuple[Law, ...] = answered(
        'what of the law is not exact or not looked at: `"rounded coefficients"`, `"rounded power"`, '
        '`"table"`, `"doubles"`, `"any before the last"`, `"covered by a wall"`, `"covered with less '
        'friction"`, `"behind a coupling"`: a scene that gives out no energy, of which the coupling alone is '
        "proved",
        optional=True,
        default=(),
    )
    also: tuple[Also, ...] = answered(
        'what else the proof covers: `"springs"` of any slope from 0 to K, the wall if it is `"clamped"`',
        optional=True,
        default=(),
    )
    motion: str = known('"linear" or "rotary": the units', default="linear")

    def replace(self, **changes: Any) -> Scope:
        """The same record with some entries changed."""
        return replace(self, **changes)

    def to_dict(self) -> dict[str, Any]:
        """The record as plain data, a unit in every key of a physical quantity."""
        bounds = {unit_key(name, self.motion): [low, high] for name, low, high in self.bounds}
        return {
            "hands": _hands_document(self.hands, self.motion),
            **data_of(self),
            **({} if self.friction is None else {"friction": "curve"}),
            **({"bounds": bounds} if bounds else {}),
        }


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


OF_THE_LAW = "the environment's intervals"
"""Stands for those of an environment of which two have one name."""


def scope_of(device: Device, environment: Environment) -> Scope:
    """What is asked of a loop, before anything is found: every hand, contact as the law has it."""
    require_rigid(device, "this claim")
    friction, damping = ends(device.coulomb_friction)[0], ends(device.damping)[0]
    uncertain = {k: v for k, v in device.parameters().items() if isinstance(v, Interval)}
    of_law = [*in_intervals(environment, environment)]
    if len(both := {**uncertain, **dict(of_law)}) == len(uncertain) + len(of_law):  # no name stands twice
        uncertain = both
    is_named = environment.is_certain or (of_law and both is uncertain)
    return Scope(
        contact="made and broken" if environment.unilateral else "both sides",
        encoder="counted" if ends(device.resolution)[1] else "ideal",
        damping=float(damping),
        coulomb_friction=float(friction),
        friction_speed=None if device.friction_speed is None else float(ends(device.friction_speed)[0]),
        clamped=environment.clamped and not environment.spring,
        intervals=(*uncertain, *(() if is_named else (OF_THE_LAW,))),
        bounds=tuple((k, float(v.low), float(v.high)) for k, v in uncertain.items()),
        assumed=device.assumed,
        law=("rounded coefficients",) if environment.coefficients_rounded else (),
        motion=device.motion,
    )


def in_intervals(given: Any, at: Any) -> Iterator[tuple[str, Any]]:
    """By the names of the glossary, what `at` has in the place of each interval of `given`, at any depth."""
    for name, one in parameters_of(type(given)).items():
        value = getattr(given, name)
        if isinstance(value, Interval):
            yield one.quantity.name, getattr(at, name)
        elif isinstance(value, Parametric):
            yield from in_intervals(value, getattr(at, name))


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
