"""Numbers and units as people read them, in the unit of angle in which the question was asked."""

import ast
import re
from collections.abc import Iterator
from math import inf, nan, pi
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from zwidth.errors import InputError
from zwidth.quantity.exact import Interval
from zwidth.quantity.spoken import answers_as_typed, answers_in, spoken
from zwidth.quantity.text import (
    from_to,
    in_a_table,
    in_words,
    quantity_unit,
    shown,
    shown_at_least,
    shown_at_most,
    told_quantity,
    unit_text,
)
from zwidth.quantity.units import parse, parse_number


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (22.4e-6, "m", "22.4 µm"),
        (0.12, "N", "0.12 N"),
        (0.00336, "N", "3.36 mN"),
        (999.96e-6, "s", "1 ms"),
        (-0.001427, "J", "-1.427 mJ"),
        (0.5, "m/s", "0.5 m/s"),
        (7111, "m/s", "7111 m/s"),
        (0.1427, "J", "142.7 mJ"),
        (0.1554, "Hz", "0.1554 Hz"),
        (2567, "Hz", "2.567 kHz"),
        (0.05, "N*m", "0.05 N·m"),
        (0.0027471, "N*m", "2.747 mN·m"),
        (2.5e-5, "rad", "25 µrad"),
        (1e-5, "N*s/m", "10 µN·s/m"),
        (6e-6, "kg", "6 mg"),
        (0.00055, "H", "550 µH"),
        (5e-5, "1", "5e-05"),
        (300, "N/m", "300 N/m"),
        (0.15, "N*m*s/rad", "0.15 N·m·s/rad"),
        (5, "1", "5"),
        (0.0525, "%", "5.25 %"),
        (2.3e-6, "m/N", "2.3 µm/N"),
        (nan, "N", "nan N"),
        (0.0049, "kg", "4.9 g"),
        (Interval(500, 2500), "Hz", "500 … 2500 Hz"),
        (Interval(500e-6, 0.01), "N*m", "0.5 … 10 mN·m"),
        (Interval(100, 20000), "N/m", "100 … 20000 N/m"),
        (0, "m", "0 m"),
        (1e30, "J", "1e+30 J"),
        (5e-324, "J", "4.941e-324 J"),
        (inf, "N/m", "any"),
        (None, "N/m", "none"),
    ],
)
def test_a_value_with_its_unit(value, unit, text):
    assert shown(value, unit) == text


UNITS = (
    "m",
    "m/s",
    "s",
    "J",
    "Hz",
    "N",
    "N*m",
    "rad",
    "rad/s",
    "N*m/rad",
    "N*m*s/rad",
    "N/m",
    "N*s/m",
    "kg",
    "A",
    "H",
)
ONLY_BELOW = {"m", "m/s", "s", "rad", "rad/s", "kg"}
"""Of these nobody says kilo."""
UNITS = (*ONLY_BELOW, "J", "Hz", "N", "N*m", "N*m/rad", "N*m*s/rad", "N/m", "N*s/m", "A", "H")


@given(
    st.floats(1e-9, 9e8),
    st.sampled_from((-1, 1)),
    st.sampled_from(UNITS),
    st.sampled_from((3, 4, 6)),
    st.booleans(),
)
@example(0.05, 1, "N*m", 4, False)
@example(999.96e-6, 1, "s", 4, False)
@example(7111.0, 1, "m/s", 4, False)
def test_a_value_reads_as_people_say_it(size, sign, unit, digits, in_degrees):
    """1 to 999 before a prefix, no exponent where a prefix can stand; read again it is the value."""
    with answers_in("deg") if in_degrees else answers_in():
        text = shown(sign * size, unit, digits)
    number, name = text.split()
    assert float(parse_number(text, unit, "it")) == pytest.approx(sign * size, rel=0.6 * 10.0 ** (1 - digits))
    plain = unit_text(spoken_in_degrees(unit) if in_degrees else unit)
    if name != plain:
        assert 1 <= abs(float(number)) < 1000, text
    elif "deg" not in name and not (unit in ONLY_BELOW and size >= 1) and not (unit == "Hz" and size < 1):
        assert 0.001 <= abs(float(number)) < 1e6, text
        assert "e" not in number


