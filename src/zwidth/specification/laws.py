"""The laws in a row behind an environment that a specification can name.

    [[law]]                                  --law extrapolation,passivity-controller
    type = "passivity-controller"
    largest_damping = "0.8 N*s/m"

`LAWS` is the registry: a new law is one row, its name that of the class in small letters.
The order of the tables is the order of the laws, from the environment to the actuator.  On
the command line a law has its defaults; laws there take the place of the file's.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from zwidth.environment import Environment
from zwidth.errors import InputError
from zwidth.quantity.units import parse_number
from zwidth.specification.table import COMMAND_LINE, Table, located, quoted, suggestion
from zwidth.specification.values import flag, quantities

if TYPE_CHECKING:
    from zwidth.rendering import Estimator, Stage

Form = Literal["quantity", "word", "flag", "list", "velocity"]

NOT_PROVED = (
    "laws in a row have no place in this command: zwidth check decides them, zwidth limit says how far one "
    "may go, zwidth compare judges them, zwidth simulate shows a touch"
)
"""What commands say to them that take a device alone, or a wall."""

MOST = 16
"""Laws in a row; more is a mistake."""

ROW = "row"
"""The one key of the table in which the laws of a file are kept."""


class Key(NamedTuple):
    """One key of a [[law]] table, an argument of its class; a quantity may have words in its place."""

    form: Form
    meaning: str
    unit: str = ""
    rotary_unit: str = ""
    required: bool = False
    words: tuple[str, ...] = ()

    def unit_for(self, motion: str) -> str:
        """The SI unit, by the device's motion."""
        return self.rotary_unit if motion == "rotary" else self.unit


class LawType(NamedTuple):
    """A law, or a velocity estimator of one: its class in `zwidth.rendering` and its keys."""

    class_name: str
    meaning: str
    keys: Mapping[str, Key]


def _quantity(meaning: str, unit: str = "1", rotary_unit: str | None = None, required: bool = False) -> Key:
    return Key("quantity", meaning, unit, unit if rotary_unit is None else rotary_unit, required)


def _word(first: str, *others: str) -> Key:
    last = f"{', '.join([f'{first} (default)', *others[:-1]])} or {others[-1]}"
    return Key("word", last, words=(first, *others))


def _length(meaning: str) -> Key:
    return _quantity(meaning, "m", "rad")


def _speed(meaning: str) -> Key:
    return _quantity(meaning, "m/s", "rad/s")


def _force(meaning: str) -> Key:
    return _quantity(meaning, "N", "N*m")


def _stiffness(meaning: str) -> Key:
    return _quantity(meaning, "N/m", "N*m/rad")


def _damping(meaning: str, required: bool = False, words: tuple[str, ...] = ()) -> Key:
    return _quantity(meaning, "N*s/m", "N*m*s/rad", required)._replace(words=words)


def _mass(meaning: str) -> Key:
    return _quantity(meaning, "kg", "kg*m^2")


_VELOCITY = Key("velocity", "adaptive-window (default), tick-time, kalman, or a table of one of them")
_CLAMPED = Key("flag", "true for a sum that never pulls")
_MODEL = {
    "mass": _mass("of the device, where its own is not meant"),
    "damping": _damping("of the device, where its own is not meant"),
    "finger_mass": _mass("of the finger that the law reckons with"),
    "finger_stiffness": _stiffness("of that finger"),
    "finger_damping": _damping("of that finger"),
    "finger_position": _length("where that finger is at rest"),
}

