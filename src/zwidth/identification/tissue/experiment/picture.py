"""A test as a picture: what the probe did, what the tissue answered and the best model, what is left over."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib import rc_context
from matplotlib.figure import Figure

from zwidth.identification.tissue.picture import draw_fit, draw_left, title
from zwidth.plots.style import BLACK, LOOK, new_figure, page_heading, scale

if TYPE_CHECKING:
    from zwidth.identification.tissue.experiment.result import TissueTest


@rc_context(LOOK)
def test_figure(test: TissueTest) -> Figure:
    """The response with the fit, what is left over, and the history that it answers."""
    figure = new_figure(7.4, 6.4)
    above, below, history = figure.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.0, 1.0))
    time = test.test.time
    draw_fit(above, test.best, time)
    draw_left(below, test.best, time)
    given, unit, name = (
        (test.test.force, "N", "force") if test.test.kind == "creep" else (test.test.depth, "m", "depth")
    )
    factor, shown_unit = scale(given, unit)
    history.plot(time, factor * given, color=BLACK, lw=1.2)
    history.set_ylabel(f"{name} [{shown_unit}]")
    history.set_xlabel("time t [s]")
    page_heading(figure, f"{test.test.kind} test, {title(test.best)}")
    return figure
