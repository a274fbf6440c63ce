"""Whatever is typed or read: an exit status that is documented, and no exception."""

from __future__ import annotations

import contextlib
import io
import json
import tempfile
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from strategies import texts

from zwidth.cli.main import main
from zwidth.cli.options import coupling_parameters, device_parameters, environment_parameters
from zwidth.model.specification.environments import TYPES

quick = settings(
    max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)
COUPLING = [p.option for p in coupling_parameters()]
OPTIONS = [p.option for p in (*device_parameters(), *environment_parameters())]

numbers = st.one_of(
    st.sampled_from(["0", "1", "-1", "300", "0.001", "1e-3", "1e40", "1e-40", "1e41", "nan", "-inf"]),
    st.sampled_from(["1/3", "9" * 1000, "1e9999999"]),
    st.decimals(-10, 1000, places=6).map(str),
    st.floats().map(repr),
)  # fmt: skip
units = st.sampled_from(
    ["", " m", " um", " N*s/m", " kHz", " ms", " N/m", " N", " rad", " °", " parsec", " µm"]
)
values = st.one_of(
    st.tuples(numbers, units).map("".join),
    st.tuples(numbers, numbers, units).map(lambda v: f"{v[0]} .. {v[1]}{v[2]}"),
    st.lists(numbers, min_size=1, max_size=5).map(", ".join),
    st.sampled_from(
        [*TYPES, "window 5", "one-pole 50 Hz", "filter 1 -1 / 1 0", "800:3, 200:20", "zoh", "rotary"]
    ),
    texts(),
)


def status(*argv: str) -> int:
    """The exit status of a command line; what it printed is checked for its form."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(argv)
    assert code in (0, 1, 2, 3, 4)
    assert (code == 2) == err.getvalue().startswith("zwidth: ")
    assert err.getvalue().count("\n") == (code == 2)
    if code != 2 and "--json" in argv and argv[0] in ("check", "pair") and "--help" not in argv:
        assert json.loads(out.getvalue())["outcome"] in ("passive", "active", "undecided")
    return code


@contextlib.contextmanager
def written(content: str | bytes, name: str = "document") -> Iterator[str]:
    """A file with some content."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, name)
        path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8", "surrogatepass"))
        yield str(path)


# --- command lines --------------------------------------------------------------


@quick
@given(
    st.lists(
        st.one_of(
            st.sampled_from(["check", "pair", "devices", "verify", "--json", "--help", *OPTIONS]), texts()
        )
    )
)
def test_any_words(argv: list[str]) -> None:
    if "-o" not in argv and "--save" not in argv:
        status(*argv)


SOUND = {
    "--stiffness": ["0", "100 .. 200", "300", "1e40", "1e-40"],
    "--virtual-damping": ["0.05", "-0.1", "0 .. 0.01"],
    "--damping": ["0", "0.1 .. 0.2", "1e-30"],
    "--coulomb-friction": ["0", "1e-9", "0 .. 1"],
    "--resolution": ["0", "1 um", "1e30", "0 .. 1e-4"],
    "--delay": ["0.3 ms", "0.004", "1e30", "0 .. 1e-3", "1e-30"],
    "--rate": ["500 .. 1000", "1e9", "1/3 Hz"],
    "--type": ["wall", "maxwell", "standard-linear-solid", "generalized-maxwell"],
    "--velocity-filter": ["window 3", "one-pole 0.01", "filter 1 -1 / 2 0"],
    "--branch-stiffness": ["100", "0"],
    "--branch-damping": ["3", "1e9"],
    "--branches": ["800:3, 200:20", "1:0"],
    "--discretization": ["tustin", "zoh", "matched", "forward"],
}
"""Values that can be used; together they may still be refused."""

sound = st.fixed_dictionaries({}, optional={key: st.sampled_from(given) for key, given in SOUND.items()})


@quick
@given(st.dictionaries(st.sampled_from(OPTIONS), values, max_size=1), sound, st.booleans())
@example({"--stiffness": "300"}, {"--delay": "1e30"}, True)
@example({"--stiffness": "1e40"}, {"--rate": "1e40"}, False)
def test_any_parameters(parameters: dict[str, str], others: dict[str, str], as_json: bool) -> None:
    device = {"--stiffness": "50", "--damping": "0.2", "--rate": "1000"}
    pairs = {**device, **others, **parameters}.items()
    options = [word for pair in pairs for word in pair]
    status("check", *options, *(["--json"] if as_json else []))


@settings(quick, max_examples=8)  # a pair takes its time
@given(st.dictionaries(st.sampled_from(COUPLING), values, max_size=2), st.booleans())
@example({"--stiffness": "1e40"}, True)
@example({"--link-delay": "0.4 s", "--stiffness": "1/3"}, False)
@example({"--virtual-damping": "1e-40", "--local-damping": "-1e40"}, True)
def test_any_coupling(parameters: dict[str, str], as_json: bool) -> None:
    options = [word for pair in ({"--stiffness": "50"} | parameters).items() for word in pair]
    status("pair", "haptic-paddle", *options, *(["--json"] if as_json else []))


