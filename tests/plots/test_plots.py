"""What each picture shows, read back from its artists."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import zwidth as zw
import zwidth.show.plots as plots
from zwidth.show.plots.linear import refined_curve
from zwidth.show.plots.replay import ROUNDS, replay
from zwidth.show.plots.style import save_figure

PADDLE = zw.catalogue.device("haptic-paddle")
IDEAL = PADDLE.replace(resolution=0)
WHEEL = zw.Device(
    damping=0.01, coulomb_friction=0.1, resolution=0.0015, rate=1000, motion="rotary", name="wheel"
)


def _dashed(axes: Axes) -> float:
    (line,) = [line for line in axes.lines if line.get_linestyle() == "--"]
    return float(line.get_ydata()[0])


def _by_id(axes: Axes, name: str) -> list:
    return [a for a in axes.get_children() if a.get_gid() == name]


def test_criterion_shows_damping_peak_and_violation():
    verdict = zw.check(IDEAL, zw.Wall(stiffness=100, damping=0.5, velocity_filter=zw.rendering.Window(20)))
    (axes,) = plots.criterion(verdict).axes
    assert _dashed(axes) == 0.15
    (mark,) = _by_id(axes, "critical")
    assert mark.get_xdata()[0] == verdict.critical_frequency
    assert mark.get_ydata()[0] == pytest.approx(verdict.required_damping, rel=1e-12)
    assert len(axes.collections) == 1
    assert axes.get_title(loc="left").startswith("active")
    assert axes.get_ylabel() == "required damping b [N·s/m]"
    assert not plots.criterion(zw.check(IDEAL, zw.Wall(stiffness=100))).axes[0].collections


@pytest.mark.parametrize("damping", [0.5, -0.3])
def test_criterion_on_a_logarithmic_axis(damping):
    verdict = zw.check(
        IDEAL, zw.Wall(stiffness=100, damping=damping, velocity_filter=zw.rendering.Window(20))
    )
    (axes,) = plots.criterion(verdict, log_frequency=True).axes
    (mark,) = _by_id(axes, "critical")
    assert mark.get_xdata()[0] == max(verdict.critical_frequency, axes.get_xlim()[0])
    assert axes.get_xlim()[0] > 0


def test_narrow_peaks_are_drawn_on_both_sides():
    """A resonance far narrower than the even spacing has points at its top and on its flanks."""
    law = zw.PulseTransferFunction([100, -190, 99.9], [1, -1.9, 0.99999])
    verdict = zw.check(IDEAL, law)
    frequencies, needs = refined_curve(verdict)
    top = max(needs)
    assert top == pytest.approx(verdict.required_damping, rel=1e-9)
    assert sum(n > top / 2 for n in needs) > 10
    assert frequencies == sorted(frequencies)


def test_plane_marks_the_device_and_counts_the_unknown():
    (axes,) = plots.plane(PADDLE, 770).axes
    (mark,) = _by_id(axes, "device")
    assert mark.get_xdata()[0] == pytest.approx(0.15 / 0.77)
    assert mark.get_ydata()[0] == pytest.approx(0.12 / (770 * 22.4e-6))
    texts = [t.get_text() for t in axes.texts]
    assert any(t.startswith(f"{len(zw.catalogue.names()) - 1} devices of the catalogue") for t in texts)
    assert not _by_id(axes, "catalogue")  # the paddle itself is the only one with a place


def test_plane_marks_the_limit_as_passive():
    odd = PADDLE.replace(damping="0.137", sample_period="0.0007")
    (axes,) = plots.plane(odd).axes
    (mark,) = _by_id(axes, "device")
    assert mark.get_xdata()[0] == 0.5
    assert mark.get_label().endswith("globally stable")


def test_plane_of_another_device_shows_the_catalogue():
    """The paddle stands at its limit of 300 N/m, on β = ½."""
    (axes,) = plots.plane(WHEEL, 10).axes
    (mark,) = _by_id(axes, "catalogue")
    assert mark.get_xdata()[0] == pytest.approx(0.5)
    assert any("300 N/m" in t.get_text() for t in axes.texts)
    assert "K = 10 N·m/rad" in _by_id(axes, "device")[0].get_label()


def test_budget_bars_add_up():
    law = zw.StandardLinearSolid(stiffness=100, branch_stiffness=100, branch_damping=0.2)
    verdict = zw.check(PADDLE.replace(delay=0.0023), law)
    damping, friction = plots.budget(verdict).axes
    leaks = [bar.get_width() for bar in _by_id(damping, "leak")]
    assert min(leaks) < 0
    assert sum(leaks) == pytest.approx(verdict.budget.required)
    assert _by_id(damping, "b")[0].get_width() == 0.15
    assert _by_id(friction, "f_c")[0].get_width() == 0.12
    assert _by_id(friction, "leak")[0].get_width() == pytest.approx(verdict.budget.friction_required)


@pytest.mark.parametrize(
    ("device", "law"),
    [
        (PADDLE, zw.Wall(stiffness=770)),
        (PADDLE.replace(delay=0.0003), zw.Wall(stiffness=250)),
        (IDEAL, zw.Wall(stiffness=100, damping=-0.3)),
        (IDEAL, zw.PulseTransferFunction([100, -190, 99.9], [1, -2.5, 1])),
    ],
)
def test_replay_ends_at_the_energy_of_the_witness(device, law):
    witness = zw.check(device, law).witness
    played = replay(witness)
    assert played.caption == "the whole motion"
    assert played.energies[-1] == pytest.approx(witness.energy, rel=1e-9)
    assert [played.positions[k] for k in (0, -1)] == [witness.positions[0], witness.positions[-1]]
    assert len(played.forces) == len(played.times) - 1


def test_long_replay_agrees_with_exact_arithmetic(monkeypatch):
    law = zw.StandardLinearSolid(stiffness=100, branch_stiffness=100, branch_damping=0.2)
    witness = zw.check(PADDLE.replace(delay=0.0023), law).witness
    exact = replay(witness)
    monkeypatch.setattr("zwidth.show.plots.replay._EXACT", 0)
    fast = replay(witness)
    assert fast.energies == pytest.approx(exact.energies, rel=1e-9, abs=1e-9)
    assert fast.forces == pytest.approx(exact.forces, rel=1e-9)


def test_replay_shows_a_few_rounds():
    witness = zw.check(PADDLE.replace(resolution=22.4e-4), zw.Wall(stiffness=150)).witness
    played = replay(witness)
    assert played.caption.startswith(f"{ROUNDS} of ")
    assert played.energies[-1] == pytest.approx(ROUNDS * witness.energy_per_cycle, rel=0.01)


def test_worst_case_touches_its_lines_at_rest():
    """J* and its line meet at λ = 0 and part on the side that the sign of α says."""
    (below,) = plots.worst_case(PADDLE, 250).axes
    (beyond,) = plots.worst_case(PADDLE, 770).axes
    for axes, sign in ((below, 1), (beyond, -1)):
        curve, line = (line.get_ydata() for line in axes.lines[:2])
        assert curve[len(curve) // 2] == line[len(line) // 2] == 0
        assert sign * (curve[0] - line[0]) > 0
        assert sign * (curve[-1] - line[-1]) > 0


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_a_picture_is_written_by_ending(tmp_path, ending):
    verdict = zw.check(PADDLE, zw.Wall(stiffness=770))
    first, second = tmp_path / f"first.{ending}", tmp_path / f"second.{ending.upper()}"
    verdict.plot(first)
    verdict.plot(str(second))
    assert first.read_bytes() == second.read_bytes() != b""


def test_a_picture_that_cannot_be_written_is_refused(tmp_path):
    verdict = zw.check(WHEEL, zw.Wall(stiffness=10))
    with pytest.raises(zw.InputError, match=r"\.png, \.svg or \.pdf, got 'check\.jpg'"):
        verdict.plot(tmp_path / "check.jpg")
    kept = tmp_path / "kept.png"
    kept.write_bytes(b"mine")
    with pytest.raises(zw.InputError, match="exists; choose another name"):
        save_figure(verdict.plot, kept)
    assert kept.read_bytes() == b"mine"
    with pytest.raises(zw.InputError, match="cannot be written"):
        verdict.plot(tmp_path / "nowhere" / "check.png")
    verdict.plot(kept)
    assert kept.read_bytes() != b"mine"


@pytest.mark.parametrize(
    ("device", "law", "panels"),
    [
        (PADDLE, zw.Wall(stiffness=300), 4),  # criterion, plane, two bars
        (PADDLE, zw.Wall(stiffness=770), 7),  # and three of the witness
        (IDEAL, zw.Wall(stiffness=300), 2),
        (PADDLE, zw.Wall(stiffness=100, damping=0.05), 3),
        (WHEEL, zw.Wall(stiffness=10), 4),
        (IDEAL.replace(damping=0), zw.Wall(stiffness=0), 2),
        (IDEAL, zw.PulseTransferFunction([-100], [1]), 5),
    ],
)
def test_check_figure_has_the_panels_that_apply(device, law, panels):
    figure = plots.check_figure(zw.check(device, law))
    assert isinstance(figure, Figure)
    assert len(figure.axes) == panels
    assert all(axes.has_data() for axes in figure.axes)


def test_names_are_drawn_as_they_are():
    device = PADDLE.replace(name="$\\foo$ of\nour lab, " + "x" * 100)
    figure = plots.check_figure(zw.check(device, zw.Wall(stiffness=300)))
    figure.savefig(BytesIO())
    assert figure.get_suptitle().startswith("$\\foo$ of?our lab, xxx")
    plots.worst_case(device, 300).savefig(BytesIO())


def test_indices_mark_the_least_real_part():
    from scipy.signal import TransferFunction

    found = zw.ports.passivity_indices(TransferFunction([1, 1, 5, 0.1], [1, 2, 3, 4]))
    for axes, index in zip(plots.indices(found).axes, (found.input, found.output), strict=True):
        assert _dashed(axes) == index.value
        curve = next(line for line in axes.lines if len(line.get_xdata()) > 100)
        assert min(curve.get_ydata()) == pytest.approx(index.value, rel=1e-3)
    assert axes.lines[-1].get_xdata()[0] == index.frequency
    assert axes.get_ylabel() == "Re $1/G$"


def test_indices_of_several_axes_are_eigenvalues():
    from scipy.signal import StateSpace

    found = zw.ports.passivity_indices(
        StateSpace([[-1, 2], [-2, -3]], np.eye(2), [[1, 0.5], [0, 1]], 0.2 * np.eye(2))
    )
    for axes, index in zip(plots.indices(found).axes, (found.input, found.output), strict=True):
        curves = [line.get_ydata() for line in axes.lines if len(line.get_xdata()) > 100]
        assert len(curves) == 2
        assert min(map(min, curves)) == pytest.approx(index.value, rel=1e-3)
        assert _dashed(axes) == index.value
    one = zw.ports.passivity_indices(StateSpace([[-1]], [[1, 1]], [[1], [1]], np.zeros((2, 2))))
    assert one.output.curve([0.1, 1, 10]) == pytest.approx([0.5, 0.5, 0.5])
    plots.indices(one).savefig(BytesIO(), format="svg")


@pytest.mark.parametrize(("num", "den"), [([1], [1, -1]), ([1], [1, 0, 0]), ([2], [1])])
def test_indices_without_a_number_are_drawn_too(num, den):
    from scipy.signal import TransferFunction

    for arguments in ({}, {"dt": 0.01}):
        found = zw.ports.passivity_indices(TransferFunction(num, den, **arguments))
        left, right = plots.indices(found).axes
        plots.indices(found).savefig(BytesIO(), format="svg")
        for axes, index in ((left, found.input), (right, found.output)):
            infinite = abs(index.value) == float("inf")
            assert ("∞" in axes.get_title(loc="left")) == (infinite or index.frequency == float("inf"))


# ---- available storage

BOUNDS = {"penetration": "0.0005", "speed": "0.3"}


def test_storage_shows_the_waiting_hand_within_the_band():
    """The line is V for reading before = reading now; the band holds it, and a tick each count."""
    found = zw.available_storage(PADDLE, zw.Wall(700, 0.05), penetration="0.0003", speed="0.2")
    (axes,) = plots.storage(found).axes
    (line,) = _by_id(axes, "waiting")
    energy = found.available_storage().values
    drawn = np.asarray(line.get_ydata())
    assert drawn.min() >= 0
    assert drawn.max() <= axes.get_ylim()[1]
    factor = drawn.max() / energy[-1, -1]
    assert np.all(drawn >= factor * np.nanmin(energy, axis=0) * (1 - 1e-12))
    assert np.all(drawn <= factor * np.nanmax(energy, axis=0) * (1 + 1e-12))
    ticks = axes.xaxis.get_minorticklocs()
    assert ticks / 22.4 == pytest.approx(np.round(ticks / 22.4), abs=1e-9)
    assert len(ticks) >= 14  # 0.3 mm in counts
    assert "[µJ]" in axes.get_ylabel()


def test_cycle_shows_positions_edges_forces_and_the_joules():
    gain = zw.available_storage(PADDLE, zw.Wall(950, 0.05), **BOUNDS).witness
    above, middle, below = plots.cycle(gain).axes
    x = np.asarray(above.lines[0].get_ydata()) * 1e-6
    assert set(np.round(x, 12)) == set(np.round(gain.cycle, 12))
    assert len(_by_id(above, "edge")) >= (x.max() - x.min()) / 22.4e-6 - 1
    (stairs,) = middle.patches
    assert len(stairs.get_data().values) == len(x) - 1
    (energy,) = _by_id(below, "energy")
    out = np.asarray(energy.get_ydata())
    samples = len(gain.cycle) - 1
    rounds = (len(x) - 1) // samples
    factor = 1e6 if "µJ" in below.get_ylabel() else 1e3
    assert out[-1] == pytest.approx(rounds * gain.energy_per_cycle * factor, rel=1e-6)
    assert f"every round of {samples} samples" in above.get_title(loc="left")


def test_both_sides_of_a_limit_stand_beside_each_other():
    bracket = zw.limit(PADDLE, zw.Wall(100, 0.05), **BOUNDS)
    figure = plots.limit_figure(bracket)
    left, *right = figure.axes
    passive, active = (float(axes.get_title(loc="left").split()[0]) for axes in (left, right[0]))
    assert 0 <= bracket.proved_passive - passive < 0.1
    assert 0 <= active - bracket.proved_active < 0.1
    assert len(right) == 3


def test_a_closed_limit_shows_its_motion_alone():
    figure = plots.limit_figure(zw.limit(PADDLE, zw.Wall(100, 0.05)))
    assert len(figure.axes) == 3
    assert "every hand" in figure.get_suptitle()


def test_a_verdict_shows_what_the_game_found():
    active = zw.check(PADDLE.replace(coulomb_friction="0.002"), zw.Wall(150, 0.05, clamped=True))
    titles = [a.get_title(loc="left") for a in plots.check_figure(active).axes]
    assert any("out in every round" in t for t in titles)
    assert len(plots.witness(active).axes) == 3
    bounded = zw.check(PADDLE, zw.Wall(250, 0.05, clamped=True))
    titles = [a.get_title(loc="left") for a in plots.check_figure(bounded).axes]
    found = bounded.available_storage
    # of slow hands a closed form may say as much, without a storage function
    drawn = found is not None and found.storage is not None
    assert any("never more than" in t for t in titles) is drawn


def test_a_rotary_cycle_is_in_radians():
    wheel = zw.Device(damping=0.01, coulomb_friction=0.001, resolution=0.001, rate=1000, motion="rotary")
    gain = zw.available_storage(wheel, zw.Wall(200, 0.001)).witness
    above, middle, _ = plots.cycle(gain).axes
    assert "rad]" in above.get_ylabel()
    assert "N·m]" in middle.get_ylabel()


@pytest.mark.parametrize(
    ("draw", "says"),
    [
        (lambda: plots.plane(PADDLE.replace(resolution=0), 770), "the plane has logarithmic axes"),
        (lambda: plots.plane(PADDLE.replace(coulomb_friction=0)), "the plane has logarithmic axes"),
        (lambda: plots.plane(PADDLE.replace(delay=0.001)), "the plane has logarithmic axes"),
        (lambda: plots.witness(zw.check(PADDLE, zw.Wall(stiffness=300))), "the loop is passive"),
        (lambda: plots.storage(zw.available_storage(PADDLE, zw.Wall(1500, 0.05))), "active"),
    ],
    ids=["no resolution", "no friction", "a delay", "no motion", "no storage"],
)
def test_what_cannot_be_drawn_is_refused(draw, says):
    """A logarithmic plane has no place for a zero, and no formula for a delay."""
    with pytest.raises(zw.InputError, match=says):
        draw()
