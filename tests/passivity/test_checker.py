"""The checker against tampering, against plain simulations, and against broken documents."""

from __future__ import annotations

import copy
import json
from contextlib import suppress
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from random import Random

import numpy as np
import plain_loop
import pytest
from scipy.optimize import minimize_scalar
from tampered import tampered

import zwidth as zw
from zwidth import checker
from zwidth.passivity.certificate import read_document, verify_document
from zwidth.passivity.linear.loop import linear_loop
from zwidth.passivity.witness.motion import Motion, Pattern, Repeat, realize
from zwidth.passivity.witness.witness import Setting
from zwidth.quantity.text import to_json

DEVICE = zw.Device(
    damping="0.45", coulomb_friction="0.13", resolution="0.0004", sample_period="0.001", delay="0.0013"
)
IDEAL = DEVICE.replace(resolution=0, coulomb_friction=0)
LOSSLESS = zw.PulseTransferFunction(["48", "-168", "120"], ["1", "-0.8", "1"])  # 120 (z − 1)(0.4 z − 1)


def evidence():
    """A passive or an active loop of each kind, with its document."""
    filtered = zw.Wall("90", "0.03", zw.rendering.OnePole("0.004"))
    loops = {
        "spring": (DEVICE, zw.Wall("170")),
        "linear": (IDEAL, filtered),
        "linear without delay": (IDEAL.replace(delay=0), zw.Wall("210", "0.4", zw.rendering.Window(2))),
        "contact": (DEVICE.replace(delay="0.001"), zw.Wall("180", "0.04", zw.rendering.Window(2))),
        "contact, one pole": (DEVICE.replace(delay=0), zw.Wall("400", "-0.1", zw.rendering.OnePole("0.004"))),
        "closed loop": (IDEAL.replace(delay=0, damping="0.2"), LOSSLESS),
        "quantized": (DEVICE, filtered),
        "press": (DEVICE, zw.Wall("900")),
        "motion": (IDEAL, zw.Wall("480", "0.03", zw.rendering.OnePole("0.004"))),
        "whole delay": (DEVICE.replace(delay="0.002"), zw.Wall("230")),
        "straddle": (DEVICE.replace(coulomb_friction="0.02"), zw.Wall("150")),
    }
    documents = {}
    for name, (device, law) in loops.items():
        verdict = zw.check(device, law)
        found = verdict.certificate or verdict.witness
        assert found is not None, (name, verdict.claim)
        documents[name] = found.to_dict()
    return documents


DOCUMENTS = evidence()
MOTIONS = [name for name, document in DOCUMENTS.items() if document["kind"] == "motion"]
PROOFS = [name for name in DOCUMENTS if name not in MOTIONS]


def places(value, path=()):
    """Every place of a document, lists and objects too."""
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from places(inner, (*path, key))


def at(document, path):
    for key in path:
        document = document[key]
    return document


def numbers(document, most=40):
    """Some of the places of numbers, the same each time."""
    found = []
    for path in places(document):
        with suppress(TypeError, ValueError):
            if not isinstance(at(document, path), bool) and Fraction(at(document, path)) is not None:
                found.append(path)
    return found if len(found) <= most else Random(most).sample(found, most)


def quantity(document, name):
    return next(Fraction(v) for k, v in document["loop"].items() if k.startswith(name))


def loop_of(document):
    """What `plain_loop.energy_out` wants to know of a document's loop."""
    period = quantity(document, "sample_period")
    whole, part = divmod(quantity(document, "delay") / period, 1)
    return {
        "damping": quantity(document, "damping"),
        "friction": quantity(document, "coulomb_friction"),
        "period": period,
        "resolution": quantity(document, "resolution"),
        "whole": int(whole),
        "part": part,
        "unilateral": document["loop"]["unilateral"],
    }


def law_of(document):
    return tuple([Fraction(c) for c in document["loop"][key]] for key in ("numerator", "denominator"))


