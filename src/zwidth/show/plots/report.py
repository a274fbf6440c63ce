"""Everything about one verdict in one picture."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec

from zwidth.errors import InputError
from zwidth.model.rendering import VirtualCoupling
from zwidth.model.scene import Scene
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.outcome_evidence import Moves
from zwidth.passivity.transmission import TransmissionVerdict
from zwidth.passivity.verdict import Verdict
from zwidth.show.plots.cables import draw_circle
from zwidth.show.plots.linear import draw_criterion, draw_damping, draw_friction, has_friction
from zwidth.show.plots.motions import draw_motion
from zwidth.show.plots.planes import draw_plane, has_plane
from zwidth.show.plots.scene import draw_scene, size_of
from zwidth.show.plots.storages import draw_storage
from zwidth.show.plots.style import (
    LOOK,
    OUTCOME,
    heading,
    new_figure,
    number,
    page_heading,
    scale,
    shown_name,
)

if TYPE_CHECKING:
    from zwidth.passivity.bracket import Bracket


Draw = Callable[[Figure, SubplotSpec, Any], None]

_HIGH, _LOW = 4.6, 3.5
"""Of a row of panels with a motion, on three axes, and of another [inch]."""


@rc_context(LOOK)
def check_figure(verdict: Verdict) -> Figure:
    """The criterion, the budget, and where they apply the plane, the witness and the scene, in one figure."""
    panels = list(panels_of(verdict).values())
    if not panels:
        raise InputError("there is nothing to draw of this verdict: it has neither H(z) nor a motion")
    rows = (len(panels) + 1) // 2
    heights = [_HIGH if _witness in panels[2 * row : 2 * row + 2] else _LOW for row in range(rows)]
    if panels[-1] is _scene and len(panels) % 2:
        heights[-1] = min(_HIGH, size_of(cast("Scene", scene_of(verdict)))[1])
    figure = new_figure(height=sum(heights) + 0.5)
    grid = figure.add_gridspec(rows, 2, height_ratios=heights)
    for k, draw in enumerate(panels):
        last_alone = k == len(panels) - 1 and k % 2 == 0
        draw(figure, grid[k // 2, :] if last_alone else grid[k // 2, k % 2], verdict)
    text = f"{shown_name(verdict.device)}: {verdict.outcome}. {verdict.claim}"
    page_heading(figure, text, color=OUTCOME[verdict.outcome])
    figure.set_layout_engine("constrained", w_pad=0.05, h_pad=0.05, hspace=0.05, wspace=0.03)
    return figure


@rc_context(LOOK)
def panel_figure(draw: Draw, verdict: Verdict, width: float, height: float) -> Figure:
    """One of `panels_of` by itself; sizes in inches."""
    figure = new_figure(width, height)
    draw(figure, figure.add_gridspec(1, 1)[0], verdict)
    return figure


def panels_of(verdict: Verdict) -> dict[str, Draw]:
    """What draws each picture that there is of a verdict, by name."""
    panels: dict[str, Draw] = {}
    if isinstance(verdict, LinearVerdict):
        panels["criterion"] = _criterion
        if verdict.decision.is_spring and has_plane(verdict.device) and verdict.decision.loop.numerator[0]:
            panels["plane"] = _plane
        panels["budget"] = _budget
    elif isinstance(verdict, TransmissionVerdict) and verdict.elastic is not None:
        panels["circle"] = _circle
    if verdict.witness is not None:
        panels["motion"] = _witness
    elif verdict.available_storage is not None and verdict.available_storage.storage is not None:
        panels["storage"] = _storage
    if scene_of(verdict) is not None:
        panels["scene"] = _scene
    return panels


def scene_of(verdict: Verdict) -> Scene | None:
    """The scene that is rendered, behind whatever couplings, if it is one."""
    met = verdict.environment.met
    while isinstance(met, VirtualCoupling):
        met = met.environment
    return met if isinstance(met, Scene) else None


def _scene(figure: Figure, place: SubplotSpec, verdict: Verdict) -> None:
    scene = scene_of(verdict)
    assert scene is not None
    draw_scene(figure.add_subplot(place), scene, verdict.device.motion)


def _criterion(figure: Figure, place: SubplotSpec, verdict: LinearVerdict) -> None:
    draw_criterion(figure.add_subplot(place), verdict)


def _circle(figure: Figure, place: SubplotSpec, verdict: TransmissionVerdict) -> None:
    draw_circle(figure.add_subplot(place), verdict)


def _plane(figure: Figure, place: SubplotSpec, verdict: LinearVerdict) -> None:
    draw_plane(figure.add_subplot(place), verdict.device, verdict.decision.loop.static_stiffness)


def _budget(figure: Figure, place: SubplotSpec, verdict: LinearVerdict) -> None:
    if not has_friction(verdict):
        axes = figure.add_subplot(place)
        draw_damping(axes, verdict)
        axes.set_ylim(-1.2, 2.2)  # two bars in the room of four
        return
    rows = place.subgridspec(2, 1)
    draw_damping(figure.add_subplot(rows[0]), verdict)
    draw_friction(figure.add_subplot(rows[1]), verdict)


def _witness(figure: Figure, place: SubplotSpec, verdict: Verdict) -> None:
    assert verdict.witness is not None
    _three(place, verdict.witness)


def _three(place: SubplotSpec, motion: Moves) -> list[Axes]:
    """A motion on three axes one above the other, so low that units stand below what they are of."""
    rows: list[Axes] = place.subgridspec(3, 1).subplots(sharex=True, squeeze=False)[:, 0].tolist()
    draw_motion(rows, motion)
    for axes in rows:
        axes.set_ylabel(axes.get_ylabel().replace(" [", "\n["))
    return rows


def _storage(figure: Figure, place: SubplotSpec, verdict: Verdict) -> None:
    assert verdict.available_storage is not None
    assert verdict.available_storage.storage is not None
    draw_storage(figure.add_subplot(place), verdict.available_storage.storage)


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
    figure = new_figure(height=5.0)
    both = ((_proved, bracket.storage), (_refuted, bracket.witness))
    sides = [draw for draw, found in both if found is not None]
    grid = figure.add_gridspec(1, len(sides))
    for k, draw in enumerate(sides):
        draw(figure, grid[k], bracket)
    page_heading(figure, bracket.describe())
    figure.set_layout_engine("constrained", w_pad=0.05, h_pad=0.05, hspace=0.05, wspace=0.03)
    return figure


def _proved(figure: Figure, place: SubplotSpec, bracket: Bracket) -> None:
    assert bracket.storage is not None
    axes = figure.add_subplot(place)
    draw_storage(axes, bracket.storage)
    text = f"{_values(bracket)[0]}\n{axes.get_title(loc='left')}"
    heading(axes, text, color=OUTCOME["passive"])


def _refuted(figure: Figure, place: SubplotSpec, bracket: Bracket) -> None:
    assert bracket.witness is not None
    top, *_ = _three(place, bracket.witness)
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
