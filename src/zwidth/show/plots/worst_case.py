"""Worst-case J* of a spring wall behind an encoder (Abbott & Okamura 2005, figures 4 and 5).

J* is how much more the wall takes than an ideal spring would over one sample,
at the worst phase of the encoder, against λ, how far the hand comes out.
Below 2b/T (their figure 4) both curves lie above their lines, and going in by λ
and out by λ loses energy if the lines do; beyond it (figure 5) a large enough
step gains energy both ways.
"""

from __future__ import annotations

from fractions import Fraction

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.passivity.formulas.abbott_okamura import linear_worst_case
from zwidth.passivity.formulas.abbott_okamura import worst_case as worst_case_at
from zwidth.passivity.formulas.diolaiti import plane_point
from zwidth.quantity.exact import Exact, RealLike
from zwidth.show.plots.style import (
    BLUE,
    GREY,
    LOOK,
    ORANGE,
    heading,
    label,
    new_figure,
    quantity_text,
    scale,
    shown_name,
)

_POINTS = 100


@rc_context(LOOK)
def worst_case(device: Device, stiffness: RealLike, span: RealLike | None = None) -> Figure:
    """J* against λ, compression on the left and release on the right, with the linear worst case.

    Parameters
    ----------
    device
        Certain values, Δ > 0, no delay.
    stiffness
        K > 0 [N/m; N·m/rad].
    span
        Largest |λ| [m; rad]; if not given, where the quadratic part has grown
        to twice the linear one, and at least four encoder counts.

    Raises
    ------
    InputError
        If the formulas do not apply or `span` ≤ 0.
    """
    figure = new_figure()
    draw_worst_case(figure.add_subplot(), device, stiffness, span)
    return figure


def draw_worst_case(axes: Axes, device: Device, stiffness: RealLike, span: RealLike | None = None) -> None:
    """The same on given axes."""
    region = plane_point(device, stiffness).region
    reach = _span(device, Exact(stiffness).fraction) if span is None else Exact(span).fraction
    if reach <= 0:
        raise InputError(f"span must be > 0, got {span}: there is no motion to draw")
    steps = [reach * k / _POINTS for k in range(-_POINTS, _POINTS + 1)]
    curve = [float(worst_case_at(device, stiffness, Exact(s))) for s in steps]
    line = [float(linear_worst_case(device, stiffness, Exact(s))) for s in steps]
    energy, joules = scale([*curve, *line], "J")
    length, metres = scale([float(reach)], device.unit("position"))
    x = [length * float(s) for s in steps]
    axes.plot(x, [energy * j for j in curve], color=BLUE, label="worst case J*")
    axes.plot(x, [energy * j for j in line], color=ORANGE, ls="--", label="linear worst case")
    axes.axhline(0, color=GREY, lw=0.8)
    axes.axvline(0, color=GREY, lw=0.8)
    axes.set_xlim(x[0], x[-1])
    for place, word in ((0.25, "compression"), (0.75, "release")):
        axes.text(place, 0.02, word, transform=axes.transAxes, ha="center", va="bottom", color=GREY)
    axes.set_xlabel(f"way out in one sample λ [{metres}]")
    axes.set_ylabel(label("energy", text="beyond an ideal spring,", unit=joules).replace(" W ", " J* "))
    k = quantity_text(float(Exact(stiffness)), "stiffness", device.motion)
    text = f"{shown_name(device)}, K = {k}: {region}"
    heading(axes, text, parse_math=False)
    axes.margins(y=0.12)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2)


def _span(device: Device, k: Fraction) -> Fraction:
    count = device.exact("resolution")
    slope = max(device.exact("coulomb_friction"), abs(k * count - device.exact("coulomb_friction")))
    curvature = abs(device.exact("damping") / device.exact("sample_period") - k / 2)
    natural = 2 * slope / curvature if curvature else Fraction(0)
    return max(natural, 4 * count) or Fraction(1, 1000)