SOURCE = Path(__file__).parents[2] / "src/zwidth"
A_UNIT = re.compile(r" ?[%°]| [pnµmkMG]?(m|s|g|N|Hz|J|rad|deg|A|V|H|W|Ω)(?![A-Za-z])")
A_NAME = re.compile(r"unit|'(m|N|rad)\b")
A_NUMBER = re.compile(r"[.0-9]*[efg]")
BY_THEMSELVES = {
    "checker/": "imports nothing of the project",
    "cli/check/verify.py": "energies beyond every double",
    "cli/data/diagnosis_report.py: unit": "an option to be typed",
    "cli/new/": "what is typed into a file",
    "data/diagnosis/causes.py: ° ": "an angle between two sinusoids, whichever angle was typed",
    "data/diagnosis/pairs/diagnose.py: ° of the motion": "the same",
    "machine/servo/live/rows.py": "changes many times a second: as many decimals and one unit throughout",
    "model/rendering/velocity.py: unit": "(m/s²)/√Hz is a unit that is not read",
    "passivity/stability/shaking_hand.py: unit": "hours and minutes",
    "show/explorer/arms.py: unit": "what is typed into a field",
    "show/explorer/controls.py: unit": "the same",
    "show/explorer/state.py: unit": "the same",
}
"""Where `shown` is not asked, and why: a file, or one and what stands behind the number there."""


def by_themselves(text: str) -> Iterator[str]:
    """What stands behind a number in an f-string and begins like a unit; a number quoted as given, !r, aside.

    Of `{x:.4g} {unit}` the name.
    """
    for node in ast.walk(ast.parse(text)):
        parts = [*node.values, None] if isinstance(node, ast.JoinedStr) else []
        for number, after, unit in zip(parts, parts[1:], [*parts[2:], None], strict=False):
            if not isinstance(number, ast.FormattedValue) or not isinstance(after, ast.Constant):
                continue
            if A_UNIT.match(str(after.value)) and number.conversion == -1:
                yield str(after.value)
            spec = ast.unparse(number.format_spec)[2:-1] if number.format_spec else ""
            name = ast.unparse(unit) if isinstance(unit, ast.FormattedValue) else ""
            if after.value == " " and A_NUMBER.fullmatch(spec) and A_NAME.search(name):
                yield ast.unparse(unit.value)


def test_no_text_writes_a_unit_by_itself():
    """Each f-string of the source has its numbers with units from `shown`, or a reason here."""
    found = [
        f"{path.relative_to(SOURCE).as_posix()}: {after}"
        for path in sorted(SOURCE.rglob("*.py"))
        for after in by_themselves(path.read_text(encoding="utf-8"))
    ]
    new = [one for one in found if not one.startswith(tuple(BY_THEMSELVES))]
    assert not new, f"these are written by zwidth.quantity.text.shown: {new}"
    over = [one for one in BY_THEMSELVES if not any(each.startswith(one) for each in found)]
    assert not over, f"nothing there needs its reason any more: {over}"


def test_a_unit_that_is_written_by_itself_is_found():
    written = 'f"{x:.3g} ms late"; f"{x} N·m"; f"{100 * y:.0f} % of it"; f"{x:g} {unit}"'
    assert sorted(by_themselves(written)) == [" % of it", " N·m", " ms late", "unit"]
    assert not [*by_themselves('f"{n} samples, {x!r} s, {a} made, {shown(x, unit)}; {x:.3g} times"')]


def spoken_in_degrees(unit):
    with answers_in("deg"):
        return spoken(unit)[1]


def test_units_and_keys_in_words():
    assert unit_text("kg*m^2") == "kg·m²"
    assert quantity_unit("damping") == "N·s/m"
    assert quantity_unit("stiffness", "rotary") == "N·m/rad"
    assert in_words("coulomb_friction") == "Coulomb friction"


def test_a_range_as_it_is_said():
    assert from_to(-0.05, 0.05, "m") == "-50 to 50 mm"


