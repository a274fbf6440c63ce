"""What became of each law that was compared: a paragraph on which a person can act, and the tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite, isinf, pi, sin
from typing import TYPE_CHECKING, Any, NamedTuple

from zwidth.lazy import above
from zwidth.loop.traces.measures import SOURCE, WEBER
from zwidth.model.device.device import Device
from zwidth.model.environment.wall import Wall
from zwidth.model.operator import Dowel, MaliciousTouch, PrescribedMotion, TypicalTouch
from zwidth.model.operator.operator import Operator
from zwidth.passivity.check import check
from zwidth.quantity.answered import finite
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import unit_suffix
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import at_most, in_a_table, shown, unit_text
from zwidth.showing import Part, Table
from zwidth.study.bench.adversary import Attack
from zwidth.study.bench.standing import Standing

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class LawComparison(Documented):
    """What became of each law.

    Attributes
    ----------
    scores
        Dimension `law`; the variables of `SCORES`, units and meanings in the attributes, and
        `stiffness_jnds`, just-noticeable differences between what is felt and what was wanted,
        `gain`, energy that the worst motion takes out in a round [J], `step_time` [s],
        `status`: "passive" with a certificate, "theorem" by a proof on paper, no certificate, "active" with
        a motion, or "undecided".
    attacks
        The motion of each law that took out most.
    standings
        What is known of each law for every hand: its status, why, and what of the device that counts.
    traces
        Of each law and touch.
    device, environment
        What was compared.
    radius
        Of a device that turns: how far from its axis it was touched [m]; traces and motions are those of
        that place.  None for a handle.
    """

    _FORMAT = "zwidth laws 1"
    _BESIDES = (
        ("advice", "what to do, in a paragraph"),
        ("touched_at_radius_m", "of a device that turns: how far from its axis"),
        (
            "laws",
            "by the name of each, in the order in which they were compared, with the `scope` and what"
            " follows",
        ),
        ("status", '`"passive"`, `"theorem"`, `"active"` or `"undecided"`'),
        (
            "proof, evidence",
            'what stands behind the status, `"certificate"`, `"paper"` (no certificate), `"motion"` '
            'or `"none"`; why, in a sentence',
        ),
        ("withheld", "promises of the law that this device does not let it keep, and why"),
        (
            "stiffness_jnds",
            "how far what is felt at the press is from what is wanted, in just-noticeable "
            "differences; below 0 it is softer",
        ),
        ("gain_J", "taken out by the worst motion in a round; below 0 it cost the hand so much"),
        ("step_time_s", "of a sample in the simulator"),
    )

    scores: xr.Dataset
    attacks: Mapping[str, Attack]
    standings: Mapping[str, Standing]
    traces: Mapping[str, Mapping[str, xr.Dataset]]
    device: Device
    environment: Wall
    radius: float | None = None

    def about_axis(self, device: Device, wall: Wall, radius: Exact) -> LawComparison:
        """What was found at the rim, `radius` [m] from the axis, of a device that turns and its wall.

        Scores are torques and angles; traces and motions stay those of the rim.
        """
        scores, far = _about_axis(self.scores, float(radius)), float(radius)
        return replace(self, scores=scores, device=device, environment=wall, radius=far)

    @property
    def evidence(self) -> dict[str, str]:
        """Of each law, why its status is what it is."""
        return {name: known.evidence for name, known in self.standings.items()}

    @property
    def advice(self) -> str:
        """What to do, in a paragraph."""
        return " ".join([answer(self.scores, self.device, self.environment), *_promises(self.scores)])

    def in_short(self, most: int = 6) -> Iterable[Part]:
        """What to do, and the table of a few laws."""
        what = answer(self.scores, self.device, self.environment)
        yield f"{self._what()}: {what}"
        yield ""
        yield short_table(self.scores, told_of(self.scores, self.environment), most)
        yield ""
        yield from explained(self.scores)

    def report(self) -> Iterable[Part]:
        """What to do, the table, and what its words mean."""
        yield f"{self._what()}: {self.advice}"
        yield ""
        yield table(self.scores)
        yield ""
        yield legend(self.scores)

    def to_dict(self) -> dict[str, Any]:
        """The scores of each law, a unit in every key, what is known of it, and the advice."""
        laws = {name: self._known(name) | self._scored(name) for name in map(str, self.scores["law"].values)}
        touched = {} if self.radius is None else {"touched_at_radius_m": self.radius}
        return {"format": self._FORMAT, "advice": self.advice, **touched, "laws": laws}

    def _what(self) -> str:
        """What was compared, in a few words."""
        touched = "" if self.radius is None else f", touched {shown(self.radius, 'm')} from its axis"
        law = self.environment.describe(self.device.motion)
        return f"{law} on {self.device.name or 'the device'}{touched}"

    def _known(self, name: str) -> dict[str, Any]:
        known = self.standings[name]
        return {
            "status": known.status,
            "proof": known.proof,
            "evidence": known.evidence,
            "withheld": list(known.withheld),
            "scope": known.scope.to_dict(),
        }

    def _scored(self, name: str) -> dict[str, float | None]:
        """By name and unit; None for what has no bound."""
        scores = self.scores.sel(law=name).drop_vars("status").data_vars.items()
        units = {key: value.attrs["units"] for key, value in scores}
        return {
            str(key) if units[key] == "1" else f"{key}_{unit_suffix(units[key])}": finite(float(value))
            for key, value in scores
        }

    def figure(self) -> Figure:
        """Stability against fidelity, and the touches of each law."""
        figure: Figure = above("plots").laws_figure(self)
        return figure


_TURNED = {"N/m": ("N*m/rad", 2), "N": ("N*m", 1), "m": ("rad", -1), "N*s/m": ("N*m*s/rad", 2)}
"""What a unit at the rim is about the axis, and the power of the radius that takes a value there."""


def _about_axis(scores: xr.Dataset, radius: float) -> xr.Dataset:
    """What was found at the rim, `radius` [m] from the axis, in torques and angles."""
    turned = scores.copy()
    for name, value in scores.data_vars.items():
        unit, power = _TURNED.get(value.attrs.get("units", ""), ("", 0))
        if unit:
            turned[name] = (value.dims, radius**power * value.values, {**value.attrs, "units": unit})
    return turned


QUIET = 0.02
"""Force above 30 Hz below which a wall is called quiet, as part of the largest force."""


def answer(scores: xr.Dataset, device: Device, wall: Wall) -> str:
    """What the wall needs, which law is safest and which feels stiffest.

    `scores`: of the laws, those of a `LawComparison`.
    `device`: what they were simulated on.
    `wall`: what was to be rendered, of one stiffness; its damping is left out.
    """
    wanted = float(wall.stiffness)
    alone: Any = check(device, Wall(wall.stiffness), iterate=False)
    limit, unit = alone.max_stiffness, device.unit("stiffness")
    words = [
        f"Alone, a wall of {shown(wanted, unit, 6)} is passive on this device and needs no law."
        if alone.outcome == "passive"
        else f"The device alone renders {shown(at_most(limit, unit, 4) or 0, unit, 4)} passively: "
        f"{shown(wanted, unit, 6)} needs a law or other hardware."
        if limit
        else "The device alone renders no wall passively."
    ]
    words += _proved(scores)
    best = _quiet(scores, wanted)
    if best is not None:
        felt = float(scores["static_stiffness"].sel(law=best))
        status = str(scores["status"].sel(law=best).item())
        words.append(
            f"Quiet under a fast finger and closest to that is {best!r} with {shown(felt, unit, 4)}"
            + (
                ""
                if status == "passive"
                else "; for every hand it is proved on paper, without a certificate"
                if status == "theorem"
                else f"; it is {status}: a skilled hand takes energy out, an ordinary one did not"
                if status == "active"
                else "; for every hand it is undecided"
            )
            + "."
        )
    else:
        words.append("All of them chatter under a fast finger.")
    return " ".join(words)


def told_of(scores: xr.Dataset, wall: Wall) -> list[str]:
    """The laws that the answer names: the stiffest of each kind of proof, and the quiet one."""
    proved = (scores.where(scores["status"] == status, drop=True) for status in ("passive", "theorem"))
    quiet = _quiet(scores, float(wall.stiffness))
    return [*(_stiffest(some) for some in proved if some.sizes["law"]), *([] if quiet is None else [quiet])]


def _quiet(scores: xr.Dataset, wanted: float) -> str | None:
    """The law that is felt closest to what is wanted, of those that do not chatter under a fast finger."""
    quiet = scores.where(scores["tap_chatter"] <= QUIET * scores["peak_force"], drop=True)
    return min(
        map(str, quiet["law"].values),
        key=lambda name: abs(float(quiet["static_stiffness"].sel(law=name)) - wanted),
        default=None,
    )


def _promises(scores: xr.Dataset) -> list[str]:
    """Which passivity controllers a motion takes energy out of."""
    broken = [
        str(name)
        for name in scores["law"].values
        if "controller" in str(name) and str(scores["status"].sel(law=name).item()) == "active"
    ]
    if not broken:
        return []
    return [f"The promise of {_listed(broken)} does not hold: a motion takes energy out."]


def _proved(scores: xr.Dataset) -> list[str]:
    """The stiffest law with a certificate, and a stiffer one that is proved on paper alone."""
    words, most = [], 0.0
    for status, how in (("passive", "proved"), ("theorem", "proved on paper, without a certificate,")):
        some = scores.where(scores["status"] == status, drop=True)
        if not some.sizes["law"]:
            continue
        best = _stiffest(some)
        felt = float(some["static_stiffness"].sel(law=best))
        if felt > most:
            feels = shown(felt, some["static_stiffness"].attrs["units"], 4)
            words.append(f"The stiffest that is {how} for every hand is {best!r}: it feels like {feels}.")
            most = felt
    return words or ["None of these laws is proved for every hand."]


def _stiffest(scores: xr.Dataset) -> str:
    return str(scores["law"].values[int(scores["static_stiffness"].values.argmax())])


def _listed(names: list[str]) -> str:
    quoted = [repr(name) for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"


class Column(NamedTuple):
    """A heading, what is below it, and in which unit it is shown on a device that is linear."""

    heading: str
    variable: str
    factor: float
    unit: str


COLUMNS = (
    Column("felt", "static_stiffness", 1.0, "N/m"),
    Column("JNDs", "stiffness_jnds", 1.0, ""),
    Column("hardness", "rate_hardness", 1.0, "N/m"),
    Column("depth", "penetration", 1e3, "mm"),
    Column("chatter", "tap_chatter", 1e3, "mN"),
    Column("bounces", "bounces", 1.0, ""),
    Column("settles", "settling_time", 1e3, "ms"),
    Column("peak", "peak_force", 1.0, "N"),
    Column("law gave", "generated_energy", 1e3, "mJ"),
    Column("to a dowel", "dowel_energy", 1e3, "mJ"),
    Column("free air", "free_damping", 1.0, "N·s/m"),
    Column("adversary", "gain", 1e3, "mJ/round"),
    Column("step", "step_time", 1e9, "ns"),
)


ON_PAPER = "on paper"
"""What the table calls a proof on paper, no certificate."""


def table(scores: xr.Dataset) -> Table:
    """Headings, units, and a row for each law."""
    return Table(
        heads=_heads(columns_of(scores)),
        rows=[_row(scores.sel(law=name)) for name in scores["law"].values],
        lefts=2,
    )


def columns_of(scores: xr.Dataset) -> list[Column]:
    """The columns in the units of these scores, an angle in the unit that was typed."""
    return [_in_its_unit(c, scores[c.variable].attrs["units"]) for c in COLUMNS]


def _in_its_unit(column: Column, unit: str) -> Column:
    if "rad" not in unit and unit != "N*m":
        return column
    factor, told = spoken(unit)
    prefix = "m" if column.factor == 1e3 and "deg" not in told else ""
    return column._replace(factor=factor * (1e3 if prefix else 1.0), unit=prefix + unit_text(told))


def _row(one: xr.Dataset, columns: Sequence[Column] = ()) -> list[str]:
    columns = columns or columns_of(one)
    status = str(one["status"].item())
    cells = (_number(float(one[c.variable]) * c.factor) for c in columns)
    return [str(one["law"].item()), ON_PAPER if status == "theorem" else status, *cells]


_KEYS = ("static_stiffness", "generated_energy", "gain")
"""What is felt, what the law gave, and what the worst motion takes: the columns of a short table."""

_RANK = ("passive", "theorem", "undecided", "active")


def short_table(scores: xr.Dataset, first: Sequence[str], most: int) -> Table:
    """At most so many laws with three numbers each: the first, those proved, those that give out least."""
    columns = [c for c in columns_of(scores) if c.variable in _KEYS]

    def rank(name: str) -> tuple[bool, int, float]:
        one = scores.sel(law=name)
        return name not in first, _RANK.index(str(one["status"].item())), float(one["generated_energy"])

    chosen = sorted(map(str, scores["law"].values), key=rank)[:most]
    rows = [_row(scores.sel(law=name), columns) for name in chosen]
    return Table(heads=_heads(columns), rows=rows, lefts=2)


def _heads(columns: Sequence[Column]) -> list[list[str]]:
    return [["law", "status", *(c.heading for c in columns)], ["", "", *(c.unit for c in columns)]]


def legend(scores: xr.Dataset) -> str:
    """What the words of the table mean that are not clear by themselves."""
    steps = f"just-noticeable differences of {WEBER:.0%} ({SOURCE})"
    jnds = f"JNDs: felt against the stiffness that is wanted, in {steps}; below 0 it is softer"
    return "; ".join([*explained(scores), jnds])


def explained(scores: xr.Dataset) -> list[str]:
    """Which energy is meant, and by the proofs without a certificate, where there are some."""
    gave = (
        "law gave: in a tap, the most that the law had given beyond what it had taken; of one that is proved "
        "the device's friction takes all of it, and the hand gets none"
    )
    theorem = [f"{ON_PAPER}: a theorem, by a proof on paper, no certificate"]
    return [gave, *(theorem if (scores["status"] == "theorem").any() else [])]


def _number(value: float) -> str:
    if isinf(value):
        return "never"
    if not isfinite(value):
        return "–"
    if abs(value) < 5e-4:
        return "0"
    return in_a_table(value, 3)


# The touches that every law is given.


PRESSING = 2.0
"""Force with which a finger presses, where the actuator can bear it [N]."""

STROKE, STROKE_TIME = 0.01, 0.25
"""Amplitude and period of the stroke in free air [m], [s]."""


@dataclass(frozen=True)
class Touch:
    """A hand and how long it is watched [s]."""

    hand: Operator
    duration: float


def standard_touches(device: Device, stiffness: float) -> dict[str, Touch]:
    """The touches for a wall of a stiffness [N/m] on a device.

    The push is that of a finger, or half the actuator's force limit where that is less.
    The fast finger is tuned to the wall, √(k/m_h) = √(K/m), as a malicious one would be.
    """
    limit = device.force_limit
    push = PRESSING if limit is None else min(PRESSING, float(device.exact("force_limit")) / 2)
    loose = MaliciousTouch(force=push)
    mass = float(device.exact("mass"))
    tuned = max(loose.mass * stiffness / mass, 1.0)
    stroke = PrescribedMotion(lambda t: -2 * STROKE + STROKE * sin(2 * pi * t / STROKE_TIME))
    return {
        "press": Touch(TypicalTouch(force=push), 1.5),
        "tap": Touch(MaliciousTouch(force=push, stiffness=tuned), 1.5),
        "dowel": Touch(Dowel(force=push), 1.5),
        "free air": Touch(stroke, 4 * STROKE_TIME),
    }
