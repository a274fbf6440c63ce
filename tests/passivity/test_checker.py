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
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar
from strategies import seeds

import zwidth as zw
from zwidth import checker
from zwidth.passivity.certificate import read_document, verify_document
from zwidth.passivity.linear.loop import linear_loop
from zwidth.passivity.witness.motion import Motion, Pattern, realize
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


def leaves(document, path=()):
    """Every place in a document that holds a number, text or truth value."""
    items = document.items() if isinstance(document, dict) else enumerate(document)
    for key, value in items:
        if isinstance(value, (dict, list)):
            yield from leaves(value, (*path, key))
        else:
            yield (*path, key)


def lists(document, path=()):
    """Every list in a document."""
    items = document.items() if isinstance(document, dict) else enumerate(document)
    for key, value in items:
        if isinstance(value, list):
            yield (*path, key)
        if isinstance(value, (dict, list)):
            yield from lists(value, (*path, key))


def put(document, path, change):
    """A copy of the document with one place changed."""
    changed = copy.deepcopy(document)
    inner = changed
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = change(inner[path[-1]])
    return changed


def rational(value):
    """A number of a document."""
    return Fraction(value)


def quantity(document, name):
    """A number of the loop, whatever unit its key has."""
    return next(rational(v) for k, v in document["loop"].items() if k.startswith(name))


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
    """Numerator and denominator, descending."""
    return tuple([rational(c) for c in document["loop"][key]] for key in ("numerator", "denominator"))


def expanded(document):
    """Positions and switch positions with every round of every repeat listed."""
    x = [rational(v) for v in document["positions_m"]]
    y = [rational(v) for v in document.get("switch_positions_m", [])]
    out_x, out_y, ahead, at = [], [], Fraction(0), 0
    for part in document.get("repeats", []):
        first, last, times = part["first"], part["last"], part["times"]
        out_x += [v + ahead for v in x[at:first]]
        out_y += [v + ahead for v in y[at:first]]
        for turn in range(times):
            out_x += [v + ahead for v in x[first:last]]
            out_y += [v + ahead for v in y[first:last]]
            if turn < times - 1:
                ahead += x[last] - x[first]
        at = last
    out_x += [v + ahead for v in x[at:]]
    out_y += [v + ahead for v in y[at:]]
    return out_x, out_y or None


def independent_energy(document):
    """The energy of a motion by the plain simulation, in Fractions."""
    x, y = expanded(document)
    return plain_loop.energy_out(law_of(document), x, switches=y, **loop_of(document))


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


@pytest.mark.parametrize("name", DOCUMENTS)
def test_honest_documents_are_accepted(name):
    """What the prover wrote is accepted as it stands."""
    assert checker.verify(DOCUMENTS[name]).valid


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no device without end")
def test_what_says_nothing_of_its_size_is_not_read_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """A device has size 0 and gives bytes for ever."""
    monkeypatch.setattr("zwidth.checker.document.file.LARGEST_FILE", 1000)
    with pytest.raises(zw.InputError, match="larger than 1000 bytes"):
        read_document("/dev/zero")


@pytest.mark.parametrize("name", DOCUMENTS)
def test_documents_survive_json(name, tmp_path):
    """Written as JSON and read again, a document means the same and is accepted."""
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


def is_number(document, path):
    """True where a place holds a number that can be changed."""
    value = document
    for key in path:
        value = value[key]
    try:
        return not isinstance(value, bool) and Fraction(value) is not None
    except ValueError:
        return False


def few(places, most=40):
    """Some of many places, the same each time."""
    places = list(places)
    return places if len(places) <= most else Random(most).sample(places, most)


@pytest.mark.parametrize("name", PROOFS)
def test_tampered_proofs(name):
    """Any number of a proof changed: rejected, or the loop it then speaks of is passive all the same."""
    document = DOCUMENTS[name]
    for path in few(p for p in leaves(document) if is_number(document, p)):
        for change in CHANGES:
            tampered = put(document, path, change)
            if checker.verify(tampered).valid:
                assert criterion_holds(tampered), path
                assert friction_holds(tampered) or quantity(tampered, "resolution") == 0, path


@pytest.mark.parametrize("name", [n for n in PROOFS if "proof" in DOCUMENTS[n]])
def test_proof_numbers_bind(name):
    """Each coefficient of the factor and the square is needed: a different one is rejected."""
    document = DOCUMENTS[name]
    for part in ("factor", "square"):
        for k, value in enumerate(document["proof"]["positivity"][part]):
            path = ("proof", "positivity", part, k)
            tampered = put(document, path, lambda v: str(Fraction(v) + 1))
            alone = len(document["proof"]["positivity"][part]) == 1 and Fraction(value) + 1 > 0
            assert checker.verify(tampered).valid is alone


