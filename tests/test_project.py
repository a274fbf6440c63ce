"""What holds of the project as a whole: what it imports, says of itself and ships."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import json
import math
import os
import re
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from contextlib import redirect_stdout, suppress
from fractions import Fraction
from functools import cache
from importlib import import_module
from io import StringIO
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import numpy as np
import pytest
from json_page import json_page
from scipy.signal import TransferFunction

import zwidth as zw
from zwidth import checker
from zwidth.cli.commands import COMMANDS
from zwidth.cli.main import main

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "src" / "zwidth"


def _text(name):
    return (ROOT / name).read_text(encoding="utf-8")


PYPROJECT = tomllib.loads(_text("pyproject.toml"))
RESULTS = {"FrictionModel", "Identified", "InputError", "Log", "Verdict", "Witness"}
"""Classes that zwidth makes and a person only reads."""

CLASSES = [name for name in zw.__all__ if inspect.isclass(getattr(zw, name)) and name not in RESULTS]


def test_the_checker_imports_the_standard_library_only():
    """What re-proves a certificate shares no code with what found it; its parts know each other alone.

    A storage function has millions of moves: to go through them takes numpy, but for the slow twin.
    """
    house = SOURCE / "checker"
    files = sorted(house.rglob("*.py"))
    assert files
    for file in files:
        is_fast = file.parent.name == "storage" and file.name != "plainly.py"
        allowed = sys.stdlib_module_names | ({"numpy"} if is_fast else set())
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                assert {alias.name.split(".")[0] for alias in node.names} <= allowed
            elif isinstance(node, ast.ImportFrom):
                inside = len(file.relative_to(house).parts)
                assert 0 < node.level <= inside or (node.module or "").split(".")[0] in allowed


def test_the_import_order_holds():
    """A later chapter may use an earlier one, never the reverse."""
    from importlinter import cli as contracts

    assert contracts.lint_imports(config_filename=str(ROOT / "pyproject.toml"), no_cache=True) == 0


@pytest.mark.parametrize("name", zw.__all__)
def test_every_public_name_is_documented(name):
    """Each name has a docstring, and each public attribute that it or a class of ours below it defines."""
    thing = getattr(zw, name)
    assert inspect.getdoc(thing)
    if inspect.isclass(thing):
        assert thing.__doc__, f"{name} inherits its docstring"
        fields = {f.name for f in dataclasses.fields(thing)} if dataclasses.is_dataclass(thing) else set()
        ours = (base for base in thing.__mro__ if base.__module__.startswith("zwidth."))
        for key, member in (pair for base in ours for pair in vars(base).items()):
            if key.startswith("_") or key in fields:
                continue
            function = getattr(member, "fget", getattr(member, "func", member))
            if inspect.isfunction(function):
                assert inspect.getdoc(getattr(thing, key)), f"{name}.{key}"


@pytest.mark.parametrize("name", [*CLASSES, "check", "rotary"])
def test_every_argument_is_documented(name):
    thing = getattr(zw, name)
    text = inspect.getdoc(thing) or ""
    arguments = [p for p in inspect.signature(thing).parameters if p != "self"]
    missing = [a for a in arguments if not re.search(rf"\b{re.escape(a)}\b", text)]
    assert not missing, f"{name}: {missing}"


def test_names_of_all_are_sorted_and_exist():
    """`zwidth.__all__` is a list one can find a name in."""
    assert list(zw.__all__) == sorted(zw.__all__, key=lambda n: (not n[0].isupper(), n))
    assert all(hasattr(zw, name) for name in zw.__all__)


def test_a_room_is_one_under_both_of_its_names():
    """`import zwidth.servo.devices` is the room that stands on a floor; of a function there is no module."""
    assert import_module("zwidth.rendering") is zw.rendering is import_module("zwidth.model.rendering")
    devices = import_module("zwidth.servo.devices")
    assert devices is import_module("zwidth.machine.servo.devices")
    assert devices.__name__ == "zwidth.machine.servo.devices"
    for name in ("zwidth.check", "zwidth.null_space", "zwidth.nothing", "zwidth.rendering.nothing"):
        with pytest.raises(ModuleNotFoundError):
            import_module(name)


def test_what_is_shipped_beside_the_code():
    """Type checkers find the marker, the catalogue its data; checkers schemas, laws mains, pages modules."""
    data = ("model/device/catalogue.toml", "data/gains/families.toml", "checker/schemas/spring.json")
    for name in ("py.typed", *data, "machine/firmware/mains/shared/guard.h", "show/explorer/play/engine.mjs"):
        assert (SOURCE / name).exists()


def _tracked() -> list[Path]:
    try:
        git = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git checkout")
    return [ROOT / name for name in git.stdout.split("\0") if name]


MACHINE_PATH = re.compile(r"(?<![\w.])/(?:home|Users|root|work|tmp|mnt)/\w")


def test_no_file_names_a_path_of_some_machine():
    """A clone works anywhere."""
    found = []
    for path in _tracked():
        if path.suffix in {".png", ".svg"} or not path.is_file():
            continue
        text = path.read_text(encoding="utf-8")
        found += [f"{path.name}: {m.group()}" for m in MACHINE_PATH.finditer(text)]
    assert not found


def test_the_readme_has_two_commands():
    job, tests = (line for line in _text("README.md").splitlines() if line.startswith("python3 -m venv"))
    assert "zwidth check" in job
    assert "pytest" in tests


def _pole_of_the_readme(stiffness: float, damping: float) -> float:
    """Largest |pole| of m = 0.1 kg, b = 0.1 N·s/m, sampled and held each 1 ms, with K + B (z − 1)/(T z)."""
    m, b, t = 0.1, 0.1, 0.001
    kept = math.exp(-b * t / m)
    way, push = m / b * (1 - kept), damping / t
    body = [[1, way, 0], [0, kept, 0], [1, 0, 0]]  # position, velocity, position before
    pushed = np.array([(t - way) / b, (1 - kept) / b, 0])
    return float(abs(np.linalg.eigvals(body - np.outer(pushed, [stiffness + push, 0, -push]))).max())


def test_the_readme_table_is_what_comes_out():
    """Its numbers are computed, not remembered; device and walls alone are passive, as it says."""
    row = r"^\| (\d+) \| ([\d.]+) \| ([\d.]+) \| (\w+) \| ([\d.]+)(.*?) \| True"
    table = re.findall(row, _text("README.md"), re.MULTILINE)
    assert len(table) == 4
    device = zw.Device(mass=0.1, damping=0.1, sample_period=0.001)
    assert zw.ports.passivity_indices(TransferFunction([1], [0.1, 0.1])).passive
    for k, b, needed, outcome, pole, remark in table:
        verdict = zw.check(device, zw.Wall(stiffness=k, damping=b))
        assert verdict.outcome == outcome
        assert verdict.required_damping == pytest.approx(float(needed), abs=5e-4)
        assert _pole_of_the_readme(float(k), float(b)) == pytest.approx(float(pole), abs=6e-7)
        assert (", unstable" in remark) == (float(pole) > 1)
        wall = TransferFunction([float(k) + 1000 * float(b), -1000 * float(b)], [1, 0], dt=0.001)
        assert zw.ports.passivity_indices(wall).passive


def test_whoever_builds_the_docs_has_the_explorer():
    """The page that computes as one plays is made of it."""
    extras = PYPROJECT["project"]["optional-dependencies"]
    assert set(extras["explore"]) <= set(extras["docs"])


def _bounds():
    """The lower bounds of each library that is asked for, but for those of the docs."""
    project = PYPROJECT["project"]
    extras = [asked for name, asked in project["optional-dependencies"].items() if name != "docs"]
    bounds = {}
    for line in [*project["dependencies"], *(line for lines in extras for line in lines)]:
        asked = re.fullmatch(r"([\w-]+)(\[[\w,]+\])?>=([\d.]+)(;.+)?", line)
        assert asked, f"{line}: no lower bound"
        bounds.setdefault(asked[1], set()).add(asked[3])
    return bounds


def test_the_oldest_versions_that_are_tested_are_the_lower_bounds():
    """Whoever has the oldest that pyproject.toml admits has what `.ci/oldest` tests."""
    lines = _text(".ci/oldest.txt").splitlines()
    pins = dict(line.split("==") for line in lines if line and not line.startswith("#"))
    for name, bounds in _bounds().items():
        (bound,) = bounds
        assert re.fullmatch(rf"{re.escape(bound)}(\.0)*", pins[name]), f"{name}: {bound}, tested {pins[name]}"


def test_what_is_run_with_the_oldest_versions_exists():
    """Every test that the list names: one that has moved would be no test."""
    listed = re.findall(r"^  (tests/\S+)", _text(".ci/oldest"), re.M)
    assert len(listed) > 10
    for name in listed:
        file, _, test = name.partition("::")
        assert (ROOT / file).exists(), name
        assert not test or f"\ndef {test}(" in _text(file), name


def _blocks(page: str, language: str) -> list[str]:
    return re.findall(rf"```{re.escape(language)}\n(.*?)```", _text(page), re.DOTALL)


def test_the_readme_example_says_what_comes_out():
    names = {}
    for example in _blocks("README.md", "python"):
        exec(example, names)
    assert f"{names['trace'].zwidth.energy.extracted:.4f}" == "0.0342"
    verdict = names["verdict"]
    assert verdict.outcome == "active"
    assert (verdict.max_stiffness, verdict.required_damping) == (300, 0.385)
    assert verdict.limit == "sampling against viscous damping"
    assert f"{verdict.witness.energy:.4f}" == "0.0014"
    assert verdict.advice[0].text == "raise the rate from 1 kHz to 2.567 kHz"


def test_the_quickstart_example_says_what_comes_out(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    (example,) = _blocks("docs/quickstart.md", "python")
    exec(example, names)
    verdict = names["verdict"]
    assert (verdict.outcome, verdict.max_stiffness, verdict.required_damping) == ("passive", 300, 0.15)
    assert verdict.critical_frequency == pytest.approx(500, rel=1e-12)
    assert Path("wall.json").exists()


@pytest.mark.parametrize("page", ["quickstart", "specification", "identification"])
def test_the_specifications_of_a_page_can_be_read(page, tmp_path):
    """Every TOML block with tables in the docs is a valid specification; one without is a velocity filter."""
    from zwidth.cli.simulate.tables import build_touch
    from zwidth.model.specification.laws import with_laws
    from zwidth.model.specification.read import TABLES, read_tables, specified

    blocks = _blocks(f"docs/{page}.md", "toml")
    assert blocks
    for number, block in enumerate(blocks):
        tables = [block]
        if not re.search(r"^\[", block, re.MULTILINE):
            head = '[environment]\ntype = "wall"\nstiffness = 100\n'
            tables = [head + line for line in block.splitlines()]
        for k, text in enumerate(tables):
            path = tmp_path / f"{number}-{k}.toml"
            path.write_text(text, encoding="utf-8")
            if "[coupling]" in text:
                zw.load(path)
                continue
            given = {} if "[device]" in text else {"damping": "1", "rate": "1 kHz"}
            given |= {"motion": "rotary"} if given and "rad" in text else {}
            given |= {} if "[environment]" in text else {"stiffness": "1"}
            read = read_tables([path], TABLES)
            loop = specified(read, given)
            with_laws(loop.environment, read.get("law"), None, loop.device.motion)
            if "operator" in read:
                build_touch(read["operator"], read.get("simulation"), {}, loop.device)


def test_every_public_name_is_on_the_page_of_the_interface():
    """In a block that lists names; those of a namespace are listed by it."""
    listed = set(re.findall(r"\w+", "\n".join(_blocks("docs/api.md", "{names}"))))
    assert not [name for name in zw.__all__ if name not in listed and not inspect.ismodule(getattr(zw, name))]


@cache
def _command_line_page() -> str:
    """The page with its generated tables in place, as the docs build makes it."""
    sys.path.insert(0, str(ROOT / "docs" / "_ext"))
    try:
        import tables
    finally:
        sys.path.pop(0)
    made = tables.generated()
    return re.sub(
        r"```\{include\} _generated/(.+)\.md\n```", lambda one: made[one[1]](), _text("docs/command-line.md")
    )


def _help(*command: str) -> str:
    from zwidth.cli.main import main

    said = StringIO()
    with redirect_stdout(said), suppress(SystemExit):
        main([*command, "--help", *(["all"] if command else [])])
    return said.getvalue()


def test_every_parameter_is_on_the_command_line_page():
    from zwidth.model.rendering import LAWS
    from zwidth.model.specification.environments import TYPES, option_keys
    from zwidth.model.specification.read import DEVICE_KEYS

    page = _command_line_page()
    keys = {*DEVICE_KEYS, *option_keys(), "type"}
    missing = [key for key in keys if f"`--{key.replace('_', '-')}" not in page]
    missing += [name for name in (*TYPES, *LAWS) if f"`{name}`" not in page]
    assert not missing


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_in_the_help_is_on_the_command_line_page(command):
    """Under the heading of the command, or among what several commands have in common."""
    sections = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", _command_line_page(), re.M | re.S))
    others = {"serve": ["simulate"], "sweep": ["simulate", "limit", "pair"]}.get(command, [])
    told = sections["What all have"] + "".join(sections[f"zwidth {name}"] for name in (command, *others))
    options = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", _help(command))) - {"--help"}
    assert options or command == "completion"
    missing = [o for o in options if f"`{o}" not in told]
    assert not missing


def test_every_key_of_the_json_is_on_its_page():
    page = json_page()
    paddle = zw.catalogue.device("haptic-paddle")
    delayed = paddle.replace(delay=0.0003)
    solid = zw.StandardLinearSolid(100, 50, 1, discretization="backward")
    loops = [
        (paddle, zw.Wall(stiffness=300)),
        (paddle, zw.Wall(stiffness=770)),
        (delayed, zw.Wall(stiffness=900, damping=0.1)),
        (paddle, zw.Wall(stiffness=200, damping=0.02)),
        (paddle.replace(coulomb_friction=0), zw.Wall(stiffness=100)),
        (paddle.replace(damping=(0.2, 0.3)), solid),
        (paddle, zw.Wall(stiffness=250, damping=0.05, clamped=True)),
    ]
    keys = _keys(zw.limit(paddle, zw.Wall(100, 0.05), speed="0.2", penetration="0.0005").to_dict())
    for device, environment in loops:
        keys |= _keys(zw.check(device, environment).to_dict())
    assert not [key for key in sorted(keys) if f"`{key}`" not in page]


@pytest.mark.parametrize(
    "line",
    [
        "check haptic-paddle --stiffness 770 --replay",
        "check haptic-paddle --stiffness 300 --active-below '10 Hz'",
        "each haptic-paddle hapkit --stiffness 200",
        "emit haptic-paddle --stiffness 250 -o paddle",
        "gains {leader.yaml} {follower.yaml}",
        "identify {session.csv} --stiffness 100",
        "simulate haptic-paddle --stiffness 770 --operator dowel --duration 0.3",
        "workspace two-link --joint-damping 0.002 --joint-friction 0.1 --joint-resolution 0.1 --stiffness 50",
        "workspace {arm.urdf} --joint-damping 1 --stiffness 500 --postures 200",
    ],
)
def test_every_key_that_a_command_prints_is_on_the_page_of_the_json(line, tmp_path, monkeypatch, capsys):
    """Files, which have names of their own, aside."""
    monkeypatch.chdir(tmp_path)
    argv = re.sub(r"\{(.+?)\}", lambda name: str(zw.samples.path(name[1])), line)
    main([*shlex.split(argv), "--json"])
    document = json.loads(capsys.readouterr().out)
    document.pop("files", None)
    assert not [key for key in sorted(_keys(document)) if f"`{key}`" not in json_page()]


def _unrolled_as_documented(positions, repeats):
    names = {}
    exec(re.search(r"```python\n(def unrolled.+?)```", _text("docs/json.md"), re.DOTALL)[1], names)
    return names["unrolled"](positions, repeats)


def test_unrolling_as_the_json_page_says_keeps_the_energy_of_a_witness():
    """Whoever replays a motion from its JSON extracts the energy that it claims."""
    device = zw.Device(damping=0.15, coulomb_friction=0.01, resolution=0, rate=1000)
    witness = zw.check(device, zw.Wall(stiffness=120, damping=0.1)).witness
    document = {"repeats": [], **witness.to_dict()}
    document["positions_m"] = _unrolled_as_documented(document["positions_m"], document.pop("repeats"))
    assert checker.verify(document).energy == witness.exact_energy
    assert len(document["positions_m"]) == witness.motion.samples + 1


def test_unrolling_as_the_json_page_says_carries_an_advance_on():
    """A part that ends ahead of its start moves all that follows, as the checker has it."""
    device = zw.Device(damping=0.15, coulomb_friction=0.01, resolution=0, rate=1000)
    document = zw.check(device, zw.PulseTransferFunction([900, -500], [1, 0.2])).witness.to_dict()
    repeats = [{"first": 1, "last": 4, "times": 7}, {"first": 5, "last": 6, "times": 30}]
    positions = [Fraction(n, 1000) for n in (0, 3, 5, 4, 6, 7, 9, 2, -1)]
    whole = _unrolled_as_documented(positions, repeats)
    assert whole[:6] == [*positions[:5], positions[2] + Fraction(3, 1000)]
    repeated = checker.verify({**document, "positions_m": positions, "repeats": repeats})
    unrolled = checker.verify({**document, "positions_m": whole, "repeats": []})
    assert repeated.energy is not None
    assert repeated.energy == unrolled.energy


def _keys(document: object) -> set[str]:
    if isinstance(document, dict):
        return set(document).union(*(_keys(v) for v in document.values()))
    if isinstance(document, list | tuple):
        return set().union(*(_keys(v) for v in document))
    return set()


def test_every_file_that_the_newcomers_page_names_exists():
    """One contact through every floor: a file that moves takes its line along."""
    named = set(re.findall(r"`([a-z_]+/[a-z_/]*(?:\.py|/))`", _text("docs/inside.md")))
    assert len(named) > 30
    assert {name for name in named if not (SOURCE / name).exists() and not (ROOT / name).exists()} == set()


def test_no_two_files_of_tests_have_one_name():
    """Two of one name, in folders without `__init__.py`, cannot be collected in one run."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(set(names)) == sorted(names)


