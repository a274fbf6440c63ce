"""The dimensionless plane of a spring wall: β = b/(K T) against σ = f_c/(K Δ).

A device is a straight line of slope 1 on logarithmic axes: a stiffer wall lies further down and to the left.
Passive at and beyond ½ on both axes (Abbott & Okamura 2005); the four regions are those of Diolaiti,
Niemeyer, Barbagli & Salisbury (2006).
"""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, floor, log10

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.errors import InputError
from zwidth.model.device import Device, catalogue
from zwidth.passivity.formulas.abbott_okamura import stiffness_of_wall
from zwidth.passivity.formulas.diolaiti import plane_point
from zwidth.quantity.exact import Exact, RealLike
from zwidth.show.plots.style import (
    BLUE,
    GREEN,
    GREY,
    LOOK,
    RED,
    SMALL,
    drawn_in,
    heading,
    legend,
    low_index,
    new_figure,
    note,
    number,
    quantity_text,
    shown_name,
    verbatim,
)

_NEEDED = ("damping", "coulomb_friction", "resolution")


@rc_context(LOOK)
def plane(device: Device, stiffness: RealLike | None = None, with_catalogue: bool = True) -> Figure:
    """The plane with a device's line, its stiffness marked, and the catalogue's devices.

    Parameters
    ----------
    device
        Certain values; b, f_c and Δ > 0 and no delay.
    stiffness
        K > 0 [N/m; N·m/rad] to mark; the largest passive one if not given.
    with_catalogue
        Draw the catalogue's devices too, those whose b, T, f_c and Δ are published.

    Raises
    ------
    InputError
        If the device has no line in the plane.
    """
    figure = new_figure(height=5.4)
    draw_plane(figure.add_subplot(), device, stiffness, with_catalogue)
    return figure


def has_plane(device: Device) -> bool:
    """True when a device has a line in the plane: b, f_c, Δ > 0 and no delay."""
    return all(device.exact(key) > 0 for key in _NEEDED) and device.exact("delay") == 0


def draw_plane(
    axes: Axes, device: Device, stiffness: RealLike | None = None, with_catalogue: bool = True
) -> None:
    """The same on given axes."""
    if not has_plane(device):
        raise InputError(
            "the plane has logarithmic axes b/(K T) and f_c/(K Δ): it needs damping, coulomb_friction "
            "and resolution > 0 and a device without delay"
        )
    given = largest_spring_of(device) if stiffness is None else stiffness_of_wall(stiffness)
    point, at_limit = plane_point(device, given), place_at_limit(device)
    k, beta, sigma = float(given), float(point.viscous), float(point.dry)
    others = _others(device) if with_catalogue else []
    x = ends_around(beta, at_limit[0], *(place_at_limit(other)[0] for other in others))
    y = ends_around(sigma, at_limit[1], *(place_at_limit(other)[1] for other in others))
    _regions(axes, x, y, sigma > beta)
    _mark_others(axes, others)
    left_out = len(catalogue.names()) - len(list(complete_devices())) if with_catalogue else 0
    if left_out:
        unknown = low_index("b, T, f_c or Δ is unpublished")
        note(axes, f"{left_out} devices of the catalogue have no place here: {unknown}.")
    _line(axes, device, (beta * k, sigma * k), x, y)
    passive = point.region == "globally stable"
    text = f"{shown_name(device)}, K = {quantity_text(k, 'stiffness', device.motion)}: {point.region}"
    colour = GREEN if passive else RED
    axes.plot([beta], [sigma], "o", color=colour, ms=8, zorder=6, gid="device", label=verbatim(text))
    legend(axes)
    heading(axes, "a stiffer wall lies further down and to the left")


def largest_spring_of(device: Device) -> Exact:
    """The largest passive stiffness, exactly: there the smaller of β and σ is ½."""
    point = plane_point(device, 1)
    assert isinstance(point.dry, Exact)
    return Exact(2 * min(point.viscous.fraction, point.dry.fraction))


def place_at_limit(device: Device) -> tuple[float, float]:
    """(β, σ) at the largest passive stiffness."""
    point = plane_point(device, largest_spring_of(device))
    return float(point.viscous), float(point.dry)