@pytest.mark.parametrize("name", PROOFS)
def test_shortened_lists(name):
    """A list with its first or last entry dropped is rejected, unless what is left is true."""
    document = DOCUMENTS[name]
    for path in lists(document):
        for cut in (lambda v: v[1:], lambda v: v[:-1], lambda v: [], lambda v: [*v, "1"]):
            tampered = put(document, path, cut)
            if checker.verify(tampered).valid:
                assert criterion_holds(tampered), path


@pytest.mark.parametrize("name", PROOFS)
@pytest.mark.parametrize(
    "kind", ["spring", "contact", "linear", "quantized", "motion", "corners", "", None, 3]
)
def test_swapped_kinds(name, kind):
    """A proof of one kind does not pass for another, unless it proves that too."""
    tampered = put(DOCUMENTS[name], ("kind",), lambda _: kind)
    if checker.verify(tampered).valid:
        honest = DOCUMENTS[name]["kind"]
        assert kind == honest or (kind == "linear" and quantity(tampered, "resolution") == 0)


def test_linear_proof_does_not_cover_an_encoder():
    """A proof for an ideal sensor is rejected once the loop has a resolution."""
    tampered = put(DOCUMENTS["linear"], ("loop", "resolution_m"), lambda _: "0.0001")
    assert not checker.verify(tampered).valid


def test_closed_loop_proof_needs_coprime_whole_samples():
    """A lossless law's proof falls with a broken delay, a common factor, a sign or a bad offset."""
    document = DOCUMENTS["closed loop"]
    assert document["proof"]["stability"]["kind"] == "closed loop"
    assert not checker.verify(put(document, ("loop", "delay_s"), lambda _: "0.0001")).valid
    assert not checker.verify(put(document, ("proof", "stability", "offset"), lambda _: "-1")).valid
    assert not checker.verify(put(document, ("proof", "stability", "offset"), lambda _: "0")).valid
    assert not checker.verify(put(document, ("proof", "stability", "kind"), lambda _: "open loop")).valid
    common = copy.deepcopy(document)
    for key in ("numerator", "denominator"):
        c = [Fraction(v) for v in document["loop"][key]]
        common["loop"][key] = [str(a - 2 * b) for a, b in zip([*c, 0], [0, *c], strict=True)]
    assert not checker.verify(common).valid


@pytest.mark.parametrize("name", MOTIONS)
def test_tampered_motions(name):
    """Any number of a motion changed: rejected, or the energy claimed is what a plain simulation finds."""
    document = DOCUMENTS[name]
    small = put(document, ("energy_J",), lambda v: v)
    for part in small.get("repeats", []):
        part["times"] = min(part["times"], 7)
    for path in few((p for p in leaves(small) if is_number(small, p)), 16):
        for change in CHANGES[:3]:
            tampered = put(small, path, change)
            found = checker.verify(tampered)
            if found.energy is None:
                continue
            tampered["repeats"] = [{k: int(v) for k, v in r.items()} for r in tampered.get("repeats", [])]
            assert found.energy == independent_energy(tampered), path
            claimed = rational(tampered["energy_J"])
            close = abs(claimed - found.energy) <= abs(found.energy) / 10**9
            periods = {rational(table["sample_period_s"]) for table in (tampered, tampered["loop"])}
            assert found.valid is (found.energy > 0 and close and len(periods) == 1)


@pytest.mark.parametrize("name", MOTIONS)
def test_exaggerated_energy(name):
    """A claim of a little more or less energy than the motion extracts is rejected."""
    for factor in (Fraction("1.0000001"), Fraction("0.9999999"), Fraction(-1), Fraction(0)):
        assert not checker.verify(
            put(DOCUMENTS[name], ("energy_J",), lambda v, f=factor: f * Fraction(v))
        ).valid


@pytest.mark.parametrize("name", MOTIONS)
def test_other_numbers_of_rounds(name):
    """With one round fewer or more the energy claimed is wrong."""
    document = DOCUMENTS[name]
    for k in range(len(document.get("repeats", []))):
        for step in (1, -1):
            tampered = put(document, ("repeats", k, "times"), lambda t, s=step: t + s)
            assert not checker.verify(tampered).valid