def expanded(document):
    """Positions and switch positions with every round of every repeat listed."""
    x, y = (tuple(map(Fraction, document.get(key, []))) for key in ("positions_m", "switch_positions_m"))
    rounds = tuple(Repeat(part["first"], part["last"], part["times"]) for part in document.get("repeats", []))
    motion = Motion(x, y, rounds).listed()
    return motion.positions, motion.switch_positions or None


def criterion_holds(document):
    """b on 4000 frequencies and stability by numpy: is the loop of a proof passive, to rounding?"""
    loop, (n, d) = loop_of(document), ([float(c) for c in part] for part in law_of(document))
    theta = np.linspace(1e-3, np.pi, 4001)
    z = np.exp(1j * theta)
    h = np.polyval(n, z) / np.polyval(d, z)
    alpha, t = float(loop["part"]), float(loop["period"])
    late = z ** -float(loop["whole"]) * (1 - alpha + alpha / z) * h
    a = t / 2 * ((1 - 1 / z) * late).real / (1 - np.cos(theta))
    need = (a + np.sqrt(a * a + t * t * alpha * (1 - alpha) * abs(h) ** 2)) / 2
    return need.max() <= float(loop["damping"]) * (1 + 1e-6) and sum(n) * sum(d) >= 0


def friction_holds(document):
    """f_c ≥ ‖h‖₁ Δ/2 by summing the impulse response."""
    n, d = law_of(document)
    h = plain_loop.forces([float(c) for c in n], [float(c) for c in d], [1.0] + [0.0] * 400)
    return float(quantity(document, "coulomb_friction")) * 2 >= sum(map(abs, h)) * float(
        quantity(document, "resolution")
    ) * (1 - 1e-9)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no device without end")
def test_what_says_nothing_of_its_size_is_not_read_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """A device has size 0 and gives bytes for ever."""
    monkeypatch.setattr("zwidth.checker.document.file.LARGEST_FILE", 1000)
    with pytest.raises(zw.InputError, match="larger than 1000 bytes"):
        read_document("/dev/zero")


@pytest.mark.parametrize("name", DOCUMENTS)
def test_documents_survive_json(name, tmp_path):
    path = tmp_path / "evidence.json"
    path.write_text(to_json(DOCUMENTS[name]), encoding="utf-8")
    read = read_document(path)
    assert verify_document(read).valid
    plain = json.loads(path.read_text(encoding="utf-8"))
    assert verify_document(plain).valid
    assert verify_document(read).energy == checker.verify(DOCUMENTS[name]).energy


CHANGES = [
    lambda v: str(Fraction(v) * Fraction("1.37")),
    lambda v: str(Fraction(v) * Fraction("0.61")),
    lambda v: str(-Fraction(v) - Fraction(1, 777)),
    lambda v: str(Fraction(v) + 1),
]


@pytest.mark.parametrize("name", PROOFS)
def test_tampered_proofs(name):
    """Any number of a proof changed: rejected, or the loop it then speaks of is passive all the same."""
    document = DOCUMENTS[name]
    for path in numbers(document):
        for change in CHANGES:
            other = tampered(document, path, change(at(document, path)))
            if checker.verify(other).valid:
                assert criterion_holds(other), path
                assert friction_holds(other) or quantity(other, "resolution") == 0, path


@pytest.mark.parametrize("name", [n for n in PROOFS if "proof" in DOCUMENTS[n]])
def test_proof_numbers_bind(name):
    document = DOCUMENTS[name]
    for part in ("factor", "square"):
        values = document["proof"]["positivity"][part]
        for k, value in enumerate(values):
            other = tampered(document, ("proof", "positivity", part, k), str(Fraction(value) + 1))
            assert checker.verify(other).valid is (len(values) == 1 and Fraction(value) + 1 > 0)