@quick
@given(
    st.decimals(0, 2, places=3),
    st.decimals(0, 2000, places=1),
    st.decimals(-1, 1, places=2),
    st.sampled_from(["0", "0.0003", "0.001", "0.01234"]),
    st.sampled_from(["0", "1e-5", "1e-3"]),
    st.sampled_from(["backward-difference", "window 4", "one-pole 30 Hz", "filter 1 -1 / 2 0"]),
)
def test_reasonable_walls(b: Decimal, k: Decimal, v: Decimal, delay: str, count: str, velocity: str) -> None:
    given_values = {"damping": b, "stiffness": k, "virtual-damping": v, "delay": delay, "resolution": count}
    options = [f"--{key}={value}" for key, value in given_values.items()]
    status("check", "haptic-paddle", *options, "--velocity-filter", velocity)


coefficients = st.lists(st.sampled_from(["0", "1", "-1", "0.5", "-2", "1e-9", "40"]), min_size=1, max_size=5)


@quick
@given(coefficients, coefficients, st.sampled_from(["pulse-transfer-function", "transfer-function"]))
@example(["1", "-0.5"], ["1", "-1"], "pulse-transfer-function")
@example(["1", "-0.5"], ["1", "1"], "pulse-transfer-function")
@example(["1", "-0.5"], ["1", "-2", "1"], "pulse-transfer-function")
def test_any_transfer_function(numerator: list[str], denominator: list[str], kind: str) -> None:
    options = [f"--numerator={','.join(numerator)}", f"--denominator={','.join(denominator)}"]
    status("check", "haptic-paddle", "--type", kind, *options)


# --- files ----------------------------------------------------------------------

DEVICE = '[device]\ndamping = 0.15\nrate = "1 kHz"\n'
toml_lines = st.one_of(
    st.tuples(
        st.sampled_from(["damping", "rate", "stiffness", "type", "delay", "branches", "x"]), values
    ).map(lambda p: f"{p[0]} = {json.dumps(p[1])}"),
    st.tuples(st.sampled_from(["damping", "resolution", "stiffness", "velocity_filter"]), numbers).map(
        lambda p: f"{p[0]} = {p[1]}"
    ),
    st.sampled_from(
        [
            *("[device]", "[environment]", "[environment.environment]", 'type = "wall"', "[[device]]", "#"),
            *("[leader]", "[follower]", "[coupling]"),
        ]
    ),
    texts(),
)


@quick
@given(st.lists(toml_lines, max_size=8).map("\n".join))
@example(DEVICE + '[environment]\ntype = "wall"\nstiffness = ' + "9" * 5000)
@example(DEVICE + "[environment]\nstiffness = " + "[" * 5000)
def test_any_toml(content: str) -> None:
    with written(content, "loop.toml") as path:
        status("check", path)
        status("check", path, "--stiffness", "100", "--damping", "0.2", "--rate", "1000")
        status("pair", path)
        status("pair", path, "--stiffness", "100")


@quick
@given(st.binary(max_size=200))
def test_any_bytes(content: bytes) -> None:
    with written(content) as path:
        assert status("check", path) == 2
        status("verify", path)


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | texts()
    | st.sampled_from([10**30, -1, 0, "1/0", "1e5000", "1e999999999", "9" * 30000, "0x1", "1_000", "٣"]),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(texts(), inner, max_size=4),
    max_leaves=10,
)  # fmt: skip


@quick
@given(json_values)
def test_any_json(document: object) -> None:
    with written(json.dumps(document)) as path:
        status("verify", path)


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """A proof and a motion of each kind, as saved."""
    lines = [
        ["--stiffness=300"],
        ["--stiffness=770"],
        ["--stiffness=50", "--virtual-damping=0.05", "--resolution=0"],
        ["--stiffness=50", "--virtual-damping=0.05"],
        ["--stiffness=500", "--delay=0.0004"],
        ["--stiffness=10", "--resolution=0.1"],
        ["--stiffness=100 .. 200", "--virtual-damping=0.01"],
    ]
    asked = [("check", *line) for line in lines]
    asked += [("pair", "--stiffness=100"), ("pair", "--stiffness=100", "--link-delay=0.002")]
    documents = []
    for number, (command, *line) in enumerate(asked):
        path = tmp_path_factory.mktemp("saved") / f"{number}.json"
        status(command, "haptic-paddle", *line, "-o", str(path))
        assert status("verify", str(path)) == 0
        verdict = json.loads(path.read_text(encoding="utf-8"), parse_float=str)
        documents.append(verdict.get("certificate") or verdict["witness"])
    return documents


def _altered(data: st.DataObject, value: Any) -> Any:
    """The value with one thing in it replaced."""
    inside = isinstance(value, (dict, list)) and value and data.draw(st.integers(0, 5)) > 0
    if not inside:
        return data.draw(json_values)
    key = data.draw(st.sampled_from(list(value) if isinstance(value, dict) else range(min(len(value), 20))))
    if isinstance(value, dict):
        return {**value, key: _altered(data, value[key])}
    return [*value[:key], _altered(data, value[key]), *value[key + 1 :]]


@settings(quick, max_examples=30)
@given(st.data())
def test_altered_evidence(saved: list[dict[str, Any]], data: st.DataObject) -> None:
    document = _altered(data, data.draw(st.sampled_from(saved)))
    with written(json.dumps(document)) as path:
        status("verify", path)