def test_names_that_are_found_and_not_offered_stand_where_they_belong():
    """Old programs go on, and `dir` is short; each is offered by a namespace, or is the type of a result."""
    found = {
        "amplifiers": zw.simulation.amplifiers,
        "Log": zw.identification.Log,
        "FrictionCompensation": zw.rendering.FrictionCompensation,
        "check_gains": zw.gains.check_gains,
        "read_gains": zw.gains.read_gains,
        "load_sweep": zw.maps.load_sweep,
        "stiffness_over_postures": zw.maps.stiffness_over_postures,
    }
    assert {name: getattr(zw, name) for name in found} == found
    assert not {*found, "Certificate", "Witness", "Exact"} & {*dir(zw)}
    paddle = zw.catalogue.device("haptic-paddle")
    assert isinstance(zw.check(paddle, zw.Wall(stiffness=300)).certificate, zw.Certificate)
    assert isinstance(zw.check(paddle, zw.Wall(stiffness=9000)).witness, zw.Witness)


def test_type_checkers_see_every_public_name():
    """``import a as b`` in a stub exports nothing; ``b = a`` below it does."""
    for stub in (ROOT / "src").rglob("__init__.pyi"):
        for line in ast.walk(ast.parse(stub.read_text(encoding="utf-8"))):
            if isinstance(line, ast.ImportFrom):
                renamed = [name for name in line.names if name.asname not in (None, name.name)]
                assert not renamed, ast.unparse(line)
    assert {"limit", "plan", "operators"} <= {*dir(zw)}
    assert not {"passive_limit", "plan_identification", "operator"} & {*dir(zw)}