@pytest.mark.parametrize("name", ["spring", "contact", "linear", "quantized", "press", "straddle"])
def test_missing_keys(name):
    """Without any one of its keys a document is rejected, never an error; repeats and the label apart."""
    document = DOCUMENTS[name]
    places = [(k,) for k in document] + [("loop", k) for k in document["loop"]]
    for *outer, key in places:
        tampered = copy.deepcopy(document)
        inner = tampered
        for k in outer:
            inner = inner[k]
        del inner[key]
        if key not in ("format", "sample_period_s", "repeats") or outer:
            assert not checker.verify(tampered).valid, key


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
    | st.sampled_from(["1/0", "nan", "1e9999999", "inf", "0x10", "--1", "1/2/3", Decimal("sNaN"), 10**50]),
    lambda inner: st.lists(inner, max_size=4)
    | st.dictionaries(st.sampled_from(["kind", "loop", "proof", "first", "times"]), inner, max_size=4),
    max_leaves=10,
)  # fmt: skip


@settings(max_examples=100, deadline=None)
@given(st.data())
def test_malformed_documents_never_raise(data):
    """Any place of a document replaced by any JSON: an answer, not an exception."""
    document = DOCUMENTS[
        data.draw(st.sampled_from(["spring", "contact", "linear", "quantized", "press", "closed loop"]))
    ]
    places = [p for p in [*leaves(document), *lists(document)] if "delay_s" not in p]
    places += [("loop",), ("kind",), *([("proof",), ("proof", "positivity")] if "proof" in document else [])]
    tampered = put(document, data.draw(st.sampled_from(places)), lambda _: data.draw(JSON))
    verification = checker.verify(tampered)
    assert isinstance(verification.reason, str)


@pytest.mark.parametrize("loop", [None, [], "text", 3, {}, {"damping": "1", "damping_N_s_per_m": "1"}, [7]])
@pytest.mark.parametrize("name", ["spring", "contact", "linear", "press"])
def test_malformed_loops_never_raise(name, loop):
    """What stands for the loop may be anything: the document is rejected."""
    assert not checker.verify(put(DOCUMENTS[name], ("loop",), lambda _: loop)).valid


@pytest.mark.parametrize("document", [None, [], 7, "text", {}, {"kind": []}, {"kind": "corners"}])
def test_what_is_no_document(document):
    """Anything but a document is one input error or a rejection."""
    assert not checker.verify(document).valid
    with pytest.raises(zw.InputError):
        verify_document(document if not isinstance(document, dict) or not document else [])


def random_setting(random, unilateral=False):
    """A loop of every feature at once, its plain description and a law whose forces settle exactly."""
    law = random.choice([([37], [1]), ([25, -11, 7], [1, 0, 0]), ([9, -4], [2, 0])])
    device = zw.Device(
        damping=Fraction(random.randint(1, 90), 100),
        coulomb_friction=Fraction(random.randint(0, 30), 100),
        resolution=random.choice([Fraction(0), Fraction(3, 1000), Fraction(1, 700)]),
        sample_period=Fraction(1, 500),
        delay=random.choice([0, "0.002", "0.005", "0.0007", "0.00431"]),
    )
    loop = linear_loop(device, zw.PulseTransferFunction(*law))
    friction, resolution = device.exact("coulomb_friction"), device.exact("resolution")
    return law, Setting(loop, friction, resolution, unilateral)


def plain_energy(law, setting, x, y, kind=Fraction):
    """The plain simulation's energy for a setting."""
    loop = setting.loop
    return plain_loop.energy_out(
        tuple([kind(c) for c in part] for part in law),
        [kind(v) for v in x],
        damping=kind(loop.damping),
        friction=kind(setting.coulomb_friction),
        period=kind(loop.period),
        resolution=kind(setting.resolution) if setting.resolution else 0,
        whole=loop.whole_delay,
        part=kind(loop.part_delay) if loop.part_delay else 0,
        switches=[kind(v) for v in y] if y else None,
        unilateral=setting.unilateral,
    )


@seeds(20)
def test_energy_against_plain_simulation(seed):
    """Random motions: the same joules in Fractions exactly, in floats to rounding."""
    random = Random(seed)
    law, setting = random_setting(random)
    x = [Fraction(0)] + [Fraction(random.randint(-4000, 4000), 100000) for _ in range(random.randint(1, 25))]
    y = [a + Fraction(random.randint(-900, 900), 10**5) for a in x[1:]] if setting.loop.part_delay else []
    energy = setting.energy(Motion(tuple(x), tuple(y)))
    assert energy == plain_energy(law, setting, x, y)
    if setting.resolution == 0:
        assert float(energy) == pytest.approx(plain_energy(law, setting, x, y, float), rel=1e-9, abs=1e-12)


