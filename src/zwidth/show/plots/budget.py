"""The budget: what leaks energy, against what takes it out.

At the tightest frequency the hold, the law's own dynamics and the delay each
ask for damping, and b pays; for one encoder count the law asks for Coulomb
friction, and f_c pays.  A share below zero helps.
"""

from __future__ import annotations

from math import isfinite

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.show.plots.style import (
    BLACK,
    GREY,
    LOOK,
    ORANGE,
    PURPLE,
    SKY,
    drawn_in,
    label,
    new_figure,
    number,
    symbol,
)

_SHARES = (
    ("hold", "hold, K T/2", SKY),
    ("dynamics", "dynamics of the law", PURPLE),
    ("delay", "delay", ORANGE),
)
_TINY = 1e-9


@rc_context(LOOK)
def budget(verdict: LinearVerdict) -> Figure:
    """Leaks against dissipation as bars: damping above, Coulomb friction below.

    The second pair is left out for an ideal encoder.
    """
    figure = new_figure(6.4, 3.6 if has_friction(verdict) else 2.2)
    rows = figure.subplots(2 if has_friction(verdict) else 1, 1, squeeze=False)
    draw_damping(rows[0][0], verdict)
    if has_friction(verdict):
        draw_friction(rows[1][0], verdict)
    return figure


def has_friction(verdict: LinearVerdict) -> bool:
    """True when the encoder asks for anything."""
    return verdict.device.exact("resolution") > 0


def draw_damping(axes: Axes, verdict: LinearVerdict) -> None:
    """Shares of the required damping, stacked, above the device's damping."""
    account, motion = verdict.budget, verdict.device.motion
    factor, _ = drawn_in("damping", motion)
    if isfinite(account.required) and verdict.required_damping is not None:
        _stack(axes, [(factor * getattr(account, key), text, colour) for key, text, colour in _SHARES])
        asked = factor * account.required
        if account.required < account.hold + max(account.dynamics, 0) + max(account.delay, 0) - _TINY:
            total = f"asked in all: {number(asked)}"
            axes.plot([asked] * 2, [0.6, 1.4], color=BLACK, lw=2, label=total)
    else:
        axes.text(0.02, 0.72, "no damping is enough", transform=axes.transAxes)
    has = factor * account.damping
    axes.barh(0, has, height=0.6, color=BLACK, gid="b")
    _finish(axes, ("leaks", f"b = {number(has)}"))
    axes.set_xlabel(label("damping", motion))


def draw_friction(axes: Axes, verdict: LinearVerdict) -> None:
    """What one encoder count asks for, above the device's Coulomb friction."""
    account, motion = verdict.budget, verdict.device.motion
    need = account.friction_required
    if need is not None:
        name = "K Δ/2" if verdict.decision.is_spring else "largest force error"
        _stack(axes, [(need, f"one encoder count, {name}", SKY)])
    else:
        axes.text(0.02, 0.72, "no sufficient friction is known for this law", transform=axes.transAxes)
    axes.barh(0, account.coulomb_friction, height=0.6, color=BLACK, gid="f_c")
    _finish(axes, ("leaks", f"{symbol('coulomb_friction')} = {number(account.coulomb_friction)}"))
    axes.set_xlabel(label("coulomb_friction", motion, "Coulomb friction"))


def _stack(axes: Axes, shares: list[tuple[float, str, str]]) -> None:
    """Positive shares to the right of zero one after the other, negative ones to the left."""
    ends = {True: 0.0, False: 0.0}
    largest = max(abs(value) for value, _, _ in shares)
    if largest == 0:
        axes.text(0.01, 1, "nothing", va="center", transform=axes.get_yaxis_transform())
    for value, text, colour in shares:
        if abs(value) > _TINY * largest:
            axes.barh(
                1, value, left=ends[value > 0], height=0.6, color=colour, edgecolor="white",
                label=f"{text}: {number(value)}", gid="leak",
            )  # fmt: skip
            ends[value > 0] += value


def _finish(axes: Axes, names: tuple[str, str]) -> None:
    axes.set_yticks([1, 0], names)
    axes.set_ylim(-0.5, 1.5)
    axes.axvline(0, color=GREY, lw=0.8)
    axes.margins(x=0.06)
    if not axes.dataLim.width:
        axes.set_xlim(0, 1)
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    handles, _ = axes.get_legend_handles_labels()
    if handles:
        axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=2, borderaxespad=0.2, handlelength=1.2)