def ends_around(*values: float) -> tuple[float, float]:
    """Ends of an axis around ½ and these values, with a third of it and more on either side of ½."""
    low, high = min(0.05, *(v / 6 for v in values)), max(5.0, *(v * 8 for v in values))
    return min(low, 0.5 / (high / 0.5) ** 0.5), max(high, 0.5 * (0.5 / low) ** 0.5)


def _regions(axes: Axes, x: tuple[float, float], y: tuple[float, float], above: bool) -> None:
    """Axes and the four regions, their names on the side where the device's line is not."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*x)
    axes.set_ylim(*y)
    axes.axvline(0.5, color=GREY, lw=1)
    axes.axhline(0.5, color=GREY, lw=1)
    axes.fill_between([0.5, x[1]], 0.5, y[1], color=GREEN, alpha=0.14, lw=0)
    right, left, top, bottom = (x[1], -6, "right"), (x[0], 6, "left"), (y[1], -5, "top"), (y[0], 5, "bottom")
    over, under, beside, before = (0.5, 5, "bottom"), (0.5, -5, "top"), (0.5, 6, "left"), (0.5, -6, "right")
    places = {
        "globally stable\n(passive)": (right, over) if above else (beside, top),
        "limit cycles\n(small motions\ngain)": (right, bottom),
        "locally stable\n(fast motions\ngain)": (left, top),
        "globally\nunstable": (before, bottom) if above else (left, under),
    }
    for name, ((u, du, ha), (v, dv, va)) in places.items():
        colour = GREEN if "passive" in name else GREY
        axes.annotate(
            name, (u, v), (du, dv), textcoords="offset points", ha=ha, va=va, fontsize=SMALL, color=colour
        )
    axes.set_xlabel("β = b/(K T)   damping against sampling")
    axes.set_ylabel(low_index("σ = f_c/(K Δ)   dry friction against the encoder"))


def _line(
    axes: Axes, device: Device, at_one: tuple[float, float], x: tuple[float, float], y: tuple[float, float]
) -> None:
    """The device over the stiffnesses that the picture holds, with decades of K marked."""
    beta, sigma = at_one
    softest = max(beta / x[1], sigma / y[1])
    stiffest = min(beta / x[0], sigma / y[0])
    axes.plot(
        [beta / softest, beta / stiffest], [sigma / softest, sigma / stiffest],
        color=BLUE, lw=1.8, gid="stiffnesses",
    )  # fmt: skip
    factor, unit = drawn_in("stiffness", device.motion, [stiffest])
    ends = (ceil(log10(softest * factor * 1.1)), floor(log10(stiffest * factor / 1.1)) + 1)
    decades = [10.0**n / factor for n in range(*ends)]
    for k in decades:
        axes.plot([beta / k], [sigma / k], "o", color=BLUE, mfc="white", ms=4, zorder=4)
        text = number(k * factor) + (f" {unit}" if k == decades[0] else "")
        if log10(beta / k / x[0]) > 0.15 * log10(x[1] / x[0]):
            at, side = (-5, 3), "right"
        else:  # before the upright axis there are its own numbers
            at, side = (5, -9), "left"
        axes.annotate(
            text, (beta / k, sigma / k), at, textcoords="offset points", ha=side, fontsize=SMALL, color=BLUE
        )


def _others(device: Device) -> list[Device]:
    """The devices of the catalogue that have a line of their own in the plane."""
    mine = place_at_limit(device), largest_spring_of(device)
    return [
        other for other in complete_devices() if (place_at_limit(other), largest_spring_of(other)) != mine
    ]


def _mark_others(axes: Axes, others: list[Device]) -> None:
    """Where they are at their largest passive stiffness."""
    for other in others:
        k = quantity_text(float(largest_spring_of(other)), "stiffness", other.motion)
        axes.plot(*([v] for v in place_at_limit(other)), "s", color=GREY, ms=5, gid="catalogue")
        axes.annotate(
            f"{other.name} at {k}",
            place_at_limit(other), (7, 5), textcoords="offset points", fontsize=SMALL, color=GREY,
        )  # fmt: skip


def complete_devices() -> Iterator[Device]:
    """The catalogue's devices whose b, T, f_c and Δ are all published."""
    for name in catalogue.names():
        known = catalogue.entry(name).known()
        timed = "rate" in known or "sample_period" in known
        if timed and all(key in known for key in _NEEDED):
            device = catalogue.device(name)
            if has_plane(device):
                yield device
