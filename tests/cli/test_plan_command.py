"""`zwidth plan`: the protocol, and one clear line on bad input."""

from pathlib import Path

import zwidth as zw

PADDLE = "plan haptic-paddle --force-noise '0.1 N'"


def test_it_prints_the_plan(run):
    device = zw.catalogue.device("haptic-paddle")
    plan = zw.plan(device, force_noise=0.1, length=0.08, fast=0.3, precision=0.04)
    said = run(f"{PADDLE} --length '8 cm' --fast '300 ms' --precision 0.04").out
    assert said.split() == str(plan).split()


def test_parameters_override_the_source(run):
    """A coarse encoder makes Coulomb friction the limit."""
    assert "To know f_c" in run(f"{PADDLE} --resolution '2.24 mm'").out


def test_a_file_of_a_device_in_intervals_is_a_guess(run):
    """What `zwidth identify -o` writes can be planned with."""
    Path("mine.toml").write_text(
        "[device]\nmass = [0.03, 0.04]\ndamping = [0.1, 0.2]\ncoulomb_friction = [0.11, 0.13]\n"
        "resolution = 2.24e-05\nsample_period = 0.001\n",
        encoding="utf-8",
    )
    assert "To know b to ±" in run("plan mine.toml --force-noise 0.1").out
