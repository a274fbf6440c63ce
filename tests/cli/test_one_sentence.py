"""What was found, how much and what to do: one sentence, the same wherever a verdict is shown."""

import json
import re
import shlex
from html import escape
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.model.specification.load import load_pair
from zwidth.model.specification.read import load
from zwidth.passivity.scope import TOLD

ARMS = """[leader]
mass = "50 g"
damping = "0.5 N*s/m"
rate = "1 kHz"
[follower]
mass = "0.1 kg"
damping = "0.6 N*s/m"
rate = "1 kHz"
[coupling]
stiffness = "500 N/m"
link_delay = "2 ms"
"""
WHEEL = """[device]
inertia = 0.006
damping = 0.02
coulomb_friction = 0.05
counts_per_turn = 65536
rate = "1 kHz"
"""
WINDOW = "--virtual-damping 0.2 --velocity-filter 'window 3'"
PADDLE = "check haptic-paddle --stiffness"
LOOPS = {
    "passive": (
        f"{PADDLE} 240",
        0,
        "loop: stiffness may go up to 300 N/m (",
    ),
    "at its limit": (f"{PADDLE} 300", 0, "loop; it is exactly at its limit"),
    "active": (
        f"{PADDLE} 770",
        1,
        "A motion of the hand takes 1.427 mJ out of this loop in 2 ms, each time it is made: lower the "
        "stiffness from 770 N/m to 300 N/m.",
    ),
    "active wheel": (
        "check wheel.toml --stiffness '60 N*m/rad'",
        1,
        "lower the stiffness from 60",
    ),
    "beyond hands": (
        f"{PADDLE} 301",
        1,
        "it is more than any hand does: lower",
    ),
    "in contact": (f"{PADDLE} 120 {WINDOW}", 4, "every hand would be covered."),
    "between corners": (
        f"{PADDLE} '200 .. 400'",
        3,
        "For a proof, lower the st",
    ),
    "pair": ("pair arms.toml", 1, "each time it is made: lower the stiffness from 500 N/m to "),
}


@pytest.fixture(autouse=True)
def files(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    Path("arms.toml").write_text(ARMS, encoding="utf-8")
    Path("wheel.toml").write_text(WHEEL, encoding="utf-8")


@pytest.mark.parametrize("name", LOOPS)
def test_every_face_says_the_same_sentence(run, name):
    """Terminal, full report, plain data, Python in a terminal and in a notebook, the title of the picture."""
    command, status, part = LOOPS[name]
    told = json.loads(run(f"{command} --json", status).out)
    claim = told["claim"]
    assert part in claim
    machinery = re.compile("criterion|Nyquist|multiplier|certificate")
    assert machinery.search(claim) is None
    for more in ("", " --all"):
        assert f"{told['outcome'].upper()} {claim}" in run(command + more, status).words
    _, source, *options = shlex.split(command)
    given = {key[2:].replace("-", "_"): value for key, value in zip(options[::2], options[1::2], strict=True)}
    loop = None if name == "pair" else load([source], given)
    verdict = zw.check(load_pair([source])) if loop is None else zw.check(loop.device, loop.environment)
    assert verdict.claim == claim
    assert claim in repr(verdict)
    assert escape(claim) in verdict._repr_html_()
    title = " ".join(verdict.figure().get_suptitle().split())
    assert title.endswith(claim)


def test_every_kind_of_answer_tells_a_proof_alike(run):
    """Of a loop, a chain, a pair, a held pair, ports on a link; what is simulated has a word of its own."""
    paddle, pair = zw.catalogue.device("haptic-paddle"), load_pair(["arms.toml"])
    chain = zw.render(zw.Wall(770), zw.rendering.ForceBounding())
    proofs = (
        zw.check(paddle, zw.Wall(100)),
        zw.check(paddle, chain),
        zw.formulas.check_bounding(paddle, chain),
        zw.check(pair.replace(stiffness=50)),
        zw.check(pair.replace(stiffness=50), follower=None),
        zw.links.check(zw.links.WavePort(paddle)),
    )
    for proof in proofs:
        assert proof.passive
        assert re.match(r"No motion of .+, however fast or skilled, can take energy out of this", proof.claim)
    badge = run("simulate haptic-paddle --stiffness 770 --operator dowel --duration 1").out.split()[0]
    assert badge == "GAINED"
    assert badge.lower() not in TOLD
