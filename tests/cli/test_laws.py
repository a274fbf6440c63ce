"""Laws in a chain in a specification and on the command line."""

import inspect
import json
import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from strategies import toml_values

import zwidth as zw
from zwidth.model import rendering
from zwidth.model.rendering import ESTIMATORS, LAWS
from zwidth.model.specification.laws import build_law, with_laws
from zwidth.model.specification.read import TABLES, read_tables
from zwidth.model.specification.table import Table

LOOP = '[device]\ncatalogue = "haptic-paddle"\n\n[environment]\ntype = "wall"\nstiffness = 400\n'
WALL = zw.Wall(400)
TOUCH = "--operator dowel --duration 0.1"


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def read(text, *typed, motion="linear"):
    """The wall behind the laws of a file with these tables, or of the command line."""
    Path("laws.toml").write_text(text, encoding="utf-8")
    return with_laws(WALL, read_tables(["laws.toml"], TABLES).get("law"), typed or None, motion)


@pytest.mark.parametrize(
    ("kinds", "base"), [(LAWS, rendering.RenderingLaw), (ESTIMATORS, rendering.Estimator)]
)
def test_every_law_can_be_named(kinds, base):
    """Under its class's name in small letters, with all of its arguments."""
    public = [getattr(rendering, name) for name in rendering.__all__]
    classes = {c.__name__: c for c in public if inspect.isclass(c) and issubclass(c, base) and c is not base}
    assert {row.class_name for row in kinds.values()} == set(classes)
    for name, row in kinds.items():
        assert name == re.sub(r"(?<!^)([A-Z])", r"-\1", row.class_name).lower()
        signature = inspect.signature(classes[row.class_name]).parameters
        arguments = {k: v for k, v in signature.items() if v.kind is not v.VAR_KEYWORD}
        if len(arguments) < len(signature):  # those of a model are its base's
            arguments |= inspect.signature(rendering.HalfSamplePrediction).parameters
        assert set(row.keys) == set(arguments)
        required = {k for k, v in arguments.items() if v.default is v.empty}
        assert {k for k, v in row.keys.items() if v.required} == required


def test_laws_are_read_with_their_units_and_in_their_order():
    text = (
        '[[law]]\ntype = "crossing-correction"\nthroughout = true\nfinger_mass = "20 g"\n'
        'finger_position = "4 mm"\n'
        '[[law]]\ntype = "damper"\ndamping = "0.2 N*s/m"\nclamped = true\n'
        'velocity = { type = "adaptive-window", longest = 20, noise = "22.4 um", fit = "best" }\n'
        '[[law]]\ntype = "hysteresis"\nfastest = "20 cm/s"\nstiffness = "0.3 N/mm"\n'
        '[[law]]\ntype = "passivity-controller"\nobserver = "published"\nlargest_damping = "800 mN*s/m"\n'
        'slowest = "1 mm/s"\ncredit = true\nceiling = "5 uJ"\n'
        '[[law]]\ntype = "event-transient"\nfrequency = "0.15 kHz"\nvelocity = "tick-time"\n'
        '[[law]]\ntype = "event-transient"\nkind = "acceleration"\nrecord = [10, 5]\n'
        '[[law]]\ntype = "braking-pulse"\n[law.velocity]\ntype = "kalman"\nacceleration = 30\n'
        '[[law]]\ntype = "slew-limit"\nrate = "3 kN/s"\n'
        '[[law]]\ntype = "dither"\nkind = "random"\nseed = 7\namplitude = "1 mN"\n'
    )
    assert read(text) == zw.render(
        WALL,
        rendering.CrossingCorrection(throughout=True, finger_mass="0.02", finger_position="0.004"),
        rendering.Damper("0.2", rendering.AdaptiveWindow("22.4e-6", 20, "best"), clamped=True),
        rendering.Hysteresis(fastest="0.2", stiffness=300),
        rendering.PassivityController(
            observer="published", largest_damping="0.8", slowest="0.001", credit=True, ceiling="5e-6"
        ),
        rendering.EventTransient(frequency=150, velocity=rendering.TickTime()),
        rendering.EventTransient("acceleration", record=[10, 5]),
        rendering.BrakingPulse(velocity=rendering.Kalman(30)),
        rendering.SlewLimit(3000),
        rendering.Dither("0.001", "random", 7),
    )


def test_laws_of_a_rotary_device_have_its_units():
    """N·m for N, and a linear unit is refused."""
    saturated = '[[law]]\ntype = "saturation"\nlimit = "20 mN*m"\n'
    law = read(saturated, motion="rotary")
    assert law == zw.render(WALL, rendering.Saturation("0.02"))
    with pytest.raises(zw.InputError, match=r"limit is in N; got"):
        read(saturated)


