"""What `zwidth verify` says of a proof: no more than its kind shows, and of the numbers that were checked."""

import copy
import json
import math
from pathlib import Path

import pytest

import zwidth as zw
from zwidth import checker
from zwidth.checker import judge
from zwidth.quantity.text import to_json

PADDLE = zw.Device(
    mass=0.036, damping=0.15, rate=1000, coulomb_friction=0.12, resolution=22.4e-6, delay=0.0004
)


def plain(document):
    """As it is read from a file."""
    return json.loads(to_json(document))


def proof_of(wall):
    """The certificate of a passive loop."""
    return plain(zw.check(PADDLE, wall).certificate.to_dict())


SPRING, DAMPED = proof_of(zw.Wall(100)), proof_of(zw.Wall(100, 0.05))
LAW = {"numerator": ["1200", "-400"], "denominator": ["1", "0"], "sample_period_s": "0.001", "delay_s": "0"}
HELD = {"mass_kg": "0.05", "damping_N_s_per_m": "0.7", "stiffness_N_per_m": "350"}
STABLE = {"kind": "stability", "loop": {**HELD, **LAW}}
POSITIVE = {"at_one": 0, "at_minus_one": 0, "square": ["1"], "factor": ["1"]}
PORT = {
    "kind": "positive real",
    "system": {"time": "discrete", "numerator": ["-4"], "denominator": ["1"]},
    "index": "input",
    "level": "-5",
    "proof": {"offset": "1", "positivity": POSITIVE},
}


@pytest.fixture
def told(run):
    """What is printed of a document, in one line: of one that is valid unless another status is given."""

    def runner(document, status=0):
        Path("proof.json").write_text(json.dumps(document), encoding="utf-8")
        return run("verify proof.json", status).words

    return runner


def corners(*documents):
    return {"kind": "corners", "corners": list(documents)}


def test_a_damped_wall_is_passive_in_contact_only(told):
    """Of a one-sided law that is proved as a line it is said that contact is kept; of a spring it is not."""
    assert DAMPED["kind"] == "quantized"
    assert "passive as long as contact is kept" in told(DAMPED)
    two_sided = {**DAMPED, "loop": {**DAMPED["loop"], "unilateral": False}}
    assert "contact is kept" not in told(two_sided)
    assert SPRING["kind"] == "spring"
    assert "The loop below is passive, proved" in told(SPRING)
    assert "passive as long as contact is kept" in told(corners(DAMPED, proof_of(zw.Wall(90, 0.05))))


def test_what_lies_between_corners(told):
    """Two laws with one D are proved with every mix of them; with another period none between is."""
    mixed = told(corners(SPRING, proof_of(zw.Wall(90))))
    assert "and every mix of their laws" in mixed
    slower = plain(zw.check(PADDLE.replace(rate=900), zw.Wall(90)).certificate.to_dict())
    apart = told(corners(SPRING, slower))
    assert "nothing is said of what lies between them" in apart


def test_the_same_corner_twice(told):
    """Two proofs of one corner are no proof of two."""
    assert "the same corner is given twice" in told(corners(DAMPED, DAMPED), 1)


def test_corners_that_differ_in_a_late_digit(told):
    """Two corners that are shown alike, with twelve digits, are two all the same."""
    stiffness = [f"{'1' * 60}{digit}/1{'0' * 59}3" for digit in "12"]
    near = [{**SPRING, "loop": {**SPRING["loop"], "numerator": [k]}} for k in stiffness]
    assert "all 2 corners" in told(corners(*near))


def test_an_active_hand_keeps_contact_in_its_band(told):
    """A hand more active than the device is damped shakes it off the wall: contact is kept, it says."""
    found = plain(zw.stability.tolerated_activity(PADDLE.replace(delay=0), zw.Wall(20, 0.12)).to_dict())
    kept, broken = (found[key]["certificate"] for key in ("contact_kept", "contact_broken"))
    assert "from the loop below as long as contact is kept" in told(kept)
    assert "contact is kept" not in told(broken)


def test_a_known_hand_keeps_contact(told):
    """Rest is that of the linear loop, and nothing is said of passivity."""
    out = told(STABLE)
    assert "contact kept" in out
    assert "passive" not in out


def test_corners_belong_to_the_kind_corners(told):
    """Other proofs beside a proof are no part of it, and would be shown as if they were."""
    for document, other in ((STABLE, SPRING), (SPRING, DAMPED)):
        out = told({**document, "corners": [other]}, 1)
        assert "NOT VALID entries that no proof of this kind has: corners" in out


def test_corners_of_several_kinds(told):
    """Where corners show different things, none of their headlines is that of all."""
    out = told(corners(SPRING, STABLE))
    assert "is passive" not in out
    assert "VALID Proved: all 2 corners" in out
    verdict = {
        "outcome": "passive",
        "certificate": corners(SPRING, STABLE),
        "worst_hand": {"certificate": SPRING},
    }
    assert "corners that show different things" in told(verdict, 1)


@pytest.mark.parametrize("outcome", ["passive", "active"])
def test_the_index_of_a_port_is_no_verdict(outcome):
    """A level of −5 N·s/m says nothing of passivity, and extraction above one nothing of activity."""
    motion = {"kind": "sequence", "latent": ["1"]}
    taken = {**PORT, "kind": "extraction", "level": "-3", "motion": motion}
    del taken["proof"]
    for evidence in (PORT, taken):
        assert checker.verify(evidence).valid, checker.verify(evidence).reason
        (part,) = judge({"outcome": outcome, "certificate": evidence}).parts
        assert not part.verification.valid
        assert "is of a port" in part.verification.reason


