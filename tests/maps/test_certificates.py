"""Certificates of the passive region, a column each: what they say, and that softer walls need none."""

from fractions import Fraction

import numpy as np
import pytest

import zwidth as zw
from zwidth.passivity.check import check_by_closed_forms

PADDLE = zw.catalogue.device("haptic-paddle")
FILTERS = {
    "backward difference": zw.rendering.BackwardDifference(),
    "window": zw.rendering.Window(4),
    "one pole": zw.rendering.OnePole("0.004"),
    "filter": zw.rendering.VelocityFilter([3, -1], [2, 0]),
}


def told(document):
    """K and B of a certificate, from its H(z): K is what is left at z = 1."""
    loop = document["loop"]
    top, bottom = ([Fraction(str(c)) for c in loop[name]] for name in ("numerator", "denominator"))
    law = document.get("law", {})
    return float(sum(top) / sum(bottom)), float(law.get("virtual_damping_N_s_per_m", 0))


@pytest.mark.parametrize("delay", ["0", "0.002", "0.0014"])
@pytest.mark.parametrize("name", list(FILTERS))
def test_each_column_has_its_stiffest_passive_wall(name, delay):
    """K and B of the certificates are the last passive cell of each column that has one; all are accepted."""
    device, velocity = PADDLE.replace(delay=delay), FILTERS[name]
    found = zw.z_width(device, (0, 400), ("-0.1", "0.3"), (80, 12), velocity_filter=velocity, hands={})
    certificate = zw.maps.z_width_certificate(device, found, velocity_filter=velocity)
    assert certificate is not None
    assert certificate.verify()
    passive = found["passive"].values
    expected = [
        (found["stiffness"].values[np.flatnonzero(column)[-1]], b)
        for column, b in zip(passive.T, found["virtual_damping"].values, strict=True)
        if column.any()
    ]
    assert len(expected) > 2
    assert [told(d) for d in certificate.documents] == [pytest.approx(pair, rel=1e-12) for pair in expected]


@pytest.mark.parametrize("name", list(FILTERS))
def test_below_a_certified_wall_all_softer_ones_are_passive(name):
    """20 walls below the stiffest of a column are proved too; a hundredth beyond the limit none is, so."""
    velocity = FILTERS[name]
    found = zw.z_width(PADDLE, (0, 400), ("0.01", "0.02"), (400, 1), velocity_filter=velocity, hands={})
    limit, b = float(found["limit_passive"][0]), float(found["virtual_damping"][0])
    for share in np.linspace(0, 1, 20):
        verdict = check_by_closed_forms(PADDLE, zw.Wall(share * limit * (1 - 1e-12), b, velocity))
        assert verdict.certificate is not None
        assert verdict.outcome == "passive"
    beyond = check_by_closed_forms(PADDLE, zw.Wall(limit * 1.01, b, velocity)).certificate
    assert beyond is None or beyond.kind not in ("spring", "contact")


def test_nothing_passive_nothing_certified():
    device = PADDLE.replace(damping=0)
    found = zw.z_width(device, (0, 400), (0, "0.1"), (20, 4), hands={})
    assert zw.maps.z_width_certificate(device, found) is None


def test_a_map_of_another_device_is_refused():
    """With less damping than the map's device had its walls are not passive; columns are told one by one."""
    found = zw.z_width(PADDLE, (0, 400), (0, "0.1"), (20, 4), hands={})
    seen = []
    zw.maps.z_width_certificate(PADDLE, found, progress=lambda done, total: seen.append((done, total)))
    assert seen == [(k + 1, 4) for k in range(4)]
    jumps = zw.rendering.VelocityFilter([9, -9], [1, 0])
    for device, other in ((PADDLE.replace(damping="0.1"), {}), (PADDLE, {"velocity_filter": jumps})):
        with pytest.raises(zw.InputError, match="another device"):
            zw.maps.z_width_certificate(device, found, **other)