def test_a_number_in_a_table():
    numbers = (1234567.0, 12345.6, 999.96, 0.00012345)
    assert [in_a_table(number) for number in numbers] == ["1.235e+06", "12346", "1000", "0.0001234"]
    assert in_a_table(0.98765, 3) == "0.988"


def test_a_limit_is_rounded_to_the_side_on_which_it_holds():
    assert shown_at_most(416.96, "N/m") == "416.9 N/m"
    assert shown_at_least(416.92, "N/m") == "417 N/m"
    assert shown_at_least(7.12345612e-05, "N*m*s/rad", 6) == "71.2346 µN·m·s/rad"
    with answers_in("deg"):
        assert shown_at_most(1.0, "N*m/rad") == "0.01745 N·m/deg"
        assert shown_at_least(1.0, "N*m/rad") == "0.01746 N·m/deg"


ROTARY = ("rad", "rad/s", "N*m/rad", "N·m·s/rad", "s/rad", "N*m*s/rad/J", "N*m/rad^1.5")


def test_nobody_asked():
    assert all(spoken(unit) == (1.0, unit) for unit in ROTARY)
    with answers_as_typed():
        parse_number("0.3 N*m/rad", "N*m/rad", "stiffness")
        assert all(spoken(unit) == (1.0, unit) for unit in ROTARY)


def test_the_stiffness_says_in_which_angle():
    """Whatever the encoder was typed in; where it was typed in none, the others say."""
    for typed, told_in in (("15 N*m/rad", "rad"), ("0.3 N*m/deg", "deg"), ("15", "turn")):
        with answers_as_typed():
            parse_number("0.001 turn", "rad", "resolution")
            parse_number(typed, "N*m/rad", "stiffness")
            assert spoken("N*m/rad")[1] == f"N*m/{told_in}"


def test_whoever_types_degrees():
    """Every angle of the answer is in degrees once one was typed so, above and below the bar."""
    with answers_as_typed():
        value = parse_number("0.4 N*m/deg", "N*m/rad", "stiffness")
        assert told_quantity(value, "stiffness", "rotary") == "0.4 N·m/deg"
        assert shown(parse_number("7", "rad", "position"), "rad", 6) == f"{7 * 180 / pi:.6g} deg"
        assert shown(0.0002, "N*m*s/rad") == "3.491 µN·m·s/deg"
        assert shown(pi, "rad/s", 6) == "180 deg/s"
        assert shown(pi / 1800, "rad") == "0.1 deg"
        assert shown(2.0, "N*m/rad^1.5", 6) == f"{2e3 * (pi / 180) ** 1.5:.6g} mN·m/deg^1.5"
        assert shown(Interval(pi / 180, pi / 18), "rad", 6) == "1 … 10 deg"
        assert shown(3.0, "N*m") == "3 N·m"
    assert shown(pi, "rad") == "3.142 rad"


def test_an_interval_of_degrees():
    with answers_as_typed():
        parse("5 .. 10 °", "rad", "position")
        assert spoken("rad") == (180 / pi, "deg")


def test_what_was_refused_was_not_typed():
    with answers_as_typed():
        with pytest.raises(InputError, match="damping is in"):
            parse_number("3 deg", "N*m*s/rad", "damping")
        assert spoken("rad") == (1.0, "rad")


def test_turns_and_rpm():
    with answers_in("rpm"):
        assert shown(pi, "rad/s", 6) == "30 rpm"
        assert shown(pi, "rad", 6) == f"{pi:.6g} rad"
    with answers_in("turn"):
        assert shown(pi, "N*m*s/rad", 6) == f"{2 * pi**2:.6g} N·m·s/turn"
    with answers_as_typed():
        parse_number("120 rpm", "rad/s", "speed")
        parse_number("3 deg/s", "rad/s", "speed")
        assert (spoken("rad/s")[1], spoken("rad")[1]) == ("rpm", "deg")


def test_an_unknown_angle():
    with pytest.raises(InputError, match="rad, deg or turn"), answers_in("gon"):
        pass


def test_counts_are_no_turns():
    """65 536 counts per turn is no answer in turns."""
    with answers_as_typed():
        parse_number("65536 counts/turn", "1", "counts_per_turn")
        assert spoken("rad") == (1.0, "rad")