@seeds(15)
def test_wall_against_plain_simulation(seed):
    """A one-sided spring, in and out at will: the same joules."""
    random = Random(300 + seed)
    _, setting = random_setting(random, True)
    k = random.randint(20, 900)
    loop = linear_loop(zw.Device(damping=setting.loop.damping, rate=500), zw.Wall(k))
    setting = Setting(loop, setting.coulomb_friction, setting.resolution, True)
    x = [Fraction(-random.randint(0, 50), 10**4)]
    x += [Fraction(random.randint(-4000, 4000), 10**5) for _ in range(12)]
    assert setting.energy(Motion(tuple(x))) == plain_energy(([k], [1]), setting, x, [])


@seeds(20)
def test_repeats_against_listing_every_round(seed):
    """Repeated parts, closed or advancing, one or several: the same joules as with every round listed."""
    random = Random(600 + seed)
    law, setting = random_setting(random)
    size = random.randint(8, 20)
    x = [Fraction(0)] + [Fraction(random.randint(0, 4000), 10**5) for _ in range(size)]
    cuts = sorted(random.sample(range(1, size + 1), 4))
    repeats = []
    for first, last in (cuts[:2], cuts[2:]):
        if random.random() < 0.5:
            x[last] = x[first]
        elif setting.resolution:
            x[last] = x[first] + setting.resolution * random.randint(-3, 5)
        repeats.append({"first": first, "last": last, "times": random.randint(1, 30)})
    y = [a + Fraction(random.randint(-900, 900), 10**5) for a in x[1:]] if setting.loop.part_delay else []
    document = setting.document(Motion(tuple(x), tuple(y)), Fraction(1))
    document["repeats"] = repeats
    energy = checker.verify(document).energy
    assert energy == plain_energy(law, setting, *(expanded(document)))


@seeds(15)
def test_advancing_rounds_behind_a_surface(seed):
    """A ratchet into or out of a one-sided spring, through the surface too: as with every round listed."""
    random = Random(900 + seed)
    _, setting = random_setting(random, True)
    k, step = random.randint(20, 900), setting.resolution or Fraction(1, 1000)
    device = zw.Device(damping="0.31", rate=500, delay=random.choice([0, "0.002", "0.0031"]))
    setting = Setting(linear_loop(device, zw.Wall(k)), Fraction("0.02"), setting.resolution, True)
    start = Fraction(random.randint(-20, 200), 10**3)
    x = [Fraction(0), start, start + step / 3, start + random.choice([-2, -1, 1, 2]) * step, Fraction(0)]
    y = [a + step / 7 for a in x[1:]] if setting.loop.part_delay else []
    document = setting.document(Motion(tuple(x), tuple(y)), Fraction(1))
    document["repeats"] = [{"first": 1, "last": 3, "times": random.randint(2, 120)}]
    assert checker.verify(document).energy == plain_energy(([k], [1]), setting, *expanded(document))


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


def test_motion_must_start_at_rest_outside():
    """A motion that starts inside the wall, or with the spring tensed, is no witness."""
    wall = put(DOCUMENTS["press"], ("positions_m", 0), lambda _: "0.0001")
    assert not checker.verify(wall).valid
    _, setting = random_setting(Random(1))
    assert setting.energy(Motion((Fraction(1, 10), Fraction(0)))) is None


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


@pytest.mark.parametrize("kind", ["motion", "linear"])
@pytest.mark.parametrize("delay", ["1e9"])
def test_absurd_delay_is_rejected(kind, delay):
    """A delay of ten thousand million samples, or of more, is an answer: no memory error."""
    name = {"motion": "whole delay", "linear": "linear without delay"}[kind]
    assert not checker.verify(put(DOCUMENTS[name], ("loop", "delay_s"), lambda _: delay)).valid


@pytest.mark.parametrize("key", ["corners", "certificate"])
def test_deeply_nested_documents(key):
    """A document inside a document, thousands deep, is an input error or a rejection."""
    document = DOCUMENTS["spring"]
    for _ in range(5000):
        document = {"kind": "corners", "corners": [document]} if key == "corners" else {key: document}
    with suppress(zw.InputError):
        assert not verify_document(document).valid
