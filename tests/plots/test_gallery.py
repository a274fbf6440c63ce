"""Each gallery script runs, draws and prints the number that its page promises."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pytest
from figure_layout import faults
from gallery_pages import EXAMPLES, artists, figures
from printed import shows

NUMBERS = {
    "plot_adaptive_tissue": "taken out: naive 2.37 mJ, adaptive 0.00 mJ",
    "plot_bounded_hands": "every hand: 300 N/m; hands up to 0.5 m/s: 747 N/m",
    "plot_bouncing_ball": "after 3 strikes the ball comes back 12.37 times as far as it started",
    "plot_buzz_or_bounce": "quantization against Coulomb friction: largest passive stiffness 107.1 N/m",
    "plot_contact_with_memory": "fed with the position: active at 1.84 of the linear criterion's damping",
    "plot_coupling": "one sample late: 115.5 N/m, a spring alone 75.0 N/m",
    "plot_creep_relaxation": "relaxation time 0.200 s, retardation time 0.333 s",
    "plot_damped_wall_map": "friction: 8 of 8 brackets lie within 1 % of σ = ½ + β_v",
    "plot_delay": "with 0.3 ms: 174.2 N/m; rounded up to 1 ms: 100 N/m",
    "plot_explicit_bodies": "stiffest coupling: 248.5 N/m, one sample away 55.4 N/m",
    "plot_how_stiff": "largest passive stiffness at 1 kHz: 300 N/m",
    "plot_identify_a_device": "means over pulses: 299 to 316; differentiated: 327 to 616",
    "plot_known_hand": "with B = 0.5 N·s/m: no hand 1283 N/m, dowel 1285 N/m, finger 4678 N/m",
    "plot_links": "20 samples late: textbook waves 3.1 m/s, waves with a ledger 0.048 m/s",
    "plot_laws": "wall 18.5 mJ at 99%, virtual-damping 0 mJ at 99%, virtual-coupling 4.78 mJ at 33%",
    "plot_motorized_guide": "measured over passive, Kelvin-Voigt without damping: 9.9",
    "plot_paddle_experiments": "9 of 11 statements agree; the others are the boundary at 90 N/m and at 3 ms",
    "plot_pair_of_arms": "felt: 95.5 N·m/rad",
    "plot_parallel_controller": "10 g, controller: 0.059 m/s at most",
    "plot_passivity_indices": "short of passive by 0.3815 m/s per N at 57.38 Hz",
    "plot_passivity_controller": "zigzag, at most b: 0.0818 J come out",
    "plot_plane": "largest passive stiffness: 26.08 N·m/rad",
    "plot_prediction": "last over first: original 12.37, prediction 0.03, correction 1.000",
    "plot_scene": "into the elements 9.9339 mJ, from the hand 9.9339 mJ",
    "plot_soft_tissue": "largest relative difference over 99 points: ",
    "plot_staircase": "energy leaked by the hold: 1.5 mJ, 1.000000000000 of the formula",
    "plot_storage_of_an_arm": "the lemma loses 0.00125 mJ of 1.94 mJ of heat in the joints",
    "plot_tracking_tissue": "found again 3.4 s after the change",
    "plot_velocity_filter": "N = 20: b ≥ 0.248 B, tightest at 35 Hz",
    "plot_workspace": "0.678 mN·m·s/rad more in the first joint, or 0.626 in both",
    "plot_worst_case": "admissible speed at 770 N/m: 0.474 m/s",
}


ON_PURPOSE = {
    "plot_paddle_experiments": ["80 N/m: is still"],  # on the scale of the wall beside it, which buzzes
    "plot_passivity_controller": ["[controller [N]]"],  # the wall alone, which has none
}
"""Axes that are left empty because that is what they show."""


def test_every_script_is_listed():
    assert {path.stem for path in EXAMPLES.glob("plot_*.py")} == set(NUMBERS)


@pytest.mark.parametrize("name", NUMBERS)
def test_page_shows_its_number_and_whole_figures(name, capsys, monkeypatch):
    """The number is the one in the text; figures fill their axes, and are whole where their block ends."""
    plt.switch_backend("agg")
    monkeypatch.setattr(plt, "show", lambda: None)
    seen, found = [], []
    with plt.rc_context():
        for figure in figures(name):
            found += faults(figure)
            seen.append((figure, artists(figure)))
    printed = capsys.readouterr().out
    assert seen, "there is no figure"
    assert all(artists(figure) == then for figure, then in seen), "drawn on after its block has ended"
    assert [fault for fault in found if not any(part in fault for part in ON_PURPOSE.get(name, ()))] == []
    assert shows(printed, NUMBERS[name])
    if name == "plot_soft_tissue":
        assert float(printed.rsplit(" ", 1)[1]) <= 1e-12
