"""A file that is not there: one near it in name is told, and never one of another folder or kind."""

import argparse
import re
from pathlib import Path

import pytest

from zwidth.cli.commands import COMMANDS, configure
from zwidth.missing import _WORDS, did_you_mean, near_file, suggestion

HERE = ("bumpstop.toml", "wheel.toml", "session.csv", "verdict.json", "leader.yaml", "arm.urdf", "touch.nc")


@pytest.fixture
def folder(run, tmp_path):
    """With one file of each kind, and the process in it."""
    for name in HERE:
        Path(name).touch()
    return tmp_path


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        ("check wheel.toml bumpstp.toml", "bumpstop.toml"),
        ("check Wheel.toml", "wheel.toml"),
        ("check wheel", "wheel.toml"),
        ("check haptic-padle", "haptic-paddle"),
        ("verify verdct.json", "verdict.json"),
        ("identify sesion.csv", "session.csv"),
        ("gains leder.yaml", "leader.yaml"),
        ("traces tuoch.nc", "touch.nc"),
    ],
)
def test_commands_name_the_file_that_is_there(refused, folder, words, meant):
    (folder / "wheel.toml").write_text("[device]\ndamping = 1\nrate = 1000\n", encoding="utf-8")
    assert refused(words).endswith(f'did you mean "{meant}"?\n')


@pytest.mark.parametrize(
    "words",
    [
        "tissue none.csv touch",
        "tissue none.csv --kind none -o none.json",
        "tissue session.csv none.toml --zero none",
        "identify none.csv --confidence 2",
        "identify session.csv none.toml -o none.json",
        "diagnose none.csv wheel.toml --column none=none",
        "diagnose session.csv none.toml -o none.json",
        "gains leader.yaml none.yaml --plot none.png",
        "gains leader.yaml leader.yaml --plant none.toml --link-delay 3",
        "plan none.toml --force-noise none",
    ],
)
def test_an_input_that_is_not_there_is_said_before_anything_else(refused, folder, words):
    assert refused(words).startswith('zwidth: there is no file "none.')


def test_a_file_is_named_as_one_would_type_it(folder):
    assert near_file(Path("..") / folder.name / "wheal.toml") == str(Path("..") / folder.name / "wheel.toml")
    assert near_file(folder / "wheal.toml") == str(folder / "wheel.toml")


@pytest.mark.parametrize("name", ["quite-another.toml", "wheel.csv", "none/wheel.toml", "\0.toml"])
def test_nothing_is_said_where_nothing_is_near(folder, name):
    assert did_you_mean(folder / name) == ""


CALLED = {
    "friction": "damping coulomb-friction joint-damping joint-friction plant",
    "viscous": "damping joint-damping plant",
    "coulomb": "coulomb-friction joint-friction plant",
    "ppr": "counts-per-turn resolution joint-resolution encoder plant",
    "encoder": "encoder resolution counts-per-turn joint-resolution plant",
    "latency": "delay link-delay",
    "max_torque": "force-limit torque-limit",
    "loop_rate": "rate cutoff",
    "dt": "sample-period rate",
    "kp": "stiffness",
    "kd": "virtual-damping local-damping damping",
    "b": "damping virtual-damping",
    "wall_damping": "virtual-damping",
}
"""A word of each row of what people call a quantity, and the options that may be meant."""


@pytest.mark.parametrize("command", COMMANDS)
def test_what_people_call_a_number_is_answered_by_the_option_of_the_command(command):
    """Each word: where the command has such an option by it, else by no other that is spelled alike."""
    parser = argparse.ArgumentParser(add_help=False)
    configure(command, parser)
    shown = [action for action in parser._actions if action.help != argparse.SUPPRESS]
    keys = {name.lstrip("-").replace("-", "_") for action in shown for name in action.option_strings}
    for row in _WORDS.values():
        (meant,) = (CALLED[word] for word in row.split() if word in CALLED)
        has = set(meant.replace("-", "_").split()) & keys
        for word in set(row.split()) - keys:
            told = suggestion(word, keys, "--{}", "see --help")
            named = {one.replace("-", "_") for one in re.findall(r"--([\w.-]*\w)", told)} - {"help"}
            assert (named <= has, bool(named)) == (True, bool(has)), (word, told)