@pytest.mark.parametrize("name", PROOFS)
def test_shortened_lists(name):
    """A list with its first or last entry dropped is rejected, unless what is left is true."""
    document = DOCUMENTS[name]
    for path in places(document):
        if isinstance(value := at(document, path), list):
            for cut in (value[1:], value[:-1], [], [*value, "1"]):
                other = tampered(document, path, cut)
                assert not checker.verify(other).valid or criterion_holds(other), path


@pytest.mark.parametrize("name", PROOFS)
def test_swapped_kinds(name):
    honest = DOCUMENTS[name]["kind"]
    for kind in ("spring", "contact", "linear", "quantized", "motion", "corners", "", None, 3):
        other = {**DOCUMENTS[name], "kind": kind}
        if checker.verify(other).valid:
            assert kind == honest or (kind == "linear" and quantity(other, "resolution") == 0)


@pytest.mark.parametrize("name", MOTIONS)
def test_tampered_motions(name):
    """Any number of a motion changed: rejected, or the energy claimed is what a plain simulation finds."""
    small = copy.deepcopy(DOCUMENTS[name])
    for part in small.get("repeats", []):
        part["times"] = min(part["times"], 7)
    for path in numbers(small, 16):
        for change in CHANGES[:3]:
            other = tampered(small, path, change(at(small, path)))
            found = checker.verify(other)
            if found.energy is None:
                continue
            other["repeats"] = [{k: int(v) for k, v in r.items()} for r in other.get("repeats", [])]
            x, y = expanded(other)
            energy = plain_loop.energy_out(law_of(other), x, switches=y, **loop_of(other))
            assert found.energy == energy, path
            close = abs(Fraction(other["energy_J"]) - found.energy) <= abs(found.energy) / 10**9
            periods = {Fraction(table["sample_period_s"]) for table in (other, other["loop"])}
            assert found.valid is (found.energy > 0 and close and len(periods) == 1)


@pytest.mark.parametrize("name", MOTIONS)
def test_another_energy_and_another_number_of_rounds_are_refused(name):
    document = DOCUMENTS[name]
    energy = Fraction(document["energy_J"])
    changes = [(("energy_J",), energy * Fraction(factor)) for factor in ("1.0000001", "0.9999999", "-1", "0")]
    for k, part in enumerate(document.get("repeats", [])):
        changes += [(("repeats", k, "times"), part["times"] + step) for step in (1, -1)]
    for path, value in changes:
        assert not checker.verify(tampered(document, path, value)).valid, path


KNOWN_HAND = {
    "mass_kg": ["0.05", "0.07"], "damping_N_s_per_m": "0.7", "stiffness_N_per_m": "350",
    "sample_period_s": "0.001", "delay_s": "0.0004", "numerator": ["1200", "-400"], "denominator": ["1", "0"],
}  # fmt: skip
SHAKEN = {"numerator": ["2", "0.92"], "denominator": ["1", "-0.5", "0"]}
VIBRATION = {
    "kind": "vibration",
    "plant": SHAKEN,
    "slope": "0.92",
    "gap": "-1",
    "inside": [True, False, False],
}
WHOLE = {
    **{k: DOCUMENTS[k] for k in ("spring", "contact", "linear", "quantized", "press", "closed loop")},
    "stability": {"kind": "stability", "loop": KNOWN_HAND},
    "instability": {
        "kind": "instability", "loop": {**KNOWN_HAND, "mass_kg": "0.05", "numerator": ["99000", "-400"]}
    },
    "vibration": VIBRATION,
}  # fmt: skip
ABSURD = [
    "1e4000", "-1e-4000", "0", "1/0", "", "nan", "0x10", "1/2/3", None, True, [], {}, [7], 10**300, -1, 0.5,
    ["1", "0"], ["0", "1e9"], Decimal("sNaN"), {"damping": "1", "damping_N_s_per_m": "1"},
]  # fmt: skip