def _rooms(room: ModuleType) -> Iterator[ModuleType]:
    """It, and those that it offers, and that these offer."""
    yield room
    for name in getattr(room, "__all__", ()):
        inside = getattr(room, name)
        if isinstance(inside, ModuleType):
            yield from _rooms(inside)


def test_completion_shows_what_a_person_wants_and_nothing_else():
    """`dir`, which it asks: of a room no import and no type of typing, of a class no constant in capitals."""
    rooms = [room for room in _rooms(zw) if room is not zw.firmware]  # which defines nothing
    classes = set()
    for room in rooms:
        offered = {name: getattr(room, name) for name in dir(room)}
        assert offered, room
        for name, one in offered.items():
            assert not isinstance(one, ModuleType) or name in room.__all__, (room, name)
            assert getattr(one, "__module__", "zwidth").startswith("zwidth"), (room, name)
        classes |= {one for one in offered.values() if isinstance(one, type)}
    assert len(rooms) > 25
    assert len(classes) > 150
    assert [(one, name) for one in classes for name in dir(one) if name.isupper() and name[0] != "_"] == []


def test_no_module_bears_the_name_of_what_its_package_offers():
    """Whoever imports the module would put it in the place of a function that is found when asked for."""
    for stub in (ROOT / "src").rglob("__init__.pyi"):
        package = ".".join(stub.parent.relative_to(ROOT / "src").parts)
        for line in ast.walk(ast.parse(stub.read_text(encoding="utf-8"))):
            if isinstance(line, ast.ImportFrom) and line.module != package:
                inside = {(stub.parent / f"{name.asname or name.name}.py").name for name in line.names}
                beside = {path.name for path in stub.parent.glob("*.py")}
                assert not inside & beside, f"{stub}: {inside & beside}"


