"""Words are whole and axes are filled in every picture, whatever the device and the page around it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from figure_layout import faults, words
from matplotlib import rc_context, style
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import zwidth as zw
from zwidth.show import plots
from zwidth.show.plots.style import LOOK, broken, heading

PADDLE = zw.catalogue.device("haptic-paddle")
WHEEL = zw.Device(
    **{"mass": 0.05, "damping": 0.01, "coulomb_friction": 0.1, "resolution": "0.00153398"},
    rate=1000,
    delay=0,
    motion="rotary",
    name="a direct drive wheel of 8 N m, with a name that is longer than a line",
)
LINEAR = ("N/m", "[N]", "N·s/m", "[m]", "[mm]", "[µm]", "[m/s]")


@cache
def drawn(device: zw.Device) -> dict[str, Figure]:
    k = 770 if device is PADDLE else 30
    active, passive = (zw.check(device, zw.Wall(v)) for v in (k, k / 4))
    damped = zw.check(device, zw.Wall(k / 4, float(device.damping) / 10))
    bracket = zw.limit(
        device, zw.Wall(k), speed=0.5 if device is PADDLE else 12, penetration=14 * count(device)
    )
    touch = zw.simulate(device, zw.Wall(k), zw.operators.Finger(), 0.3)
    walls = zw.z_width(device, (0, 2 * k), (0, 4 * float(device.damping)), cells=(40, 40))
    return {
        "active": active.plot(),
        "passive": passive.plot(),
        "damped": damped.plot(),
        "criterion": plots.criterion(damped),
        "plane": plots.plane(device, k, with_catalogue=False),
        "budget": plots.budget(active),
        "witness": plots.witness(active),
        "worst case": plots.worst_case(device, k),
        "limit": bracket.plot(),
        "touch": touch.zwidth.plot(),
        "map": plots.z_width_figure(walls),
    }


def count(device: zw.Device) -> float:
    return float(device.exact("resolution"))


@pytest.mark.parametrize("device", [PADDLE, WHEEL], ids=["paddle", "wheel"])
def test_pictures_have_no_faults(device):
    found = {name: faults(figure) for name, figure in drawn(device).items()}
    assert {name: lines for name, lines in found.items() if lines} == {}


def test_a_wheel_is_drawn_in_its_units():
    said = {name: [w.get_text() for w in words(figure)] for name, figure in drawn(WHEEL).items()}
    of_others = ("haptic-paddle", "catalogue")
    for name, texts in said.items():
        mine = [text for text in texts if not any(other in text for other in of_others)]
        assert [text for text in mine if any(unit in text for unit in LINEAR)] == [], name
        assert [text for text in mine if "*" in text.replace("J*", "")] == [], name
    assert any("N·m/rad" in text for text in said["limit"])
    assert any("mrad" in text for text in said["touch"])


def test_pictures_are_on_white_whatever_is_around_them():
    with rc_context(), style.context("dark_background"):
        figure = zw.check(PADDLE, zw.Wall(770)).plot()
    assert figure.get_facecolor() == (1, 1, 1, 1)
    for axes in figure.axes:
        assert axes.get_facecolor()[:3] == (1, 1, 1)
        dark = [axes.xaxis.label, axes.yaxis.label, *axes.get_xticklabels(), *axes.get_yticklabels()]
        assert all(np.mean(to_rgb(text.get_color())) < 0.5 for text in dark)


def test_a_long_text_is_broken_and_nothing_of_it_lost():
    text = "first line\n" + "a hand that is described in many words " * 6
    lines = broken(text, 3.0).splitlines()
    assert lines[0] == "first line"
    assert " ".join(lines).split() == text.split()
    assert max(map(len, lines[1:-1])) < 1.5 * min(map(len, lines[1:-1]))
    assert broken("short", 3.0) == "short"


def test_a_title_ends_where_its_axes_place_does():
    with rc_context(LOOK):
        figure = Figure(figsize=(8, 3), layout="constrained")
        half, text = figure.add_subplot(1, 2, 1), "what stands above a picture and is rather long, " * 2
        heading(half, text)
        whole = Figure(figsize=(8, 3), layout="constrained").add_subplot()
        heading(whole, text)
    assert half.get_title(loc="left").count("\n") > whole.get_title(loc="left").count("\n")


def empty_corner(axes):
    axes.plot([0, 1], [0, 0.1])
    axes.set(xlim=(0, 1), ylim=(-1, 1))


def cut(axes):
    axes.plot([0, 1], [0, 1])
    axes.set_title("a title that is far too long for so small a figure, " * 3)


def offset(axes):
    axes.ticklabel_format(useOffset=True)
    axes.plot([0, 1], [0.19850001, 0.19850002])


def over_a_curve(axes):
    axes.plot(np.linspace(0, 1, 50), np.linspace(0, 1, 50) ** 0, label="curve")
    axes.plot([0, 1], [0, 1])
    axes.legend(loc="upper left")


def good(axes):
    axes.plot([0, 1], [0, 1], label="curve")
    axes.set_title("good")
    axes.legend(loc="lower right")


@pytest.mark.parametrize(
    ("draw", "word"),
    [(empty_corner, "height"), (cut, "edge"), (offset, "offset"), (over_a_curve, "legend"), (good, None)],
)
def test_a_fault_is_found(draw, word):
    figure = Figure(figsize=(4, 3), layout="constrained")
    draw(figure.add_subplot())
    assert faults(figure) == [] if word is None else any(word in fault for fault in faults(figure))
