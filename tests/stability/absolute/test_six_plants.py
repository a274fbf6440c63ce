"""Six published plants: their slopes to three digits, each proved by a certificate."""

from __future__ import annotations

import json
from functools import cache

import pytest

import zwidth as zw
from zwidth import checker
from zwidth.cli.main import main
from zwidth.passivity.certificate import read_document, verify_document
from zwidth.passivity.stability.absolute import given_plant, periodic_motion

PLANTS = {
    1: (["0.1", 0], [1, "-1.8", "0.81"]),
    2: ([1, "-1.95", "0.9", "0.05"], [1, "-2.8", "3.5", "-2.412", "0.7209"]),
    3: ([-1, "1.95", "-0.9", "-0.05"], [1, "-2.8", "3.5", "-2.412", "0.7209"]),
    4: ([1, "-1.5", "0.5", "-0.5", "0.5"], ["4.4", "-8.957", "9.893", "-5.671", "2.207", "-0.5"]),
    5: (["-0.5", "0.1"], [1, "-0.9", "0.79", "0.089"]),
    6: ([2, "0.92"], [1, "-0.5", 0]),
}
PUBLISHED = {  # circle, Tsypkin, best odd Zames–Falb: Carrasco et al. (2020), as quoted by public code
    1: (0.7935, 3.80, 13.5113),
    2: (0.1984, 0.2427, 1.1056),
    3: (0.1379, 0.1379, 0.3121),
    4: (1.5312, 1.6911, 3.8240),
    5: (1.0273, 1.0273, 2.4475),
    6: (0.6510, 0.6510, 1.0870),
}
NYQUIST = {1: 36.1, 2: 2.7455, 3: 0.3124, 4: 7.907, 5: 2.4475, 6: 1.0870}
"""−1/G at its first real negative value; 36.1, 2.7455, 7.907 are D(−1)/−N(−1) by hand."""


@cache
def found(number):
    """What is proved of a plant; of the last one the motions, too."""
    plant = zw.PulseTransferFunction(*PLANTS[number])
    return zw.stability.absolute_stability(plant, motions=number == 6)


of_each = pytest.mark.parametrize("number", sorted(PLANTS))


@of_each
def test_slopes_are_the_published_ones(number):
    result = found(number)
    names = ("circle", "Tsypkin", "Zames–Falb, odd")
    for name, value in zip(names, PUBLISHED[number], strict=True):
        assert float(result.slope(name)) == pytest.approx(value, rel=5e-4)
    assert result.linear_limit.slope == pytest.approx(NYQUIST[number], rel=5e-4)
    circle, tsypkin, jury_lee, general, odd = slopes = [float(row.slope) for row in result.proved]
    assert max(slopes) <= result.linear_limit.slope
    near = 1 - 1e-4
    assert min(tsypkin, jury_lee) >= circle * near
    assert general >= max(tsypkin, jury_lee) * near
    assert odd >= general * near
    words = repr(result)
    assert words.startswith(f"<AbsoluteStability proved: circle {circle:.6g}; Tsypkin ")
    refuted = result.linear_limit if number < 6 else result.pressing
    assert words.endswith(f"refuted: {refuted.slope:.6g}>")


@of_each
def test_certificates_verify_and_no_more_slope_does(number):
    for row in found(number).proved:
        assert row.certificate.verify()
        (document,) = row.certificate.documents
        more = {**document, "slope": str(float(row.slope) * 1.01)}
        assert not zw.Certificate((more,)).verify()


def test_walls_that_are_not_odd_get_less():
    assert float(found(6).slope("Zames–Falb")) == pytest.approx(0.9115, abs=5e-5)


def test_a_one_sided_wall_just_above_what_is_proved_for_it_vibrates():
    result = found(6)
    motion = result.pressing
    assert motion.period == 3
    assert motion.slope == pytest.approx(175 / 192, rel=1e-6)  # x = −½, −¼ − K, −⅛ − 0.96 K with g = −1
    assert motion.growth < 1
    assert float(result.largest) < motion.slope < float(result.largest) * 1.01 < result.linear_limit.slope
    # replayed by its difference equation: x(j) = 0.5 x(j−1) − 2 f(j−1) − 0.92 f(j−2)
    x = list(motion.positions[:2])
    f = [motion.slope * max(v - motion.gap, 0.0) for v in x]
    for _ in range(3000):
        x.append(0.5 * x[-1] - 2 * f[-1] - 0.92 * f[-2])
        f.append(motion.slope * max(x[-1] - motion.gap, 0.0))
    assert x[-3:] == pytest.approx([motion.positions[(3002 - 3 + i) % 3] for i in range(3)], abs=1e-9)


def test_saved_with_the_result_and_verified(tmp_path, capsys) -> None:
    path = tmp_path / "six.json"
    found(6).save(path)
    assert verify_document(read_document(path)).valid
    assert main(["verify", str(path)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "to rest" in told
    assert "0.911" in told
    assert "vibrates" in told
    assert "passive" not in told
    doc = json.loads(path.read_text(encoding="utf-8"))
    doc["witness"]["slope"] = "0.9"
    path.write_text(json.dumps(doc))
    assert main(["verify", str(path)]) == 1


@pytest.mark.parametrize(("number", "slope"), [(1, 26.1), (2, 1.58), (4, 3.99)])
def test_every_motion_found_has_a_certificate(number, slope):
    motion = periodic_motion(given_plant(zw.PulseTransferFunction(*PLANTS[number])), slope, -1.0)
    assert motion.certificate.verify()
    (doc,) = motion.certificate.documents
    assert sum(doc["inside"]) == sum(motion.inside)
    assert not checker.verify({**doc, "slope": str(slope / 2)}).valid
