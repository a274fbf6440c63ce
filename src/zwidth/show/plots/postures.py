"""The stiffest wall that an arm bears at every posture tried, by where its hand is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from zwidth.quantity.text import unit_text
from zwidth.show.plots.style import LOOK, OUTCOME, new_figure, note, page_heading

if TYPE_CHECKING:
    from zwidth.passivity.workspace import PostureMap


@rc_context(LOOK)
def postures_figure(found: PostureMap) -> Figure:
    """By distance from the first axis and height: the least of the postures in each cell.

    Parameters
    ----------
    found
        What `zwidth.stiffness_over_postures` returned.
    """
    name = "largest_stiffness" if "largest_stiffness" in found.data else "stiffness_factor"
    data = found.data[name]
    values = np.asarray(data.values, dtype=np.float64)
    known = values[np.isfinite(values)]
    figure = new_figure(5.4, 5.0)
    axes = figure.add_subplot()
    colours = axes.pcolormesh(
        found.data["radius"],
        found.data["height"],
        values.T,
        cmap="viridis",
        vmin=float(known.min()),
        vmax=float(np.percentile(known, 95)),
        shading="nearest",
        rasterized=True,
    )
    label = f"{name.replace('_', ' ')} [{unit_text(data.attrs['units']) or '1'}]"
    figure.colorbar(colours, ax=axes, label=label, extend="max")
    axes.set_aspect("equal")
    axes.set_xlabel("distance from the first axis [m]")
    axes.set_ylabel("height [m]")
    note(axes, "the least of the postures tried in each cell; between them nothing is proved")
    page_heading(figure, f"{found.question.arm.name}: {found.tried} postures", color=OUTCOME[found.outcome])
    return figure