def test_only_what_is_checked_is_shown(told):
    """A law beside the proof of a spring is no part of it: what nobody reads is refused, at any depth."""
    for added in ({"law": {"stiffness_N_per_m": "99999"}}, {"stiffness_N_per_m": "99999"}, {"note": "9"}):
        out = told({**SPRING, **added}, 1)
        assert f"NOT VALID entries that no proof of this kind has: {next(iter(added))}" in out
    deep = copy.deepcopy(DAMPED)
    deep["proof"]["norm"]["stiffness_N_per_m"] = "9"
    assert checker.verify(deep).reason.endswith(": proof.norm.stiffness_N_per_m")


def test_an_active_loop_without_a_motion(run):
    """A law that is too slow for a motion to be written down: active all the same, and the proof verifies."""
    law = "--type pulse-transfer-function --numerator 1,0 --denominator 1,-1"
    device = "--damping 900 --rate '1 kHz'"
    said = run(f"check {device} {law} --save verdict.json", 1).words
    assert "ACTIVE A hand can take any amount of energy out of this loop (a motion at" in said
    assert "No motion that shows it was found short enough to be written down." in said
    document = json.loads(Path("verdict.json").read_text(encoding="utf-8"))
    assert ("violation" in document, "witness" in document) == (True, False)
    said = run("verify verdict.json").words
    assert said.startswith(
        "VALID A hand can take any amount of energy out of the loop below, proved: the linear"
    )


def test_a_key_that_is_given_twice(refused):
    """Which of the two was proved would be the reader's guess."""
    text = json.dumps(SPRING)
    assert text.count('"delay_s"') == 1
    Path("proof.json").write_text(text.replace('"delay_s"', '"delay_s": "9", "delay_s"'), "utf-8")
    assert "'delay_s' is given twice in one object" in refused("verify proof.json")


@pytest.mark.parametrize("written", ["0_1", "٣", " 15", "1/2 ", "0x10", "1,5", "³", "1/0", "--1", ""])
def test_numbers_are_in_plain_digits(written):
    """Nothing that one reader takes for a number and another one does not."""
    found = checker.verify({**SPRING, "loop": {**SPRING["loop"], "damping_N_s_per_m": written}})
    assert not found.valid
    assert found.reason == f"loop.damping_N_s_per_m: expected a number, got {written!r}"


@pytest.mark.parametrize(
    ("key", "other"),
    [
        ("damping_N_s_per_m", "damping_N_s_per_km"),
        ("sample_period_s", "sample_period_ms"),
        ("coulomb_friction_N", "coulomb_friction_mN"),
        ("resolution_m", "resolution_um"),
    ],
)
@pytest.mark.parametrize("kind", ["storage", "coarse storage", "contact motion", "force bounding", "spring"])
def test_another_unit_is_refused(key, other, kind):
    """Every reader of a loop wants the unit that the number is taken for."""
    names = ("damping_N_s_per_m", "coulomb_friction_N", "resolution_m", "sample_period_s", "delay_s")
    loop = {**dict.fromkeys(names, "0.001"), "force_resolution_N": "0"}
    if kind == "spring":
        loop = SPRING["loop"]
    renamed = {other if k == key else k: v for k, v in loop.items()}
    found = checker.verify({"kind": kind, "loop": renamed})
    assert not found.valid
    assert "the unit of" in found.reason


def test_what_is_said_of_a_port_needs_evidence_at_that_level():
    """Passive is an input index of 0 or more, active one below 0; nothing else is taken."""
    port = {"format": "zwidth indices 1", "outcome": "passive"}
    saved = plain(zw.ports.passivity_indices(zw.PulseTransferFunction([4], [1]), PADDLE).to_dict())
    assert saved["outcome"] == "passive"
    assert [part.verification.valid for part in judge(saved).parts] == [True]
    for document in (
        {**port, "certificate": PORT},
        {**saved, "outcome": "active"},
        {**saved, "certificate": {**saved["certificate"], "level": "-1"}},
        {**saved, "format": "zwidth verdict 1"},
    ):
        assert not judge(document).valid


def test_a_document_about_a_wheel_is_told_in_degrees_too(run, refused):
    """π/180 of what is about a radian; what the document has stands before it, and no other line changes."""
    wheel = zw.rotary(damping="0.02 N*m*s/rad", rate="1 kHz")
    found = zw.check(wheel, zw.Wall("20 N*m/rad")).certificate
    Path("wheel.json").write_text(to_json(found.to_dict()), encoding="utf-8")
    plainly = run("verify wheel.json").out
    told = run("verify wheel.json --angles deg").out
    assert f"0.02 N·m·s/rad = {0.02 * math.pi / 180:.6g} N·m·s/deg" in told
    assert [line.partition(" = ")[0] for line in told.splitlines()] == plainly.splitlines()
    assert "deg, turn, rad, rpm" in refused("verify wheel.json --angles degrees")


def test_a_folder_is_no_document(refused):
    """Where `zwidth emit` wrote one, the certificate in it is meant."""
    Path("my-wall").mkdir()
    assert "my-wall: Is a directory; name the file in it" in refused("verify my-wall")
