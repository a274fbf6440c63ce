"""Words are whole and axes are filled in every picture, whatever the device and the page around it."""

from __future__ import annotations

from functools import cache, partial
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from figure_layout import faults, faults_of_ours, words
from matplotlib import rc_context, style
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from scipy.signal import TransferFunction

import zwidth as zw
from zwidth.model.arms import built_in
from zwidth.model.scene import Contact, Damper, Mass, Spring
from zwidth.quantity.spoken import answers_in
from zwidth.show import plots
from zwidth.show.plots.style import LOOK, broken, heading
from zwidth.show.plots.traces import comparison_figure
from zwidth.study.bench import standard_laws

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
    active = zw.check(device, zw.Wall(k))
    damped = zw.check(device, zw.Wall(k / 4, float(device.damping) / 10))
    bracket = zw.limit(
        device, zw.Wall(k), speed=0.5 if device is PADDLE else 12, penetration=14 * count(device)
    )
    touch = zw.simulate(device, zw.Wall(k), zw.operators.Finger(), 0.3)
    walls = zw.z_width(device, (0, 2 * k), (0, 4 * float(device.damping)), cells=(40, 40))
    return {
        "active": active.plot(),
        "damped": damped.plot(),
        "criterion": plots.criterion(damped),
        "plane": plots.plane(device, k, with_catalogue=False),
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
    found = {name: faults_of_ours(figure) for name, figure in drawn(device).items()}
    assert {name: lines for name, lines in found.items() if lines} == {}


IDEAL = PADDLE.replace(resolution=0)
SLOW = zw.rendering.VelocityFilter([1, 0, 0], [1, "-0.5", "0.06"])
CABLE = zw.Transmission(stiffness="20 N/mm", damping="0.5 N*s/m", handle_mass="30 g", handle_damping="0.09")
ON_A_CABLE = PADDLE.replace(damping="0.06", resolution=0, coulomb_friction=0, transmission=CABLE)
JOINT = zw.Device(
    motion="rotary", mass=0.02, damping="0.4 N*m*s/rad", coulomb_friction="0.05 N*m", resolution="40 urad",
    rate="1 kHz", delay=0,
)  # fmt: skip
PAIR = zw.Pair(JOINT, JOINT, stiffness="100 N*m/rad", delay="2 ms")
FREE = zw.Device(damping="0.3", mass="0.02", coulomb_friction=0, resolution=0, delay=0, rate="1 kHz")
HELD = zw.Pair(FREE, FREE, stiffness=300, delay="2 ms")
HAND = zw.stability.HandImpedance(mass=0.05, stiffness=100, damping=(2, "2.1"))
SWEPT = {
    "stiffness": np.linspace(100, 1000, 7),
    "damping": np.linspace(0.02, 0.5, 7),
    "delay": [0, 1e-3, 2e-3],
}


def swept(*names):
    return zw.sweep(PADDLE, zw.Wall(770), vary={name: SWEPT[name] for name in names})


def several(count):
    walls = np.linspace(100, 800, count)
    return comparison_figure(
        {f"{k:g} N/m, a long name": zw.simulate(PADDLE, zw.Wall(k), zw.operators.Dowel(), 0.1) for k in walls}
    )


def scene():
    return zw.Scene([
        Mass("handle", "0.05"), Spring("handle", "block", 812), Damper("block", "handle", "0.57"),
        Mass("block", "0.23"), Contact("block", "ground", 3100, 2, "0.004"),
    ])  # fmt: skip


def relaxation():
    time = np.linspace(0, 2, 200)
    depth = 0.005 * np.clip(time / 0.05, 0, 1)
    force = zw.tissue.force_response(zw.StandardLinearSolid(310, 145, 60), time, depth)
    noise = np.random.default_rng(7).normal(0, 0.01, time.size)
    return zw.tissue.fit_test(time, depth, force + noise, models=("kelvin-voigt", "standard-linear-solid"))


def identified():
    return zw.identify(zw.read_log(zw.samples.path("session.csv"), resolution="20 um"))


def shaken():
    return zw.diagnose(zw.samples.path("shaking.csv"), zw.load(zw.samples.path("wheel.toml")).device)


def laws(count):
    wall = zw.Wall(2000)
    of_all = standard_laws(PADDLE, wall)
    return zw.compare(PADDLE, wall, {name: of_all[name] for name in list(of_all)[:count]})


def arm(name, stiffness):
    space = zw.workspace(built_in(name, damping=0.003), zw.Wall(stiffness), rate=1000, points=12)
    return plots.workspace_figure(space)


def null_space():
    finger = zw.arms.PlanarChain(
        links=(0.1, 0.08, 0.06), damping=(0.05,) * 3, coulomb_friction=(0.01,) * 3,
        joint_range=((-2, 2), (0, 2.6), (-2, 2.6)),
    )  # fmt: skip
    return zw.null_space(finger, zw.Wall(200), rate=1000, stiffness=0.5, rest=(0.2, 1.0, 0.6), within=0.02)


def served():
    trace = zw.simulate(PADDLE, zw.Wall(770), zw.operators.Dowel(), 0.3)
    kept = np.delete(np.arange(trace.sizes["time"]), [100, 101])
    columns = {
        "measured_position": trace["measured_position"].values[kept],
        "wished_force": 1.1 * trace["commanded_force"].values[kept],
        "commanded_force": trace["commanded_force"].values[kept],
        "late": np.abs(np.random.default_rng(1).normal(0, 2e-5, kept.size)),
        "status": np.where(np.arange(kept.size) == 200, 1.0, 0.0),
    }
    return xr.Dataset(
        {name: ("sample", values) for name, values in columns.items()},
        coords={"sample": kept, "time": ("sample", trace["time"].values[kept])},
        attrs={"title": "a wall on a stand-in", "motion": "linear"},
    )


def late(deviation):
    values = np.abs(np.random.default_rng(1).normal(0, deviation, 3000)) + 1e-6
    return SimpleNamespace(late=values, worst=values.max(), quantile=partial(np.quantile, values))


def indices():
    return zw.ports.passivity_indices(TransferFunction([1, 1, 5, 0.1], [1, 2, 3, 4]))


DRIVE = WHEEL.replace(damping="0.02", coulomb_friction="0.05", resolution="0.0001", name="wheel")
KNOB = zw.rotary(
    inertia=2e-5, damping="12.345 uN*m*s/rad", coulomb_friction="0.123456 mN*m", resolution="0.3 mrad",
    rate="8 kHz",
)  # fmt: skip
CHECKED = {
    "in contact": (PADDLE, zw.Wall(200, "0.05", velocity_filter=SLOW)),
    "late": (PADDLE.replace(delay=0.0023), zw.StandardLinearSolid(100, 100, 0.2)),
    "a peak": (IDEAL, zw.PulseTransferFunction([100, -190, 99.9], [1, -1.9, 0.99999])),
    "rounds": (PADDLE.replace(resolution=22.4e-4), zw.Wall(150)),
    "a cable": (ON_A_CABLE, zw.Wall(400)),
    "a scene": (FREE.replace(damping=1), zw.VirtualCoupling(300, "0.1", scene())),
    "a soft wheel": (DRIVE, zw.Wall("1.23456789")),
    "a damped wheel": (DRIVE, zw.Wall("22.918", "0.0028571")),
    "a late wheel": (DRIVE.replace(delay="10 ms"), zw.StandardLinearSolid("0.16667", "0.25", "0.0005")),
    "a wheel of intervals": (
        DRIVE.replace(sample_period=("1 ms", "3 ms"), delay=("0 ms", "3 ms")),
        zw.Wall("22.9"),
    ),
    "a knob": (KNOB, zw.Wall("0.01")),
    "a damped knob": (KNOB, zw.Wall("0.3", "1.76e-6")),
    "a contact": (PADDLE, zw.HuntCrossley(20000)),
    "detents": (PADDLE, zw.NonlinearSpring.detents(4, "8 mm", "5 N")),
}
"""Large numbers and small ones; in degrees, in which a damping is small."""
OTHERS = {
    "storage": lambda: plots.storage(zw.available_storage(PADDLE, zw.Wall(700, 0.05), **SHORT)),
    "cycle": lambda: plots.cycle(zw.available_storage(PADDLE, zw.Wall(950, 0.05), **SHORT).witness),
    "sweep of one": lambda: plots.sweep_figure(swept("damping")),
    "sweep of two": lambda: plots.sweep_figure(swept("stiffness", "damping"), "max_stiffness"),
    "sweep of three": lambda: plots.sweep_figure(swept("stiffness", "damping", "delay")),
    "eight traces": lambda: several(8),
    "scene": lambda: scene().plot(),
    "tissue": lambda: relaxation().plot(),
    "identify": lambda: identified().plot(),
    "diagnose": lambda: shaken().plot(),
    "laws": lambda: laws(8).plot(),
    "links": lambda: zw.links.compare(FREE).plot(),
    "pair": lambda: zw.check(PAIR.replace(stiffness="270 N*m/rad")).plot(),
    "held pair": lambda: zw.check(HELD, follower=HAND).plot(),
    "both arms": lambda: zw.simulate(PAIR, zw.operators.ConstantForce(force=0.5), None, 0.2).zwidth.plot(),
    "plane of a map": lambda: arm("two-link", 100),
    "line of a map": lambda: arm("hapkit", 100),
    "null space": lambda: null_space().plot(),
    "served": lambda: plots.recording_figure(served()),
    "lateness": lambda: plots.plot_lateness(
        SimpleNamespace(sample_period=1e-3, ordinary=late(2e-4), real_time=late(5e-6))
    ),
    "indices": lambda: plots.indices(indices()),
}
SHORT = {"penetration": "0.0005", "speed": "0.3"}


@pytest.mark.parametrize("name", CHECKED)
def test_the_picture_of_every_kind_of_verdict_has_no_faults(name):
    with answers_in("deg"):
        assert faults_of_ours(zw.check(*CHECKED[name]).plot()) == []


@pytest.mark.parametrize("name", OTHERS)
def test_a_picture_of_every_other_kind_has_no_faults(name):
    """In degrees, for which every axis has to ask."""
    with answers_in("deg"):
        figure = OTHERS[name]()
    assert faults_of_ours(figure) == []
    labels = [text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel())]
    assert [text for text in labels if "rad" in text] == []


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