def _readme_commands():
    """The lines of the README that begin with zwidth, as typed."""
    lines = [line for block in _blocks("README.md", "sh") for line in block.splitlines()]
    return [line for line in lines if line.startswith("zwidth ") and "--help" not in line]


def test_each_command_of_the_readme_works_as_typed(tmp_path, monkeypatch, capsys):
    """Its options exist, and the files that it reads are samples, or were written by a line above."""
    monkeypatch.chdir(tmp_path)
    lines = _readme_commands()
    assert len(lines) == 12
    for line in lines:
        argv = shlex.split(line, comments=True)[1:]
        ended = ["--duration", "0.2 s"] if argv[0] == "serve" else []  # else it runs until it is told to end
        status = main([*argv, *ended])
        assert status in (0, 1), f"{line}\n{capsys.readouterr().err}"


def _said_of(script: Path, *options: str) -> list[str]:
    """What mypy says of a script, or of all in a folder, and not of what they import."""
    where = script if script.is_dir() else script.parent
    command = [sys.executable, "-m", "mypy", "--cache-dir", str(where / "cache"), *options, str(script)]
    environment = {**os.environ, "MYPYPATH": str(ROOT / "src")}
    done = subprocess.run(command, cwd=where, capture_output=True, encoding="utf-8", env=environment)
    own = tuple(f"{path.name}:" for path in where.glob("*.py"))
    return [line for line in done.stdout.splitlines() if line.startswith(own)]


