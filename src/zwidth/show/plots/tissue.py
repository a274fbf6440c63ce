"""A fit of a tissue as a picture: measured and fitted, and what is left over."""

from __future__ import annotations

from typing import Protocol

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.data.tissue.model import Model
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.text import quantity_unit
from zwidth.show.plots.style import BLUE, GREY, LOOK, RED, heading, new_figure, page_heading, scale

MOST_DOTS = 4000


class Fit(Protocol):
    """What is drawn of a fit."""

    @property
    def time(self) -> Array | None:
        """Of the samples [s]."""

    @property
    def output(self) -> Array:
        """What was measured, in SI."""

    @property
    def residuals(self) -> Array:
        """Measured less fitted, in SI."""

    @property
    def response(self) -> str:
        """What was measured, force or position."""

    @property
    def motion(self) -> str:
        """Linear or rotary."""

    @property
    def model(self) -> Model:
        """Which model was fitted."""

    def table(self) -> list[list[str]]:
        """Its numbers, a line each, below a line of headings."""


@rc_context(LOOK)
def fit_figure(fit: Fit) -> Figure:
    """Measured and fitted against the time; below, what is left over.

    Raises
    ------
    InputError
        If the times are not known.
    """
    if fit.time is None:
        raise InputError("this fit does not hold the times of its samples: there is nothing to draw")
    figure = new_figure(7.4, 5.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
    draw_fit(above, fit, fit.time)
    draw_left(below, fit, fit.time)
    below.set_xlabel("time t [s]")
    page_heading(figure, title(fit))
    return figure


def title(fit: Fit) -> str:
    """The model and its numbers, on a line."""
    rows = fit.table()[1 : 1 + len(fit.model.parameters)]
    numbers = ", ".join(f"{row[0].replace('_', ' ')} {float(row[1]):.4g} {row[3]}" for row in rows)
    return f"{fit.model.name}: {numbers}"


def draw_fit(axes: Axes, fit: Fit, time: Array) -> None:
    """Dots measured, a line fitted."""
    factor, unit = scale(fit.output, quantity_unit(fit.response, fit.motion))
    every = slice(None, None, max(1, time.size // MOST_DOTS))
    axes.plot(time[every], factor * fit.output[every], ".", ms=5, color=GREY, mew=0, label="measured")
    axes.plot(
        time, factor * (fit.output - fit.residuals), color=BLUE, lw=1.4, label=f"{fit.model.name}, fitted"
    )
    axes.set_ylabel(f"{'force' if fit.response == 'force' else 'depth'} [{unit}]")
    axes.legend(loc="best")


def draw_left(axes: Axes, fit: Fit, time: Array) -> None:
    """Measured less fitted: noise, if the model is right."""
    factor, unit = scale(fit.residuals, quantity_unit(fit.response, fit.motion))
    every = slice(None, None, max(1, time.size // MOST_DOTS))
    axes.axhline(0.0, color=GREY, lw=0.8)
    axes.plot(time[every], factor * fit.residuals[every], ".", ms=2.5, color=RED, mew=0)
    axes.set_ylabel(f"left over [{unit}]")
    heading(axes, "measured less fitted: noise, where the model is right")
