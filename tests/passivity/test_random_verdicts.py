"""The referee of `benchmarks/random_verdicts.py`: it knows the loops that it judges, and it can say no."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import plain_loop
import pytest


@pytest.fixture(autouse=True)
def _benchmarks(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "benchmarks"))


def _solid(**changes):
    """f = 700 u + 200 (1 − ζ)/(1 − 0.8 ζ) u, fed with the penetration."""
    from attack.referee import PlainLoop

    numbers = {
        "damping": Fraction("0.3"), "friction": Fraction("0.02"), "period": Fraction("0.001"),
        "resolution": Fraction("1e-5"), "delay": Fraction("0.0013"),
    }  # fmt: skip
    law = (Fraction(900), Fraction(-760)), (Fraction(1), Fraction("-0.8"))
    return PlainLoop(*law, "penetration", False, **{**numbers, **changes})


def test_it_takes_the_same_energy_out_as_rational_arithmetic():
    """A motion inside, an encoder, a delay of 1.3 samples: the ball holds the exact number."""
    from attack.referee import differs, energies

    loop, rng = _solid(), np.random.default_rng(3)
    x = [Fraction(0), *(Fraction(int(n), 10**6) for n in rng.integers(10, 4000, 30))]
    y = [a + Fraction("0.4") * (b - a) for a, b in zip(x, x[1:], strict=False)]
    law = [900, -760], [1, Fraction("-0.8")]
    exact = plain_loop.energy_out(
        law, x, damping=loop.damping, friction=loop.friction, period=loop.period, resolution=loop.resolution,
        whole=1, part=Fraction("0.3"), switches=y, unilateral=True,
    )  # fmt: skip
    out = energies(loop, x, y)[-1]
    assert not differs(out, exact)
    assert differs(out, exact + abs(exact) / 10**25)
    assert not differs(out, exact - abs(exact) / 10**25)
    assert differs(out, exact - abs(exact) / 10**14)
    assert energies(loop, x)[-1] >= out  # left to itself, the hand does at least as well inside samples


def test_the_criterion_is_that_of_a_standard_linear_solid():
    """b ≥ K T/2 + g T/(1 + p), at the Nyquist frequency: enclosed, and violated just below."""
    from attack.referee import needed, needed_at, violated

    limit = Fraction(700, 2000) + Fraction(200, 1000) / Fraction("1.8")
    loop = _solid(delay=Fraction(0), resolution=Fraction(0), damping=limit * (1 - Fraction(1, 10**12)))
    asked, angle = needed(loop)
    assert asked == pytest.approx(float(limit), rel=1e-14)
    assert abs(float(needed_at(loop, np.pi)) - float(limit)) < 1e-16
    assert violated(loop, angle)
    assert not violated(_solid(delay=Fraction(0), resolution=Fraction(0), damping=limit), angle)


def test_a_wall_fed_with_the_position_gives_energy_to_a_hand_that_touches_and_leaves():
    """K = 10, B = 0.3 behind one pole of 10 ms, b = 0.025, where the criterion asks for 0.0193."""
    from attack.referee import PlainLoop, energies, needed

    pole, gain = Fraction(10, 11), Fraction(300, 11)
    law = (10 + gain, -10 * pole - gain), (Fraction(1), -pole)
    loop = PlainLoop(*law, "position", False, Fraction("0.025"), Fraction(0), Fraction("0.001"))
    assert needed(loop)[0] < 0.02
    run_up = [Fraction(0)]
    for k in range(30):
        run_up.insert(0, run_up[0] - pole**k / 1000)
    x = [v + Fraction(1, 10**9) for v in run_up]
    assert energies(loop, [*x, Fraction(-3, 1000)])[-1] > 0
    inside = [Fraction(0), *(v - x[0] + 1 for v in [*x, Fraction(-3, 1000)])]
    assert energies(loop, inside)[-1] < 0


def test_a_start_that_fades_slowly_is_no_gain_of_every_round():
    """A pole at −0.999996 gives back what it took at the start for 270 000 samples: no refutation."""
    from attack.motions import Found, refutes
    from attack.referee import PlainLoop, energies

    law = (Fraction("0.157947"), Fraction("-0.0607235")), (Fraction(1), Fraction("0.9999962771479166"))
    damping, friction, period = Fraction("15.7005011804"), Fraction("0.000617"), Fraction("0.00066")
    loop = PlainLoop(*law, "both", False, damping, friction, period, delay=Fraction("0.0014454"))
    near, far = Fraction("0.11683501039871909"), Fraction("0.11683514838867086")
    x = (Fraction(0), *((far, near) * 6))
    out = [float(v) for v in energies(loop, x)]
    assert out[0] > out[-1] > out[-3] > out[-5]  # 325 J went in, and every round gives a little back
    assert not refutes(loop, Found(1, x, 2, Fraction(0)), kept=False)


def test_what_the_referee_is_told_of_a_law_is_what_the_package_renders():
    """H(z) by the referee's formulas and by the package's."""
    from attack import loops

    for seed in range(60):
        rng = np.random.default_rng(seed)
        case = loops.KINDS[("contact", "counts", "rotary")[seed % 3]](rng)
        h = case.law.pulse_transfer_function(case.loop.period)
        z = Fraction(7, 5)
        value = _at(case.loop.numerator, 1 / z) / _at(case.loop.denominator, 1 / z)
        assert _at(h.numerator[::-1], z) / _at(h.denominator[::-1], z) == value


def _at(ascending, point):
    return sum(Fraction(c) * point**k for k, c in enumerate(ascending))


def test_seeds_are_never_run_twice(tmp_path):
    """Stretches that touch become one, and the next seed comes after all that were run."""
    from attack import ledger
    from attack.judge import Judged

    path, done = tmp_path / "ledger.csv", []
    assert ledger.next_seed(done) == 0
    for first, last in ((0, 4), (5, 9), (20, 29)):
        stretch = ledger.Stretch(first, last)
        stretch.add(Judged("linear", "active"))
        stretch.add(Judged("contact", "passive in contact", touched=True))
        done = ledger.joined([*done, stretch])
        ledger.write(path, done)
    read = ledger.read(path)
    assert [(s.first, s.last) for s in read] == [(0, 9), (20, 29)]
    assert ledger.next_seed(read) == 30
    assert "| contact | 3 | 0 | 3 | 3 | 0 | 0 | 0 (0.0 %) | 0 | 0 |" in ledger.table(read)