def test_laws_of_the_command_line_have_their_defaults_and_replace_those_of_a_file():
    text = '[[law]]\ntype = "saturation"\n'
    two = zw.render(WALL, rendering.Extrapolation(), rendering.PassivityController())
    assert read(text, "extrapolation, passivity-controller") == two
    assert read(text, "extrapolation", "passivity-controller") == two
    assert read(text) == zw.render(WALL, rendering.Saturation())
    assert with_laws(WALL, None, None, "linear") is WALL


def test_simulate_takes_laws(run):
    Path("loop.toml").write_text(LOOP + '[[law]]\ntype = "hysteresis"\nfastest = 0.2\n', encoding="utf-8")
    assert "with hysteresis of the width for 0.2 m/s" in run(f"simulate loop.toml {TOUCH} -o file.nc").out
    run(f"simulate loop.toml --law extrapolation {TOUCH} -o typed.nc")
    paddle, dowel = zw.catalogue.device("haptic-paddle"), zw.operators.Dowel()
    laws = {"file": rendering.Hysteresis(fastest="0.2"), "typed": rendering.Extrapolation()}
    for name, law in laws.items():
        again = zw.simulate(paddle, zw.render(WALL, law), dowel, 0.1)
        assert zw.traces.load_trace(f"{name}.nc").identical(again)


def test_compare_puts_the_row_on_the_bench(run):
    """Under the name "yours", beside the laws that were named."""
    laws = '[[law]]\ntype = "extrapolation"\n[[law]]\ntype = "passivity-controller"\n'
    Path("loop.toml").write_text(LOOP + laws, encoding="utf-8")
    scores = run("compare loop.toml --laws wall --json").json["laws"]
    assert list(scores) == ["wall", "yours"]
    own = zw.render(WALL, rendering.Extrapolation(), rendering.PassivityController())
    again = zw.compare(zw.catalogue.device("haptic-paddle"), WALL, {"yours": own}).scores
    assert scores["yours"]["generated_energy_J"] == float(again["generated_energy"][0])


def test_laws_are_compared_in_a_table_and_in_files(run):
    wall = "compare haptic-paddle --stiffness 400 --laws"
    assert "virtual-damping" in run(f"{wall} 'wall, virtual-damping' --plot a.png -o a.json").out
    saved = json.loads(Path("a.json").read_text(encoding="utf-8"))["laws"]
    assert list(saved) == ["wall", "virtual-damping"]
    assert saved["wall"]["static_stiffness_N_per_m"] == pytest.approx(400, rel=0.05)
    told = run(f"{wall} passivity-controller-published --fastest '1 m/s' --json").json["laws"]
    assert told["passivity-controller-published"]["status"] == "undecided"


def test_limit_plays_the_game_against_laws_in_a_row(run):
    """From a file or from the option, the bracket of Python; its evidence is verified."""
    Path("loop.toml").write_text(LOOP + '[[law]]\ntype = "saturation"\n', encoding="utf-8")
    bounds = "--penetration '0.2 mm' --speed '0.1 m/s'"
    found = run(f"limit loop.toml {bounds} --json -o limit.json").json
    law = zw.render(WALL, rendering.Saturation())
    again = zw.limit(zw.catalogue.device("haptic-paddle"), law, penetration="0.0002", speed="0.1")
    assert found["proved_passive_N_per_m"] == again.proved_passive
    assert found["proved_active_N_per_m"] == again.proved_active
    typed = run(f"limit haptic-paddle --stiffness 400 --law saturation {bounds}").out
    assert "with saturation at the force limit" in typed
    run("verify limit.json").says("No hand within these bounds takes energy out", "row storage", "row motion")


def test_check_decides_laws_in_a_row(run):
    Path("loop.toml").write_text(LOOP + '[[law]]\ntype = "force-bounding"\n', encoding="utf-8")
    assert "force bounding, the last law in the row" in run("check loop.toml --all").words
    run("check haptic-paddle --stiffness 770 --law force-bounding")