def test_a_type_checker_sees_what_the_readme_asks_of_a_verdict(tmp_path):
    """Every attribute of its example exists for mypy, on the type that `zwidth.check` is said to return."""
    script = tmp_path / "readme.py"
    script.write_text(
        "\n".join([_blocks("README.md", "python")[0], "verdict.no_such_name"]), encoding="utf-8"
    )
    (said,) = _said_of(script)
    assert "no_such_name" in said


FROM_THE_TEXT = {
    "logs": "import numpy as np\nt = x = f = np.zeros(9)",
    "recording": "device, wall, hand = zw.Device(damping=1, rate=1), zw.Wall(1), zw.operators.Finger()\n"
    "connection = zw.servo.devices.Simulated(device=device, hand=hand, duration=1)\n"
    "servo = zw.servo.Servo(device, wall, connection)",
    "simulation": "finger = dowel = zw.traces.load_trace('touch.nc')",
    "bounding": "paddle = zw.catalogue.device('haptic-paddle')",
    "coupling": "device = zw.catalogue.device('haptic-paddle')",
    "known-hand": "device = zw.catalogue.device('haptic-paddle')",
    "loop-transformations": "device = zw.catalogue.device('haptic-paddle')",
}
"""What a page of the docs takes from the text around its blocks."""


def _shown_code() -> Iterator[tuple[str, str]]:
    """A name and the code of each example, lesson and page: what a person has in an editor."""
    samples = SOURCE / "model" / "samples"
    for path in [*(ROOT / "examples").rglob("*.py"), samples / "fit_tissue.py"]:
        yield path.stem, _text(path)
    for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
        blocks = _blocks(str(page.relative_to(ROOT)), "python")
        before = ["import zwidth as zw", FROM_THE_TEXT.get(page.stem, "")]
        yield f"{page.parent.name}_{page.stem}", "\n".join([*before, *map(dedent, blocks)])
    for lesson in samples.glob("*.ipynb"):
        cells = json.loads(_text(lesson))["cells"]
        yield lesson.stem, "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")


def test_a_strict_type_checker_finds_nothing_in_the_examples(tmp_path):
    """Nor in the lessons, nor on a page of the docs, but that other packages tell no types."""
    code = dict(_shown_code())
    assert len(code) > 60
    for name, text in code.items():
        (tmp_path / f"{re.sub(r'[^a-z0-9]', '_', name)}.py").write_text(text, encoding="utf-8")
    assert _said_of(tmp_path, "--strict", "--ignore-missing-imports", "--scripts-are-modules") == []
