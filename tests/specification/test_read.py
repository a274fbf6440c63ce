"""Specifications are read exactly, and every slip is one clear message."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from strategies import texts, toml_values

import zwidth as zw
from zwidth.model.kind import Kind
from zwidth.model.specification.environments import TYPES, build_environment, option_keys
from zwidth.model.specification.read import DEVICE_KEYS, LARGEST_FILE, Specification, build_device, load
from zwidth.model.specification.table import Table

DEVICE = '[device]\ndamping = "0.15 N*s/m"\nrate = "3 kHz"\n'
WALL = '[environment]\ntype = "wall"\nstiffness = 300\n'

Load = Callable[..., Specification]


@pytest.fixture
def read(tmp_path: Path) -> Load:
    """Writes each content to a file of its own and loads them all."""

    def loader(*contents: str | bytes, **overrides: str) -> Specification:
        paths = [tmp_path / f"file{i}.toml" for i in range(len(contents))]
        for path, content in zip(paths, contents, strict=True):
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return load(paths, overrides)

    return loader


def message(call: Callable[[], object]) -> str:
    with pytest.raises(zw.InputError) as caught:
        call()
    text = str(caught.value)
    assert text.isprintable()
    assert len(text) < 700
    return text


def outcome(call: Callable[[], object]) -> str:
    try:
        call()
    except zw.InputError as error:
        return str(error)
    return ""


def test_numbers_are_exact(read):
    device, wall = (s := read(DEVICE + "resolution = 22.4e-6\n" + WALL)).device, s.environment
    assert device.exact("sample_period") == Fraction(1, 3000)
    assert device.exact("resolution") == Fraction(224, 10**7)
    assert device.name == "file0"
    assert device.assumed == ("coulomb_friction", "delay")
    assert wall == zw.Wall(300)


def test_one_file_or_two_or_a_catalogue_name(read):
    both = read(DEVICE + WALL)
    assert read(WALL, DEVICE.replace("[device]", '[device]\nname = "file0"')) == both
    paddle = load(["haptic-paddle"], {"stiffness": "0.3 N/mm"})
    assert paddle == Specification(zw.catalogue.device("haptic-paddle"), zw.Wall(300))


def test_the_command_line_alone():
    s = load([], {"damping": "0.15", "sample-period": "1 ms", "stiffness": "300", "virtual-damping": "-0.1"})
    assert s == Specification(zw.Device(damping=0.15, rate=1000), zw.Wall(300, -0.1))


def test_overrides_replace_the_file(read):
    text = (
        "[device]\ndamping = 1\nsample_period = 0.001\n"
        '[environment]\ntype = "wall"\nstiffness = 1\ndamping = 2\n'
    )
    s = read(text, rate="2 kHz", damping="0.5", stiffness="7", virtual_damping="0.25", delay="0.3 ms")
    assert s.device.exact("sample_period") == Fraction(1, 2000)
    assert s.device.exact("damping") == Fraction(1, 2)
    assert s.device.exact("delay") == Fraction(3, 10000)
    assert s.environment == zw.Wall(7, 0.25)
    alias = read(text.replace("damping = 2", "virtual_damping = 2"))
    assert alias.environment == zw.Wall(1, 2)


def test_a_catalogue_device_as_a_base(read):
    device = read('[device]\ncatalogue = "haptic-paddle"\nrate = "5 kHz"\n' + WALL).device
    assert device == zw.catalogue.device("haptic-paddle", rate=5000)
    assert set(read('[device]\ncatalogue = "touch"\ndelay = 0\n' + WALL).ranges) == {
        "damping",
        "coulomb_friction",
        "resolution",
    }
    named = read('[device]\ncatalogue = "phantom"\nname = "ours"\n' + WALL).device
    assert named.name == "ours"


def test_intervals(read):
    s = read(DEVICE + 'mass = ["10 g", 0.02]\n' + WALL, resolution="10 .. 20 um", stiffness="100..200")
    assert s.device.mass == zw.Interval(0.01, 0.02)
    assert s.device.resolution == zw.Interval("1e-5", "2e-5")
    assert s.environment == zw.Wall((100, 200))


def test_rotary_devices(read):
    wheel = '[device]\ninertia = "100 g*cm^2"\ndamping = "1e-3 N*m*s"\nrate = 1000\ncounts_per_turn = 4096\n'
    s = read(wheel, '[environment]\ntype = "wall"\nstiffness = "2 N*m/rad"\n')
    assert s.device == zw.rotary(inertia=1e-5, damping=1e-3, rate=1000, counts_per_turn=4096, name="file0")
    assert s.device.motion == "rotary"
    assert s.environment == zw.Wall(2)
    handle = read(wheel + 'handle_radius = "5 cm"\n', '[environment]\ntype = "wall"\nstiffness = "2 N/m"\n')
    assert handle.device.motion == "linear"
    assert handle.device.exact("damping") == Fraction(1, 1000) / Fraction(5, 100) ** 2
    assert read(wheel + WALL, resolution="1 mrad").device.exact("resolution") == Fraction(1, 1000)
    assert "a rotary stiffness" in message(
        lambda: read(DEVICE, '[environment]\ntype = "wall"\nstiffness = "2 N*m/rad"\n')
    )


SLS = 'type = "standard-linear-solid"\nstiffness = 10\nbranch_stiffness = "1 N/mm"\nbranch_damping = 3\n'
ENVIRONMENTS: list[tuple[str, Callable[[], Any]]] = [
    ('type = "wall"\nstiffness = 1\ndamping = 2\n', lambda: zw.Wall(1, 2)),
    ('type = "wall"\nstiffness = 1\ndamping = 2\nclamped = true\n', lambda: zw.Wall(1, 2, clamped=True)),
    ('type = "maxwell"\nstiffness = 1\ndamping = 2\nclamped = false\n', lambda: zw.Maxwell(1, 2)),
    (SLS, lambda: zw.StandardLinearSolid(10, 1000, 3)),
    (SLS + 'clamped = "true"\n', lambda: zw.StandardLinearSolid(10, 1000, 3, clamped=True)),
    (SLS + 'discretization = "tustin"\n', lambda: zw.StandardLinearSolid(10, 1000, 3, "tustin")),
    (
        'type = "generalized-maxwell"\nstiffness = 1\nbranches = [[800, 3], ["1 N/mm", [1, 2]]]\n',
        lambda: zw.GeneralizedMaxwell(1, [(800, 3), (1000, zw.Interval(1, 2))]),
    ),
    (
        'type = "transfer-function"\nnumerator = [3, 0.1]\ndenominator = [1, 2]\ndiscretization = "zoh"\n',
        lambda: zw.ContinuousTransferFunction([3, 0.1], [1, 2], "zoh"),
    ),
    (
        'type = "pulse-transfer-function"\nsample_period = "1 ms"\n'
        'numerator = [0.1]\ndenominator = [1, "-0.5"]\n',
        lambda: zw.PulseTransferFunction([0.1], [1, -0.5], sample_period=0.001),
    ),
    (
        'type = "nonlinear-spring"\npositions = [0, "1 mm", 0.002]\nforces = [-0.1, "200 mN", 3]\n',
        lambda: zw.NonlinearSpring([0, 0.001, 0.002], [-0.1, 0.2, 3]),
    ),
    (
        'type = "hunt-crossley"\nstiffness = 2e4\nexponent = 2\ndissipation = "3 s/m"\nclamped = false\n',
        lambda: zw.HuntCrossley(20000, 2, 3, clamped=False),
    ),
    (
        'type = "virtual-coupling"\nstiffness = 1\ndamping = 2\n'
        'environment = { type = "wall", stiffness = 9 }\n',
        lambda: zw.VirtualCoupling(1, 2, zw.Wall(9)),
    ),
    (
        'type = "scene"\nport = "tip"\n[[environment.elements]]\ntype = "spring"\nfirst = "tip"\n'
        'second = "body"\nstiffness = "3 N/mm"\nname = "shaft"\n[[environment.elements]]\ntype = "mass"\n'
        'node = "body"\nmass = "20 g"',
        lambda: zw.Scene(
            [zw.scene.Spring("tip", "body", 3000, name="shaft"), zw.scene.Mass("body", "0.02")], port="tip"
        ),
    ),
]


@pytest.mark.parametrize(("text", "expected"), ENVIRONMENTS)
def test_every_type_of_environment(read, text, expected):
    assert read(DEVICE, "[environment]\n" + text).environment == expected()


def needed(kind: Kind) -> dict[str, str]:
    """A number with its unit for each key that has no default; what is more than numbers needs an example."""
    keys = {key: own for key, own in kind.keys.items() if own.required}
    assert all(own.is_number for own in keys.values()), f"give an example of {kind.class_name}"
    return {
        key: f"{value} {own.unit_for('linear')}".removesuffix(" 1")
        for value, (key, own) in enumerate(keys.items(), start=2)
    }


WITH_A_ROW = {text.split('"')[1] for text, _ in ENVIRONMENTS}


@pytest.mark.parametrize("name", ["wall", *sorted(set(TYPES) - WITH_A_ROW)])
def test_every_other_type(read, name):
    given = needed(TYPES[name])
    table = "".join(f'{key} = "{value}"\n' for key, value in given.items())
    found = read(DEVICE, f'[environment]\ntype = "{name}"\n{table}').environment
    assert found == TYPES[name].made(**given)


FILTERS: list[tuple[str, str, Any]] = [
    ('{ type = "backward-difference" }', "backward-difference", zw.rendering.BackwardDifference()),
    ('{ type = "window", samples = 5 }', "window 5", zw.rendering.Window(5)),
    ('{ type = "one-pole", time_constant = "2 ms" }', "one-pole 2 ms", zw.rendering.OnePole(0.002)),
    (
        '{ type = "one-pole", cutoff = "50 Hz" }',
        "one-pole 50 Hz",
        zw.rendering.OnePole(1 / (2 * math.pi * 50)),
    ),
    (
        '{ type = "filter", numerator = [0.2], denominator = [1, -0.8] }',
        "filter 0.2 / 1, -0.8",
        zw.rendering.VelocityFilter([0.2], [1, -0.8]),
    ),
]


@pytest.mark.parametrize(("table", "text", "expected"), FILTERS)
def test_velocity_filters(read, table, text, expected):
    wall = zw.Wall(300, 0.1, expected)
    assert read(DEVICE + WALL + f"damping = 0.1\nvelocity_filter = {table}\n").environment == wall
    assert read(DEVICE + WALL, virtual_damping="0.1", velocity_filter=text).environment == wall


def test_a_clamped_law_on_the_command_line():
    given = {"stiffness": "300", "virtual-damping": "0.1"}
    assert load(["phantom"], {**given, "clamped": "true"}).environment == zw.Wall(300, 0.1, clamped=True)
    assert load(["phantom"], {**given, "clamped": "false"}).environment == zw.Wall(300, 0.1)
    assert "clamped is true or false" in message(lambda: load(["phantom"], {**given, "clamped": "TRUE"}))


def test_lists_on_the_command_line(read):
    s = load(["phantom"], {"type": "pulse-transfer-function", "numerator": "0.1", "denominator": "[1, -0.5]"})
    assert s.environment == zw.PulseTransferFunction([0.1], [1, -0.5])
    points = {"positions": "-1 mm, 0, 2 mm", "forces": "[-1, 0, 0.5 N]"}
    s = load(["phantom"], {"type": "nonlinear-spring", **points})
    assert s.environment == zw.NonlinearSpring([-0.001, 0, 0.002], [-1, 0, 0.5])
    with pytest.raises(zw.InputError, match='positions: 10 has no unit; write "10 mm", or "10 m"'):
        load(["phantom"], {"type": "nonlinear-spring", "positions": "0, 10, 20 mm", "forces": "0, 1, 2"})
    ratio = {"type": "nonlinear-spring", "positions": "0, 1/3, 2", "forces": "0, 1, 2"}
    assert load(["phantom"], ratio).environment == zw.NonlinearSpring([0, Fraction(1, 3), 2], [0, 1, 2])
    contact = {"type": "hunt-crossley", "stiffness": "2e4", "dissipation": "3 s/m"}
    assert load(["phantom"], contact).environment == zw.HuntCrossley(20000, "1.5", 3)
    s = load(["phantom"], {"type": "generalized-maxwell", "stiffness": "1", "branches": "800:3, 1 N/mm : 20"})
    assert s.environment == zw.GeneralizedMaxwell(1, [(800, 3), (1000, 20)])
    coupling = '[environment]\ntype = "virtual-coupling"\nstiffness = 1\ndamping = 2\n'
    inner = '[environment.environment]\ntype = "wall"\nstiffness = 9\ndamping = 1\n'
    changed = read(
        DEVICE,
        coupling + inner,
        **{"stiffness": "5", "environment.stiffness": "8", "environment.virtual_damping": "0"},
    )
    assert changed.environment == zw.VirtualCoupling(5, 2, zw.Wall(8))


SPRING = '[environment]\ntype = "nonlinear-spring"\n'


def bad(device: str, environment: str = WALL) -> str:
    return f"[device]\n{device}\n{environment}"


CONTACT = '[environment]\ntype = "hunt-crossley"\n'

BAD: list[tuple[str | bytes, str]] = [
    (bad("dampng = 1\nrate = 1"), 'file0.toml: [device]: a device has no "dampng"; did you mean "damping"?'),
    (bad("friction = 1\nrate = 1"), 'did you mean "damping" or "coulomb_friction"?'),
    (bad("damping = 1\nmax_torque = 1\nrate = 1"), 'did you mean "force_limit"?'),
    (DEVICE + '[environment]\ntype = "wall"\nkp = 1', 'has no "kp"; did you mean "stiffness"?'),
    (DEVICE + WALL + "kd = 1", 'did you mean "virtual_damping"?'),
    (bad("damping = 1"), "rate"),
    (DEVICE + CONTACT + "exponent = 2\n", 'type "hunt-crossley" needs stiffness'),
    (DEVICE + CONTACT + 'stiffness = "300 N/m"\n', 'stiffness is a plain number; got "300 N/m"'),
    (DEVICE + CONTACT + "stiffness = [1, 2]\n", "stiffness is a plain number"),
    (DEVICE + CONTACT + 'stiffness = 1\ndissipation = "3 m/s"\n', "dissipation is in s/m"),
    (bad("rate = 1"), "damping"),
    (bad("damping = -1\nrate = 1"), "damping must be ≥ 0 N*s/m, got -1"),
    (bad("damping = 1\nrate = 1\ncoulomb_friction = -1e-9"), "coulomb_friction must be ≥ 0"),
    (bad("damping = nan\nrate = 1"), "finite"),
    (bad("damping = 1\nrate = 1e999"), "magnitudes"),
    (bad("damping = 1\nrate = 1e99999999999999999999999"), "file0.toml: a number"),
    (bad("damping = 1\nrate = 0x" + "f" * 9000), "digits"),
    (bad("damping = 1\nrate = " + "9" * 9000), "file0.toml: a number"),
    (bad("damping = true\nrate = 1"), "true or false"),
    (bad("damping = 2020-01-01\nrate = 1"), "a value of type date"),
    (bad("damping = {a = 1}\nrate = 1"), "a table"),
    (bad('damping = "5 kHz"\nrate = 1'), 'damping is in N*s/m; got "5 kHz", a frequency (1/s)'),
    (bad("damping = 1\nrate = 1\nsample_period = 1"), "both"),
    (bad('damping = 1\nrate = "60 rad/s"'), "an angular speed"),
    (bad("damping = 1\nrate = 1\nname = 3"), "name is a text"),
    (bad('damping = 1\nrate = 1\nmotion = "up"'), "motion"),
    (bad("mass = 1\ninertia = 1\ndamping = 1\nrate = 1"), "not a mass"),
    (bad('motion = "linear"\ninertia = 1\ndamping = 1\nrate = 1'), "belongs to a rotary device"),
    (bad('catalogue = "phantom"\ninertia = 1'), "drop inertia"),
    (bad('catalogue = "phantm"'), 'did you mean "phantom"'),
    (bad("catalogue = 1"), "catalogue is a text"),
    (DEVICE + "[environment]\nstiffness = 1", "type is missing; choose from: wall"),
    (DEVICE + "[environment]\ntype = 1", "type is a text"),
    (DEVICE + '[environment]\ntype = "wal"\nstiffness = 1', 'did you mean "wall"'),
    (DEVICE + '[environment]\ntype = "wall"', "needs stiffness [N/m]"),
    (DEVICE + WALL + "stifness = 1", '[environment]: an environment of type "wall" has no "stifness"'),
    (DEVICE + WALL + "branch_damping = 1", 'of type "wall" has no "branch_damping"'),
    (DEVICE + WALL + "damping = 1\nvirtual_damping = 1", "same quantity"),
    (DEVICE + WALL.replace("300", "-300"), "stiffness must be ≥ 0"),
    (
        DEVICE + WALL + "clamped = 1",
        "file0.toml: [environment]: clamped is true or false; got a value of type",
    ),
    (DEVICE + SPRING + "positions = [0, 1]", "needs forces [N]"),
    (DEVICE + SPRING + 'positions = "0, 1 mm"\nforces = "0, 0,4 N"', '"0,4" may be one number or two'),
    (DEVICE + SPRING + 'positions = [0, 1]\nforces = "0, 3.1 g"', "its weight is in gf"),
    (DEVICE + SPRING + "positions = 1\nforces = [0, 1]", "positions is a list of numbers"),
    (DEVICE + SPRING + 'positions = [0, "1 N"]\nforces = [0, 1]', "positions[1] is in m"),
    (DEVICE + SPRING + "positions = [0, nan]\nforces = [0, 1]", "finite"),
    (DEVICE + WALL + 'clamped = "yes"', 'clamped is true or false; got "yes"'),
    (DEVICE + WALL + "velocity_filter = 5", "velocity_filter is"),
    (DEVICE + WALL + 'velocity_filter = "windw 5"', 'did you mean "window"'),
    (DEVICE + WALL + "velocity_filter = {}", "velocity_filter"),
    (DEVICE + WALL + 'velocity_filter = {type = "window"}', "needs samples"),
    (DEVICE + WALL + 'velocity_filter = {type = "window", samples = 2.5}', "whole number"),
    (DEVICE + WALL + 'velocity_filter = {type = "window", samples = 5, foo = 1}', 'has no "foo"'),
    (DEVICE + WALL + 'velocity_filter = {type = "window", samples = [1, 2]}', "a list"),
    (DEVICE + WALL + 'velocity_filter = {type = "one-pole"}', "needs time_constant or cutoff"),
    (DEVICE + WALL + 'velocity_filter = {type = "one-pole", cutoff = 0}', "cutoff must be > 0"),
    (DEVICE + WALL + 'velocity_filter = {type = "one-pole", cutoff = "2 ms"}', "a time (s)"),
    (DEVICE + WALL + 'velocity_filter = {type = "filter", numerator = 1, denominator = [1]}', "is a list"),
    (DEVICE + "[environment]\n" + SLS + 'discretization = "euler"', "discretization"),
    (DEVICE + '[environment]\ntype = "generalized-maxwell"\nstiffness = 1\nbranches = [1, 2]', "pairs"),
    (
        DEVICE + '[environment]\ntype = "virtual-coupling"\nstiffness = 1\ndamping = 1\nenvironment = 1',
        "environment is a table",
    ),
    (
        DEVICE
        + '[environment]\ntype = "virtual-coupling"\nstiffness = 1\ndamping = 1\n'
        + '[environment.environment]\ntype = "wall"\nstifness = 1',
        '[environment.environment]: an environment of type "wall" has no "stifness"',
    ),
    (DEVICE + "[enviroment]\n", 'did you mean "environment"'),
    ("device = 1", "device is a table"),
    ("[[device]]\n", "device is a table"),
    ("", "none of the tables [device], [environment]"),
    ("this is not TOML", "not TOML"),
    ("[device\n", "not TOML"),
    ("a = " + "[" * 20000, "nested too deeply"),
    (b"\xff\xfe\x00", "not UTF-8"),
    (b"#" * (LARGEST_FILE + 1), "larger than"),
    (DEVICE, "no environment is given"),
    (WALL, "no device is given"),
]


@pytest.mark.parametrize(("content", "part"), BAD, ids=range(len(BAD)))
def test_slips_in_a_file(read, content, part):
    assert part in message(lambda: read(content))


@pytest.mark.parametrize(
    ("name", "part"),
    [
        ("arm.urdf", "for zwidth workspace"),
        ("controllers.yaml", "for zwidth gains"),
        ("session.csv", "for zwidth identify"),
        ("two-link", "an arm of several joints"),
    ],
)
def test_what_another_command_reads_is_sent_there(tmp_path, name, part):
    path = tmp_path / name
    if path.suffix:
        path.write_text("<robot/>: 1\n", encoding="utf-8")
    assert part in message(lambda: load([path if path.suffix else name], {}))


@pytest.mark.parametrize(
    "text",
    [
        '{"profiles": [{"data": [{"cls": "axis", "instance": 0, "cmd": "idlespring", "value": 127}]}]}',
        '{"flash": [{"addr": "776", "val": "127"}]}',
    ],
)
def test_settings_of_a_wheel_have_no_unit(tmp_path, text):
    """Whatever they are given to."""
    path = tmp_path / "profiles.json"
    path.write_text(text, encoding="utf-8")
    for ask in (lambda: load([path], {}), lambda: zw.read_gains(path)):
        assert "settings of a force-feedback wheel (OpenFFBoard) without units" in message(ask)


@pytest.mark.parametrize(
    ("overrides", "part"),
    [
        ({"stiffness": "5 kHz"}, 'command line: stiffness is in N/m; got "5 kHz", a frequency (1/s)'),
        ({"stiffness": ""}, "empty"),
        ({"stifness": "1"}, 'there is no parameter "stifness"; did you mean "stiffness"?'),
        ({"stiffness": "1", "branch_damping": "1"}, 'of type "wall" has no "branch_damping"'),
        ({"stiffness": "1", "rate": "1", "sample_period": "1"}, "both"),
        ({"stiffness": "1", "coulomb_friction": "-0.1"}, "must be ≥ 0"),
        ({"environment.stiffness": "1"}, "there is none"),
        ({"environment.stifness": "1"}, "there is no parameter"),
        ({"type": "spring"}, "there is no environment of type"),
        ({"type": "detents"}, "zwidth new environment FILE --type detents"),
        ({"virtual_damping": "1"}, "needs --stiffness"),
        ({}, "no environment is given"),
    ],
)
def test_slips_on_the_command_line(overrides, part):
    assert part in message(lambda: load(["haptic-paddle"], overrides))


def test_slips_in_the_sources(tmp_path, read):
    wall = {"stiffness": "1"}
    assert 'did you mean "haptic-paddle"' in message(lambda: load(["haptic-padle"], wall))
    assert "there is no file" in message(lambda: load(["missing.toml"], wall))
    assert "is a directory" in message(lambda: load([tmp_path], wall))
    assert "not a regular file" in message(lambda: load(["/dev/null"], wall))
    assert "\x00" not in message(lambda: load(["a\x00b"], wall))
    assert "cannot be read" in message(lambda: load(["x" * 5000], wall))
    assert "both" in message(lambda: load(["phantom", "phantom"], wall))
    assert "both" in message(lambda: read(DEVICE, DEVICE))
    assert "no device is given" in message(lambda: load([], wall))


def test_command_line_names_are_not_shared():
    assert not set(option_keys()) & set(DEVICE_KEYS)
    for row in TYPES.values():
        for key in row.keys.values():
            assert bool(key.quantity.unit) == (key.is_number or key.form == "list")
            assert key.meaning


KEYS = st.sampled_from([*DEVICE_KEYS, *option_keys(), "type", "environment", "transmission"]) | texts()
VALUES = toml_values() | st.sampled_from([1, Decimal("0.5"), "1 ms", [1, 2], *TYPES])


@settings(max_examples=100, deadline=None)
@given(st.dictionaries(KEYS, VALUES, max_size=6))
def test_any_device_table_is_a_device_or_an_input_error(values):
    assert outcome(lambda: build_device(Table("x", {"damping": 1, "rate": 1000, **values}))).isprintable()


@settings(max_examples=120, deadline=None)
@given(st.sampled_from(sorted(TYPES)), st.dictionaries(KEYS, VALUES, max_size=4), st.data())
def test_any_environment_table_is_one_or_an_input_error(name, values, data):
    own = {key: data.draw(VALUES) for key in TYPES[name].keys}
    assert outcome(lambda: build_environment(Table("x", {"type": name, **own}), "linear")).isprintable()
    assert outcome(lambda: build_environment(Table("x", {"type": name, **values}), "rotary")).isprintable()


@settings(max_examples=100, deadline=None)
@given(st.dictionaries(KEYS, texts(), max_size=5), st.sampled_from([[], ["haptic-paddle"], ["phantom"]]))
def test_any_command_line_is_read_or_an_input_error(overrides, sources):
    assert outcome(lambda: load(sources, overrides)).isprintable()


PIECES = st.sampled_from([
    "[device]\n", "[environment]\n", "damping=", "rate=", "type=", '"wall"', "stiffness=",
    "1", "\n", "[", "]",
])  # fmt: skip


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=200) | st.lists(PIECES | texts(), max_size=12).map(lambda p: "".join(p).encode()))
def test_any_file_is_read_or_an_input_error(tmp_path, content):
    path = tmp_path / "fuzz.toml"
    path.write_bytes(content)
    assert outcome(lambda: load([path], {})).isprintable()


@pytest.mark.parametrize(
    ("stiffness", "motion", "friction"),
    [
        ("0.5 N*m/deg", "rotary", 0.14),
        ("20 N*m/rad", "rotary", 0.14),
        ("300 N/m", "linear", 1.0),
        ("300", "linear", 1.0),
    ],
)
def test_a_question_in_angles_keeps_a_device_about_its_axis(stiffness, motion, friction, tmp_path):
    """The radius says where one looks: at the hand in newtons, about the axis where one asks in angles."""
    file = tmp_path / "wheel.toml"
    friction_row = 'damping = "0.02 N*m*s/rad"\ncoulomb_friction = "0.14 N*m"'
    text = f'[device]\n{friction_row}\nrate = "1 kHz"\nhandle_radius = "14 cm"\n'
    file.write_text(text)
    device = load([file], {"stiffness": stiffness}).device
    assert device.motion == motion
    assert float(device.exact("coulomb_friction")) == pytest.approx(friction)
    file.write_text(f'{text}[environment]\ntype = "wall"\nstiffness = "{stiffness}"\n')
    assert zw.load(file).device == device


WHEEL = '[device]\ninertia = 0.006\ndamping = "0.02 N*m*s/rad"\nrate = "1 kHz"\n'
STOP = '[environment]\ntype = "wall"\nstiffness = "20 N*m/rad"\n'


def written(folder: Path, text: str, name: str = "a.toml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_device_and_environment_in_files_of_their_own(tmp_path):
    loop = zw.load(written(tmp_path, WHEEL), written(tmp_path, STOP, "b.toml"))
    assert loop.device == zw.rotary(inertia="0.006", damping="0.02", sample_period="0.001", name="a")
    assert loop.environment == zw.Wall(20)
    assert zw.check(*loop).max_stiffness == 40


def test_a_name_of_the_catalogue_and_a_law(tmp_path):
    law = written(tmp_path, STOP.replace("20 N*m/rad", "20 N/m") + '[[law]]\ntype = "force-bounding"\n')
    loop = zw.load("haptic-paddle", law)
    assert loop.environment == zw.render(zw.Wall(20), zw.rendering.ForceBounding())
    assert zw.check(*loop).passive


def test_a_device_alone(tmp_path):
    assert zw.load("haptic-paddle") == (zw.catalogue.device("haptic-paddle"), None)
    with pytest.raises(zw.InputError, match="no file is given"):
        zw.load()
    with pytest.raises(zw.InputError, match=r"no file has an \[environment\]"):
        zw.load("haptic-paddle", written(tmp_path, '[[law]]\ntype = "force-bounding"\n'))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[device]\nmass = 1\n", "sample_period"),
        ("[devise]\nmass = 1\n", "devise"),
        (WHEEL + "stiffness = 3\n", "stiffness"),
        (STOP, "no device"),
    ],
)
def test_what_cannot_be_used_is_said(text, message, tmp_path):
    with pytest.raises(zw.InputError, match=message):
        zw.load(written(tmp_path, text))