BAD = [
    ("[law]\n", "laws are tables in a row, each with [[law]] above its keys"),
    ("law = 3\n", "laws are tables in a row"),
    ("[[law]]\n", "[[law]]: type is missing; choose from: extrapolation"),
    ("[[law]]\ntype = 3\n", "type is a text in quotes"),
    ('[[law]]\ntype = "dampr"\n', 'there is no law "dampr"; did you mean "damper"?'),
    ('[[law]]\ntype = "damper"\n', 'the law "damper" needs damping [N*s/m]'),
    ('[[law]]\ntype = "damper"\ndampin = 1\n', 'a law of type "damper" has no "dampin"; did you'),
    ('[[law]]\ntype = "damper"\ndamping = -1\n', "damping must be ≥ 0, got -1"),
    ('[[law]]\ntype = "damper"\ndamping = "1 N"\n', 'damping is in N*s/m; got "1 N"'),
    ('[[law]]\ntype = "damper"\ndamping = [1, 2]\n', "damping is in N*s/m; got a list"),
    ('[[law]]\ntype = "damper"\ndamping = 1\nclamped = 1\n', "clamped is true or false"),
    ('[[law]]\ntype = "damper"\ndamping = 1\nvelocity = 1\n', "velocity is { type = "),
    ('[[law]]\ntype = "damper"\ndamping = 1\nvelocity = "kalmann"\n', 'did you mean "kalman"?'),
    ('[[law]]\ntype = "damper"\ndamping = 1\nvelocity = {}\n', "velocity: type is missing"),
    ('[[law]]\ntype = "damper"\ndamping = 1\nvelocity = {type = "kalman", q = 1}\n', '"kalman" has no "q"'),
    (
        '[[law]]\ntype = "damper"\ndamping = 1\nvelocity = {type = "adaptive-window", longest = 2.5}\n',
        "[[law]]: velocity: longest is a whole number",
    ),
    ('[[law]]\ntype = "hysteresis"\n', "give either force [N] or fastest [m/s], got neither"),
    ('[[law]]\ntype = "passivity-controller"\nobserver = "publishd"\n', 'did you mean "published"?'),
    ('[[law]]\ntype = "passivity-controller"\nobserver = 1\n', 'such as observer = "sampled"'),
    ('[[law]]\ntype = "passivity-controller"\nlargest_damping = "no"\n', "largest_damping"),
    ('[[law]]\ntype = "windowed-controller"\nlargest_damping = "unlimited"\n', "largest_damping"),
    ('[[law]]\ntype = "windowed-controller"\nwindow = 0\n', "window is a whole number"),
    ('[[law]]\ntype = "rate-term"\ntime_constant = "1 N"\n', "time_constant"),
    ('[[law]]\ntype = "event-transient"\nrecord = 3\n', "record is a list of numbers"),
    ('[[law]]\ntype = "event-transient"\nrecord = [1, "2 N"]\n', "record[1] is in 1/s"),
    ('[[law]]\ntype = "saturation"\n' * 17, "[[law]] 17: more than 16 laws in a chain"),
    ('[[law]]\ntype = "saturation"\n[[law]]\ntype = "x"\n', '[[law]] 2: there is no law "x"'),
]  # fmt: skip


@pytest.mark.parametrize(("text", "said"), BAD, ids=[said for _, said in BAD])
def test_a_slip_is_one_clear_message(text, said):
    with pytest.raises(zw.InputError) as caught:
        read(text)
    message = str(caught.value)
    assert "laws.toml" in message
    assert said in message
    assert message.isprintable()


SIMULATE = f"simulate haptic-paddle --stiffness 400 {TOUCH} --law"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (f"{SIMULATE} dampr", 'zwidth: command line: --law: there is no law "dampr"; did you mean "damper"?'),
        (f"{SIMULATE} saturation,,", 'zwidth: command line: --law: there is no law ""'),
        (f"{SIMULATE} damper", 'the law "damper" needs damping [N*s/m], in a [[law]] table of a file'),
        ("compare haptic-paddle --stiffness 400 --laws wall --law damer", 'did you mean "damper"?'),
        (
            "map device.toml --stiffness 0:100 --virtual-damping 0:1",
            "laws in a chain have no place in this command: zwidth check decides them",
        ),
    ],
)
def test_a_slip_on_the_command_line(refused, line, said):
    Path("device.toml").write_text('[device]\ncatalogue = "haptic-paddle"\n[[law]]\ntype = "held"\n', "utf-8")
    assert said in refused(line)


VALUES = toml_values() | st.sampled_from(
    [1, "1 ms", "2 N", [1, 2], True, "kalman", {"type": "adaptive-window"}]
)


def described(table, motion):
    """The law that a table makes, or the message why it makes none."""
    try:
        return build_law(table, motion).describe(motion)
    except zw.InputError as error:
        return str(error)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.sampled_from(sorted(LAWS)), st.data(), st.sampled_from(["linear", "rotary"]))
def test_any_values_make_a_law_or_one_line(name, data, motion):
    """Whatever stands in a file: no other exception, and a message that can be printed."""
    keys = st.sampled_from([*LAWS[name].keys, "damping"])
    values = data.draw(st.dictionaries(keys, VALUES, max_size=4))
    text = described(Table("[[law]]", {"type": name, **values}), motion)
    assert text.isprintable()
    assert len(text) < 900