LAWS: Mapping[str, LawType] = MappingProxyType(
    {
        "extrapolation": LawType(
            "Extrapolation",
            "the environment meets the hand n samples ahead",
            {"samples": _quantity("n, by default ½")},
        ),
        "half-sample-prediction": LawType(
            "HalfSamplePrediction", "half a sample ahead, by a model of device and finger", _MODEL
        ),
        "crossing-correction": LawType(
            "CrossingCorrection",
            "two forces that repair what sampling did where the surface is crossed",
            {"throughout": Key("flag", "true to go on with it inside"), **_MODEL},
        ),
        "pole-matched": LawType(
            "PoleMatched", "gains that give the held loop the poles of the continuous one", _MODEL
        ),
        "damper": LawType(
            "Damper",
            "a damper on an estimated velocity",
            {"damping": _damping("B of the damper", True), "velocity": _VELOCITY, "clamped": _CLAMPED},
        ),
        "hysteresis": LawType(
            "Hysteresis",
            "a spring that slips: friction inside the wall",
            {
                "force": _force("h, at which the spring slips; this or fastest is needed"),
                "stiffness": _stiffness("k of that spring, by default the environment's"),
                "fastest": _speed("speed up to which it pays for the hold"),
                "clamped": _CLAMPED,
            },
        ),
        "passivity-controller": LawType(
            "PassivityController",
            "damping where the energy that was counted is lacking",
            {
                "observer": _word("sampled", "past", "published"),
                "largest_damping": _damping(
                    'α, what it adds at most, by default b of the device; or "unlimited"',
                    words=("unlimited",),
                ),
                "largest_force": _force("what it adds at most"),
                "slowest": _speed("speed below which it adds nothing"),
                "credit": Key("flag", "true to count in what the device dissipates"),
                "reference": _word("zero", "spring"),
                "resets": Key("flag", "true to count anew in each contact"),
                "ceiling": _quantity("energy above which no credit is kept", "J"),
                "forgetting": _quantity("time constant in which credit is forgotten", "s"),
            },
        ),
        "windowed-controller": LawType(
            "WindowedController",
            "the same with a window that forgets, a floor under the speed and a clamp",
            {
                "window": _quantity("N, samples after which what was lost is forgotten, by default 30"),
                "slowest": _speed("v₀, floor under the speed, by default 0.01 m/s; 0.0316 rad/s"),
                "share": _quantity("s, part of the largest damping that is used, by default 0.9"),
                "largest_damping": _damping("α_max, by default b of the device"),
            },
        ),
        "rate-term": LawType(
            "RateTerm",
            "a force that leads by τ: f + τ df/dt",
            {"time_constant": _quantity("τ, by default T/2", "s")},
        ),
        "force-bounding": LawType(
            "ForceBounding",
            "no more force than what the hand has put in can pay for",
            {
                "encoder": _word("counted", "ideal"),
                "resets": Key("flag", "true to forget the energy where there was no force"),
            },
        ),
        "energy-bounding": LawType(
            "EnergyBounding", "a force that changes with no more than 2b/T per move", {}
        ),
        "energy-tank": LawType(
            "EnergyTank",
            "the wall pushes with what is in a tank, which a damper fills",
            {
                "level": _quantity("H_d, to which the tank is filled", "J"),
                "refill": _quantity("α, damping per lacking energy", "s/m^2", "N*m*s/(rad*J)"),
                "largest_damping": _damping("d, by default the device's"),
            },
        ),
        "passive-leap": LawType(
            "PassiveLeap",
            "the wall's spring holds just the energy that came in",
            {
                "stiffness": _stiffness("K of that spring, by default the environment's"),
                "resets": Key("flag", "true to forget credit where there was no force"),
            },
        ),
        "dual-rate": LawType(
            "DualRate",
            "a local spring between slow updates",
            {
                "samples": _quantity("N, samples between two updates", required=True),
                "slope": _stiffness("κ, by default what b pays for"),
                "updates": _word("continuous", "jump"),
            },
        ),
        "held": LawType(
            "Held",
            "the force of every N-th sample, held",
            {"samples": _quantity("N, samples between two updates", required=True)},
        ),
        "braking-pulse": LawType(
            "BrakingPulse",
            "one sample of force that stops the mass at entry",
            {
                "mass": _mass("what is to be stopped, by default the device's"),
                "limit": _force("the largest pulse, by default the force limit"),
                "velocity": _VELOCITY,
            },
        ),
        "event-transient": LawType(
            "EventTransient",
            "what a tap on something hard adds, in open loop",
            {
                "kind": _word("decaying", "fixed", "acceleration"),
                "amplitude": _damping("A, by default what stops the mass"),
                "duration": _quantity("how long it is played", "s"),
                "frequency": _quantity("f of the decaying one, by default 100 Hz", "Hz"),
                "time_constant": _quantity("τ of the decaying one, by default 10 ms", "s"),
                "record": Key("list", "deceleration in a tap at unit speed, a number a sample", "1/s", "1/s"),
                "mass": _mass("what is to be stopped, by default the device's"),
                "velocity": _VELOCITY,
            },
        ),
        "slew-limit": LawType(
            "SlewLimit",
            "a force that changes no faster than a motor's current can",
            {"rate": _quantity("R, by default what the device's winding allows", "N/s", "N*m/s")},
        ),
        "dither": LawType(
            "Dither",
            "a small force that carries the command over the converter's steps",
            {
                "amplitude": _force("a, by default a part of a converter step"),
                "kind": _word("alternating", "random"),
                "seed": _quantity("of the random one, a whole number"),
            },
        ),
        "saturation": LawType(
            "Saturation", "a force no larger than a limit", {"limit": _force("F, by default the force limit")}
        ),
    }
)
"""Every law, by name."""

