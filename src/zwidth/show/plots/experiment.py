"""A test as a picture: what the probe did, what the tissue answered and the best model, what is left over."""

from __future__ import annotations

from matplotlib import rc_context
from matplotlib.figure import Figure

from zwidth.data.tissue.experiment.history import History
from zwidth.show.plots.style import BLACK, LOOK, new_figure, page_heading, scale
from zwidth.show.plots.tissue import Fit, draw_fit, draw_left, title


@rc_context(LOOK)
def test_figure(test: History, best: Fit) -> Figure:
    """The response with the fit, what is left over, and the history that it answers."""
    figure = new_figure(7.4, 6.4)
    above, below, history = figure.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.0, 1.0))
    time = test.time
    draw_fit(above, best, time)
    draw_left(below, best, time)
    given, unit, name = (test.force, "N", "force") if test.kind == "creep" else (test.depth, "m", "depth")
    factor, shown_unit = scale(given, unit)
    history.plot(time, factor * given, color=BLACK, lw=1.2)
    history.set_ylabel(f"{name} [{shown_unit}]")
    history.set_xlabel("time t [s]")
    page_heading(figure, f"{test.kind} test, {title(best)}")
    return figure
