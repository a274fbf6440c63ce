"""`zwidth plan`: the protocol, and one clear line on bad input."""

from __future__ import annotations

import pytest

import zwidth as zw
from zwidth.cli.main import main

PADDLE = ["plan", "haptic-paddle", "--force-noise", "0.1 N"]


def test_it_prints_the_plan(capsys):
    """The same words as in Python, units on the command line converted."""
    assert main([*PADDLE, "--length", "8 cm", "--fast", "300 ms", "--precision", "0.04"]) == 0
    plan = zw.plan(
        zw.catalogue.device("haptic-paddle"), force_noise=0.1, length=0.08, fast=0.3, precision=0.04
    )
    assert capsys.readouterr().out.split() == str(plan).split()


def test_parameters_override_the_source(capsys):
    """A coarse encoder makes Coulomb friction the limit."""
    assert main([*PADDLE, "--resolution", "2.24 mm"]) == 0
    assert "To know f_c" in capsys.readouterr().out


def test_a_file_of_a_device_in_intervals_is_a_guess(capsys, tmp_path):
    """What `zwidth identify -o` writes can be planned with."""
    path = tmp_path / "mine.toml"
    path.write_text(
        "[device]\nmass = [0.03, 0.04]\ndamping = [0.1, 0.2]\ncoulomb_friction = [0.11, 0.13]\n"
        "resolution = 2.24e-05\nsample_period = 0.001\n"
    )
    assert main(["plan", str(path), "--force-noise", "0.1"]) == 0
    assert "To know b within" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["plan", "haptic-paddle"], "--force-noise"),
        (["plan", "--force-noise", "0.1"], "no device"),
        ([*PADDLE, "--slow", "0.1"], "longer"),
        ([*PADDLE, "--length", "3 N"], "length"),
        (["plan", "phantom", "--force-noise", "0.1"], "mass"),
        (
            ["plan", "--inertia", "2e-4", "--damping", "1e-3", "--rate", "1000", "--force-noise", "1e-3"],
            "90 deg",
        ),
    ],
)
def test_bad_input_ends_in_one_line(argv, message, capsys):
    """Status 2, and what to do."""
    assert main(argv) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
