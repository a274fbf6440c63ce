"""Both sides of a limit: what proves the one value passive, and the motion that refutes the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec

from zwidth.errors import InputError
from zwidth.show.plots.storage import draw_storage
from zwidth.show.plots.style import LOOK, OUTCOME, heading, new_figure, number, page_heading, scale
from zwidth.show.plots.witness import draw_motion

if TYPE_CHECKING:
    from zwidth.passivity.bracket import Bracket


@rc_context(LOOK)
def limit_figure(bracket: Bracket) -> Figure:
    """The storage function at the value proved passive, beside the motion at the value refuted.

    A value that a closed condition proves for every hand has no storage function to draw.

    Parameters
    ----------
    bracket
        What `zwidth.limit` returned.

    Raises
    ------
    InputError
        If there is neither.
    """
    if bracket.storage is None and bracket.witness is None:
        raise InputError("there is neither a storage function nor a motion to draw")
    figure = new_figure(11.0, 5.0)
    sides = [
        *([_proved] if bracket.storage is not None else []),
        *([_refuted] if bracket.witness is not None else []),
    ]
    grid = figure.add_gridspec(1, len(sides))
    for k, draw in enumerate(sides):
        draw(figure, grid[k], bracket)
    page_heading(figure, bracket.describe())
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.08, hspace=0.06, wspace=0.05)
    return figure


def _proved(figure: Figure, place: SubplotSpec, bracket: Bracket) -> None:
    assert bracket.storage is not None
    axes = figure.add_subplot(place)
    draw_storage(axes, bracket.storage)
    text = f"{_values(bracket)[0]}\n{axes.get_title(loc='left')}"
    heading(axes, text, color=OUTCOME["passive"])


def _refuted(figure: Figure, place: SubplotSpec, bracket: Bracket) -> None:
    assert bracket.witness is not None
    rows = place.subgridspec(3, 1)
    top = figure.add_subplot(rows[0])
    axes = [top, *(figure.add_subplot(rows[k], sharex=top) for k in (1, 2))]
    for upper in axes[:-1]:
        upper.tick_params(labelbottom=False)
    draw_motion(axes, bracket.witness)
    text = f"{_values(bracket)[1]}\n{top.get_title(loc='left')}"
    heading(top, text, color=OUTCOME["active"])


def _values(bracket: Bracket) -> tuple[str, str]:
    """What was proved and what was refuted, to the four digits of a picture."""
    proved, refuted = bracket.outward((bracket.proved_passive, bracket.proved_active), 4)
    return _value(bracket, proved), _value(bracket, refuted)


def _value(bracket: Bracket, value: float | None) -> str:
    if value is None:
        return ""
    factor, unit = scale([value], bracket.unit)
    return f"{number(value * factor)} {unit}".rstrip()
