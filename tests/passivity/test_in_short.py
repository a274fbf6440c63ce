"""What limits a claim is in its short form too: every entry of the record, every value it may have."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, get_args

import pytest

import zwidth as zw
from zwidth.passivity import scope as record
from zwidth.passivity.scope import Hands, Scope
from zwidth.passivity.wording import in_short, intervals, lines

PLAIN = Scope(damping=0.2, coulomb_friction=0.1, encoder="counted")

SAID: list[tuple[dict[str, Any], str]] = [
    ({"hands": Hands(speed=0.5)}, "only hands of up to 0.5 m/s over one sample"),
    ({"hands": Hands(speed=0.5, in_each_part=True)}, "over each part of a sample"),
    ({"hands": Hands(inside=0.002, outside=0.001)}, "up to 2 mm inside and 1 mm outside"),
    ({"hands": Hands(impedance="a mass of 1 kg")}, "only a hand that is known: a mass of 1 kg"),
    ({"hands": Hands(activity=0.05, below=10)}, "give out at most 0.05 N·s/m below 10 Hz"),
    ({"contact": "made and broken"}, "contact made and broken"),
    ({"contact": "kept"}, "contact kept: making and breaking it is not covered"),
    ({"contact": "both sides"}, "what a spring holds where the motion starts may come back"),
    ({"encoder": "ideal"}, "ideal position sensor"),
    ({"encoder": "counted"}, "encoder steps counted"),
    ({"encoder": "not counted"}, "encoder steps left out"),
    ({"force_limit": True}, "force limit counted, else an ideal actuator"),
    ({"force_steps": True}, "converter steps counted, else an ideal actuator"),
    ({"largest_force": 3.0}, "forces of the wall up to 3 N"),
    ({"largest_force": 3.0, "largest_moment": 0.2}, "and moments up to 0.2 N·m"),
    ({"transmission": "rigid"}, "motor, encoder and hand move as one"),
    ({"transmission": "any"}, "any stiffness between motor and hand"),
    ({"transmission": "as given"}, "a transmission of the numbers given"),
    ({"torque": "follows the arm"}, "torque follows the arm"),
    ({"torque": "follows the readings"}, "torque follows the encoders"),
    ({"torque": "held"}, "torque held over a sample"),
    ({"sampling": "constant"}, "constant period and delay, no missed samples"),
    ({"sampling": "any"}, "any sample period"),
    ({"damping": 0.25}, "at least b = 0.25 N·s/m"),
    ({"coulomb_friction": 0.125}, "f_c = 0.125 N"),
    ({"coulomb_friction": None}, "Coulomb friction left out"),
    ({"friction_speed": 0.6}, "measured up to 0.6 m/s and taken for granted beyond"),
    (
        {"friction": zw.FrictionCurve([0.1, 0.2], [0.2, 0.25])},
        "friction not below its measured curve, continued beyond its ends",
    ),
    ({"fed_with": "position"}, "fed with the position"),
    ({"fed_with": "penetration"}, "fed with the penetration"),
    ({"clamped": True}, "never pulls"),
    ({"region": "x from 0 to 1 m"}, "the arm in its region, x from 0 to 1 m"),
    ({"assumed": ("delay", "coulomb_friction")}, "delay, Coulomb friction not given, taken as 0"),
    ({"law": ("rounded coefficients",)}, "coefficients of H(z) rounded"),
    ({"law": ("rounded power",)}, "K uⁿ rounded"),
    ({"law": ("table",)}, "a table of its states"),
    ({"law": ("doubles",)}, "below 1e-300 aside"),
    ({"law": ("floats",)}, "below 1e-36 aside"),
    ({"law": ("any before the last",)}, "laws before the last one"),
    ({"law": ("behind a coupling",)}, "what scene and coupling hold at first may come back"),
    ({"law": ("covered by a wall",)}, "covered by the proof of a wall"),
    ({"law": ("covered with less friction",)}, "a wall with less friction"),
    ({"law": ("potential bounded below",)}, "whose potential is bounded below"),
    ({"law": ("energy at first bounded",)}, "of a bounded energy at first"),
    ({"motion": "rotary"}, "b = 0.2 N·m·s/rad"),
]
"""Changes of the record, and what then must be said."""

ELSEWHERE = {
    "intervals": "a line of its own beside the loop, see below",
    "bounds": "the ends of the intervals, in the same line",
    "also": "more than the claim, never less",
}


@pytest.mark.parametrize(("changes", "words"), SAID, ids=lambda value: str(value)[:40])
def test_what_limits_a_claim_is_said_in_short(changes: dict[str, Any], words: str) -> None:
    """In the words of the entry, once."""
    assert in_short(PLAIN.replace(**changes), "passive").count(words) == 1


def test_every_entry_of_the_record_is_said() -> None:
    """A new entry is said too, or it is said here where it stands."""
    said = {entry for changes, _ in SAID for entry in changes}
    assert {field.name for field in fields(Scope)} == said | {*ELSEWHERE}


@pytest.mark.parametrize(
    "entry", ["contact", "encoder", "sampling", "transmission", "torque", "fed_with", "law"]
)
def test_every_value_of_an_entry_is_said(entry: str) -> None:
    kind = getattr(record, entry.title().replace("_", ""))
    values = [changes[entry] for changes, _ in SAID if entry in changes]
    tried = {one for value in values for one in (value if isinstance(value, tuple) else (value,))}
    assert tried == set(get_args(kind)) - {""}


def test_the_ideal_actuator_is_said() -> None:
    """Nothing of the actuator is counted unless the claim says so."""
    assert "ideal actuator" in in_short(PLAIN, "passive")
    both = in_short(PLAIN.replace(force_limit=True, force_steps=True), "passive")
    assert "force limit and converter steps counted, else an ideal actuator" in both


def test_bounds_on_hands_are_those_of_a_proof() -> None:
    """A motion that was found is no claim about hands within bounds; it says what it does at the wall."""
    bounded = PLAIN.replace(hands=Hands(speed=0.5), contact="kept")
    assert "only hands" not in in_short(bounded, "active")
    assert "the motion stays inside" in in_short(bounded, "active")
    assert "of any force" in in_short(bounded, "passive")
    assert "of any speed and force" not in in_short(bounded, "passive")


def test_intervals_stand_beside_the_loop() -> None:
    wide = PLAIN.replace(intervals=("damping",), bounds=(("damping", 0.1, 0.2),))
    assert "every value within damping 0.1 … 0.2 N·s/m" in str(intervals(wide, "passive"))


def test_it_is_shorter_than_the_whole() -> None:
    """Two thirds of it at most, for a usual loop."""
    loop = zw.check(zw.catalogue.device("haptic-paddle"), zw.Wall(stiffness=300))
    whole = "; ".join(lines(loop.scope, loop.outcome))
    assert len(in_short(loop.scope, loop.outcome)) < 0.67 * len(whole)
