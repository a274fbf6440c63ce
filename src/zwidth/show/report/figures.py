"""The pictures of a verdict, each by itself, and what can be seen in them.

They are drawn with the defaults of matplotlib, whatever the settings of the person are, so that the same
verdict gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isfinite
from typing import Any

from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.result import Answer
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import shown, told
from zwidth.showing import Picture

_WIDTH = 6.0
_HEIGHTS = {"plane": 5.0, "motion": 5.0, "budget": 3.6}
"""Inches; the others are 3.8 high."""

_CAPTIONS = {
    "criterion": "The damping that the loop asks for, and what the device has. The loop is passive against "
    "every sustained motion where the curve stays at or below the line, up to half the sample rate.",
    "plane": "Where the loop lies: viscous friction against sampling, Coulomb friction against the encoder. "
    "Passive at and beyond ½ on both axes.",
    "budget": "What feeds energy in, against what the device takes out.",
    "motion": "The motion that takes energy out: position, held force and energy.",
    "storage": "The most energy that a hand can take out, from each position on.",
    "scene": "The scene that is rendered.",
}


def pictures(verdict: Answer, ending: str = "svg") -> list[Picture]:
    """Every picture of a verdict, as "svg" or "png"; none where there is nothing to draw."""
    from matplotlib import style

    with style.context("default"):
        return list(_pictures(verdict, ending))


def _pictures(verdict: Answer, ending: str) -> Iterator[Picture]:
    from zwidth.show.plots.files import encoded
    from zwidth.show.plots.report import panel_figure, panels_of

    kind = {"svg": "svg+xml"}.get(ending, ending)
    if isinstance(verdict, Verdict):
        for name, draw in panels_of(verdict).items():
            figure = panel_figure(draw, verdict, _WIDTH, _HEIGHTS.get(name, 3.8))
            yield Picture(encoded(figure, ending), kind, _SAYS[name](verdict), _CAPTIONS[name])
    elif verdict.PICTURE:
        yield Picture(encoded(verdict.figure(), ending), kind, verdict.describe())


def _criterion(verdict: LinearVerdict) -> str:
    unit = verdict.device.unit("damping")
    account = verdict.budget
    most = told(account.required, unit, 4) if isfinite(account.required) else "any amount"
    return (
        f"Curve of required damping against frequency: highest at {shown(account.frequency, 'Hz')}, with "
        f"{most}; a line marks the device's {told(account.damping, unit, 4)}."
    )


def _plane(verdict: LinearVerdict) -> str:
    from zwidth.passivity.formulas.diolaiti import plane_point

    stiffness = verdict.decision.loop.static_stiffness
    assert stiffness is not None
    point = plane_point(verdict.device, stiffness)
    return (
        f"Plane of viscous against Coulomb friction: the loop lies at {float(point.viscous):.4g} and "
        f"{float(point.dry):.4g}, in the region {point.region}."
    )


def _budget(verdict: LinearVerdict) -> str:
    unit = verdict.device.unit("damping")
    account = verdict.budget
    shares = {"the hold": account.hold, "the law": account.dynamics, "the delay": account.delay}
    asked = ", ".join(
        f"{name} {told(value, unit, 4)}" for name, value in shares.items() if isfinite(value) and value
    )
    return f"Bars: asked for by {asked or 'nothing'}; the device has {told(account.damping, unit, 4)}."


def _motion(verdict: Verdict) -> str:
    assert verdict.witness is not None
    return f"Position, force and energy against time: {verdict.witness.describe()}."


_SAYS: dict[str, Callable[[Any], str]] = {
    "criterion": _criterion,
    "plane": _plane,
    "budget": _budget,
    "motion": _motion,
    "storage": lambda verdict: (
        "Curve of the available storage against position; it is finite and nowhere below 0."
    ),
    "scene": lambda verdict: f"Diagram of the {verdict.environment.describe(verdict.device.motion)}.",
}
