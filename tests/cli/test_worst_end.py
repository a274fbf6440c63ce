"""Commands that need one value take the worst end of an interval, and say so."""

import pytest

import zwidth as zw
from zwidth.cli.decision import of_one_value
from zwidth.model.specification.read import Specification


@pytest.mark.parametrize(
    "line",
    [
        "limit --json",
        "simulate --operator typical --duration '0.2 s'",
        "compare --laws half-sample-prediction",
        "play -o page.html --no-browser",
        "map --stiffness 0:400 --virtual-damping 0:0.2 --cells 8x8",
        "serve --duration 0.1",
    ],
)
def test_a_delay_of_which_the_ends_are_known(line, run):
    """The sample of a board whose delay lies between two."""
    run("examples .")
    command, _, rest = line.partition(" ")
    told = run(f"{command} hapkit.toml {rest}").err.replace("\n", " ")
    assert "the worst end is taken, for one value is needed: delay 250 µs" in told


def test_a_map_is_of_the_worst_end_and_of_no_interval_of_a_mass(run, refused):
    """Of a mass no end is the worst."""
    line = "map --rate '1 kHz' --stiffness 0:400 --virtual-damping 0:0.2 --cells 8x8 --json"
    found = run(f"{line} --mass 1 --damping '0.1 .. 0.3'").json
    assert found == run(f"{line} --mass 1 --damping 0.1").json
    assert "its mass is an interval" in refused(f"{line} --mass '1 .. 2' --damping 0.1")


def test_the_limit_is_that_of_the_worst_end(run):
    """Least friction, longest delay; a single value is never replaced."""
    line = "limit --rate '1 kHz' --stiffness 100 --json"
    found = run(f"{line} --damping '0.2 .. 0.3' --delay '0 .. 1 ms'").json
    assert found == run(f"{line} --damping 0.2 --delay '1 ms'").json
    device = zw.Device(damping=0.2, sample_period=0.001, mass=(1, 2))
    loop = Specification(device, zw.Wall(stiffness=100))
    assert of_one_value(loop) is loop


@pytest.mark.parametrize(
    "line",
    [
        "limit touch --stiffness 20 --json",
        "map touch --stiffness 0:40 --virtual-damping 0:0.2 --cells 8x8 --mass '50 g' --json",
        "simulate touch --mass '50 g' --stiffness 20 --operator typical --duration '0.2 s'",
        "diagnose shaking.csv openffboard-wheel",
    ],
)
def test_a_stated_range_of_the_catalogue(line, run):
    """What nobody published is taken at the worst end of its range, not asked for."""
    run("examples .")
    told = " ".join(run(line).err.split())
    assert "the worst end is taken, for one value is needed: damping" in told


@pytest.mark.parametrize("command", ["check", "report -o page.html"])
def test_a_law_that_is_decided_for_one_delay(command, run):
    """A Hunt–Crossley contact on a device whose delay nobody published: the longest is taken."""
    contact = "touch --type hunt-crossley --stiffness 10 --exponent 1 --dissipation 0"
    found = run(f"{command} {contact}", None)
    assert "for one value is needed: delay 1 ms" in " ".join(found.err.split())


def test_a_stated_range_of_the_catalogue_has_a_worst_end(run):
    """A limit of a wheel of which little is published needs no number of its own."""
    line = "limit moza-r9 --stiffness '0.05 N*m/rad'"
    worst = "--damping 0.005 --coulomb-friction 0.02 --resolution '287.7 urad' --delay '2 ms'"
    told, given = run(f"{line} --json"), run(f"{line} {worst} --json")
    assert "the worst end is taken" in told.err.replace("\n", " ")
    key = "proved_passive_N_m_per_rad"
    assert told.json[key] == pytest.approx(given.json[key], rel=1e-3)