@pytest.mark.parametrize("name", WHOLE)
def test_whatever_stands_in_one_place_is_foreseen(name):
    """Accepted whole; with anything in any place the checker says what is wrong, and does not stumble."""
    assert checker.verify(WHOLE[name]).valid
    for path in places(WHOLE[name]):
        for value in ABSURD:
            assert checker.STOPPED not in checker.verify(tampered(WHOLE[name], path, value)).reason, path


@pytest.mark.parametrize("document", [None, [], 7, "text", {}, {"kind": []}, {"kind": "corners"}])
def test_what_is_no_document(document):
    assert not checker.verify(document).valid
    with pytest.raises(zw.InputError):
        verify_document(document if not isinstance(document, dict) or not document else [])


@pytest.mark.parametrize("seed", range(6))
def test_switch_positions_are_the_best(seed):
    """Where the hand waits for a force that changes inside a sample is where a numerical search puts it."""
    random = Random(seed)
    device = zw.Device(damping="0.23", rate=1000, delay=Fraction(random.randint(1, 2999), 10**6))
    loop = linear_loop(device, zw.Wall(410, "0.05", zw.rendering.OnePole("0.002")))
    w = (0, *(random.randint(-9, 9) for _ in range(6)))
    motion = realize(loop, Pattern(w, ()), Fraction(1, 1000), Fraction(0), 1)
    setting = Setting(loop, Fraction(0), Fraction(0), False)
    best = setting.energy(motion)
    for k in range(len(motion.switch_positions)):

        def lost(y, k=k):
            switches = list(motion.switch_positions)
            switches[k] = Fraction(y)
            return -float(setting.energy(Motion(motion.positions, tuple(switches))))

        found = minimize_scalar(lost, bounds=(-1, 1), method="bounded", options={"xatol": 1e-10})
        assert -float(best) <= found.fun + 1e-9 * abs(float(best))
        assert found.x == pytest.approx(float(motion.switch_positions[k]), abs=1e-5)


def test_rounds_that_back_out_of_a_wall_with_memory():
    """Backing out count by count is judged alike with rounds and with every round listed: not in count 0."""
    law = zw.PulseTransferFunction([25, -11], [1, 0])
    loop = linear_loop(zw.Device(damping="0.31", rate=500), law)
    setting = Setting(loop, Fraction("0.02"), Fraction(1, 1000), True)
    third = Fraction(1, 3000)
    x = [Fraction(0), *[Fraction(20, 1000) + third] * 4, *[Fraction(19, 1000) + third] * 4]
    document = setting.document(Motion(tuple(x)), Fraction(1))
    document["repeats"] = [{"first": 4, "last": 8, "times": 20}]
    listed = setting.document(Motion(tuple(expanded(document)[0])), Fraction(1))
    assert checker.verify(document).energy == checker.verify(listed).energy


def test_law_with_memory_is_not_judged_outside():
    """A wall with a velocity filter has no defined force once the hand has left: no such motion."""
    loop = linear_loop(IDEAL.replace(delay=0), zw.Wall(300, "0.1"))
    setting = Setting(loop, Fraction(0), Fraction(0), True)
    x = tuple(Fraction(v, 1000) for v in (0, 3, -2, 4, 0))
    assert setting.energy(Motion(x)) is None


@pytest.mark.parametrize("name", ["whole delay", "linear without delay"])
def test_absurd_delay_is_rejected(name):
    """A delay of ten thousand million samples is an answer: no memory error."""
    assert not checker.verify(tampered(DOCUMENTS[name], ("loop", "delay_s"), "1e9")).valid


@pytest.mark.parametrize("key", ["corners", "certificate"])
def test_deeply_nested_documents(key):
    document = DOCUMENTS["spring"]
    for _ in range(5000):
        document = {"kind": "corners", "corners": [document]} if key == "corners" else {key: document}
    with suppress(zw.InputError):
        assert not verify_document(document).valid
