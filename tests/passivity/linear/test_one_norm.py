"""The bound on ‖h‖₁: never below the sum of the impulse response, and close above it."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import mpmath
import pytest
from checked import loop as read_loop
from strategies import seeds

import zwidth as zw
from zwidth import checker
from zwidth.checker.document.refusal import Invalid
from zwidth.checker.loop.linear import NORM, one_norm_bound
from zwidth.passivity.certificate import certify
from zwidth.passivity.criterion_choice import Decision
from zwidth.passivity.linear.loop import linear_loop
from zwidth.passivity.linear.one_norm import _rounded, bound_one_norm
from zwidth.passivity.witness.witness import Setting


def bound_of(document, norm):
    """The bound that a norm proof gives of the loop of a document."""
    return one_norm_bound(read_loop(document), NORM.read(norm, "norm", "linear"))


def summed(loop, terms=6000):
    """Σ |h(k)| of the difference equation at 50 digits."""
    with mpmath.workdps(50):
        n, d = ([mpmath.mpf(c) for c in part] for part in (loop.numerator, loop.denominator))
        h, total = [], mpmath.mpf(0)
        for k in range(terms):
            value = n[k] if k < len(n) else mpmath.mpf(0)
            value -= sum(d[i] * h[k - i] for i in range(1, min(k, len(d) - 1) + 1))
            h.append(value / d[0])
            total += abs(h[-1])
            if k > 60 and max(abs(v) for v in h[-8:]) < total * mpmath.mpf(10) ** -40:
                break
        return total


def draw(random, low, high):
    """A decimal as a person types it."""
    return Fraction(f"{random.uniform(low, high):.4f}")


def random_law(random):
    """A wall with any estimator, a solid, or a random stable H(z)."""
    k, b = draw(random, 5, 900), draw(random, -1, 1)
    filters = [
        zw.rendering.BackwardDifference(),
        zw.rendering.Window(random.randint(2, 9)),
        zw.rendering.OnePole(draw(random, 0.001, 0.02)),
    ]
    if random.random() < 0.6:
        return zw.Wall(k, b, random.choice(filters))
    if random.random() < 0.5:
        return zw.StandardLinearSolid(k, draw(random, 5, 900), draw(random, 0.1, 3))
    r, c = draw(random, 0.1, 0.93), draw(random, -1, 1)
    return zw.PulseTransferFunction([draw(random, -9, 9) for _ in range(3)], [1, -2 * r * c, r * r])


@seeds(15)
def test_bound_holds_and_is_tight(seed):
    """‖h‖₁ ≤ bound ≤ ‖h‖₁ (1 + 1e-8); within a tenth where a slow mode is bounded by itself."""
    random = Random(seed)
    loop = linear_loop(zw.Device(damping="0.3", rate=1000), random_law(random))
    found = bound_one_norm(loop)
    assert found is not None
    with mpmath.workdps(50):
        true = summed(loop)
        bound = mpmath.mpf(found.bound.numerator) / found.bound.denominator
        loose = mpmath.mpf("0.02") if found.modes else mpmath.mpf(10) ** -8
        assert true * (1 - mpmath.mpf(10) ** -35) <= bound <= true * (1 + loose)


def test_closed_forms():
    """A spring has K, a damped wall K + 2B/T, a damped wall with negative B max(K, 2|B|/T − K)."""
    device = zw.Device(damping="0.3", sample_period="0.002")

    def norm(law):
        return bound_one_norm(linear_loop(device, law)).bound

    assert norm(zw.Wall("123.4")) == Fraction("123.4")
    assert norm(zw.Wall("123.4", "0.05")) == Fraction("123.4") + 2 * Fraction("0.05") / Fraction("0.002")
    assert norm(zw.Wall("123.4", "-0.05")) == Fraction("123.4")
    assert norm(zw.Wall("13.4", "-0.05")) == 2 * Fraction("0.05") / Fraction("0.002") - Fraction("13.4")


@pytest.mark.parametrize("denominator", [[1, -1], [1, 1], [1, "-1.01"], [1, "-0.8", 1]])
def test_no_bound_for_laws_that_do_not_decay(denominator):
    law = zw.PulseTransferFunction(["5.5", "2.5"], denominator)
    assert bound_one_norm(linear_loop(zw.Device(damping="0.3", rate=1000), law)) is None


def filtered(random, least_tau):
    """A decision about a random wall behind one pole, and its certificate."""
    filtering = zw.rendering.OnePole(draw(random, least_tau, 0.02))
    law = zw.Wall(draw(random, 5, 900), draw(random, 0.001, 1), filtering)
    loop = linear_loop(zw.Device(damping=40, rate=1000), law)
    decision = Decision(Setting(loop, Fraction(90), Fraction("0.0003"), True))
    return decision, certify(decision)


@seeds(12)
def test_checker_finds_the_same_bound(seed):
    """The checker's own arithmetic gives the same rational, and any other inverse only a larger one."""
    random = Random(seed)
    decision, document = filtered(random, 0.001)
    assert document["kind"] == "quantized"
    assert checker.verify(document).valid
    proof = document["proof"]["norm"]
    assert bound_of(document, proof) == decision.norm.bound
    true, inverse = float(summed(decision.loop)), [Fraction(c) for c in proof["inverse"]]
    for _ in range(5):
        other = list(inverse)
        other[random.randrange(len(inverse))] += inverse[0] * Fraction(random.randint(-200, 200), 1000)
        try:
            bound = bound_of(document, {**proof, "inverse": other})
        except Invalid:  # it bounds nothing, and says so
            continue
        assert float(bound) >= true * (1 - 1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_every_number_of_the_norm_proof_binds(seed):
    """Modes and rest must sum to H(z): any of their numbers changed, dropped or doubled is rejected."""
    random = Random(200 + seed)
    _, document = filtered(random, 0.01)
    proof = document["proof"]["norm"]
    broken = []
    for key in ("rest_numerator", "rest_denominator"):
        for k, value in enumerate(proof[key]):
            changed = list(proof[key])
            changed[k] = str(Fraction(value) + Fraction(random.randint(1, 99), 7))
            broken.append({**proof, key: changed})
        broken.append({**proof, key: []})
        broken.append({**proof, key: ["0"]})
    for k, mode in enumerate(proof["modes"]):
        rest = proof["modes"][:k] + proof["modes"][k + 1 :]
        for key in mode:
            changed = {**mode, key: str(Fraction(mode[key]) * Fraction("1.01"))}
            broken.append({**proof, "modes": [*rest, changed]})
        broken += [{**proof, "modes": rest}, {**proof, "modes": [*proof["modes"], mode]}]
    broken.append({**proof, "rest_numerator": ["0"], "rest_denominator": ["0"], "modes": []})
    for norm in broken:
        with pytest.raises(Invalid):
            bound_of(document, norm)


def test_whole_numbers_are_rounded_as_fractions_are():
    """To the nearest, of two the even one, with either sign."""
    for top in range(-60, 61):
        for bottom in (-7, -6, -4, -3, -2, -1, 1, 2, 3, 4, 6, 7):
            assert _rounded(top, bottom) == round(Fraction(top, bottom)), (top, bottom)