ESTIMATORS: Mapping[str, LawType] = MappingProxyType(
    {
        "adaptive-window": LawType(
            "AdaptiveWindow",
            "slope of the longest line that fits the readings",
            {
                "noise": _length("d, how far a reading may be off, by default one count"),
                "longest": _quantity("N, the longest window in samples, by default 15"),
                "fit": _word("end", "best"),
            },
        ),
        "tick-time": LawType("TickTime", "counts over the time between two of them", {}),
        "kalman": LawType(
            "Kalman",
            "the settled filter of position and velocity",
            {"acceleration": _quantity("√q in (m/s²)/√Hz or (rad/s²)/√Hz, a plain number")},
        ),
    }
)
"""The velocities of laws, by name."""


def with_laws(
    environment: Environment, table: Table | None, typed: Iterable[str] | None, motion: str
) -> Environment:
    """The environment behind the laws that were given; itself where there are none.

    Parameters
    ----------
    environment
        What the hand meets.
    table
        The [[law]] tables of a file.
    typed
        What stood behind each `--law`; takes the place of the file's.
    motion
        "linear" or "rotary", of the device.

    Raises
    ------
    InputError
        If a law or a key is unknown, or has a value it cannot have.
    """
    tables = _tables(table) if typed is None else [*_named(typed)]
    if len(tables) > MOST:
        raise InputError(f"{tables[MOST].label}: more than {MOST} laws in a row")
    laws = [build_law(law, motion) for law in tables]
    if not laws:
        return environment
    from zwidth.rendering import render  # the compiler of their steps takes its time

    return render(environment, *laws)


def _tables(table: Table | None) -> list[Table]:
    if table is None:
        return []
    row = table.values[ROW]
    assert isinstance(row, list)
    many = len(row) > 1
    return [Table(f"{table.label} {n}" if many else table.label, one) for n, one in enumerate(row, 1)]


def _named(typed: Iterable[str]) -> Iterable[Table]:
    for names in typed:
        for name in names.split(","):
            yield Table(f"{COMMAND_LINE}: --law", {"type": name.strip()})


def build_law(table: Table, motion: str) -> Stage:
    """The law that a table describes, in the units of the device's motion.

    Raises
    ------
    InputError
        If the type or a key is unknown, missing, or has a value it cannot have.
    """
    law: Stage = _built(table, LAWS, "law", motion)
    return law


def _built(table: Table, kinds: Mapping[str, LawType], what: str, motion: str) -> Any:
    if "type" not in table.values:
        raise InputError(f"{table.label}: type is missing; it may be: {', '.join(kinds)}")
    name = table.text("type")
    if name not in kinds:
        raise InputError(f"{table.label}: there is no {what} {quoted(name)}; {suggestion(name, kinds)}")
    row = kinds[name]
    table.check_keys(("type", *row.keys), f'a {what} of type "{name}"')
    missing = [key for key, k in row.keys.items() if k.required and key not in table.values]
    if missing:
        needed = ", ".join(f"{key} [{row.keys[key].unit_for(motion)}]" for key in missing)
        where = ", in a [[law]] table of a file" if table.label.startswith(COMMAND_LINE) else ""
        raise InputError(f'{table.label}: the {what} "{name}" needs {needed}{where}')
    with located(table.label):
        arguments = {
            key: _read(table.values[key], key, row.keys[key], motion) for key in table.values if key != "type"
        }
        return getattr(import_module("zwidth.rendering"), row.class_name)(**arguments)


def _read(value: object, key: str, kind: Key, motion: str) -> Any:
    if kind.form == "word":
        if not isinstance(value, str):
            raise InputError(f'{key} is a text in quotes, such as {key} = "{kind.words[0]}"')
        if value not in kind.words:
            raise InputError(f"{key}: there is no {quoted(value)}; {suggestion(value, kind.words)}")
        return value
    if kind.form == "flag":
        return flag(value, key)
    if kind.form == "quantity" and isinstance(value, str) and value in kind.words:
        return value
    if kind.form == "velocity":
        return _velocity(value, key, motion)
    if kind.form == "list":
        return quantities(value, kind.unit_for(motion), key)
    return parse_number(value, kind.unit_for(motion), key)


def _velocity(value: object, key: str, motion: str) -> Estimator:
    values = {"type": value} if isinstance(value, str) else value
    if not isinstance(values, Mapping):
        raise InputError(f'{key} is {{ type = "…" }} with one of the types {", ".join(ESTIMATORS)}')
    estimator: Estimator = _built(Table(key, values), ESTIMATORS, "velocity", motion)
    return estimator
