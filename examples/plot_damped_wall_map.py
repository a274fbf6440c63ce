"""
How much virtual damping does an encoder allow?
===============================================

Abbott & Okamura (2005) found how stiff a spring wall may be that is seen through
an encoder, and left virtual damping for future work.  With a velocity from
differenced counts the answer is again two inequalities::

    b ≥ KT/2 + B        f_c ≥ (K/2 + B/T) Δ

or, with β = b/(KT), σ = f_c/(KΔ) and β_v = B/(KT), β ≥ ½ + β_v and σ ≥ ½ + β_v.
Where both hold, no hand takes energy out, contact made and broken at will; where
one fails, some hand does.  Both are proved, for every hand.

The points on this page are proved in another way, count by count, by value iteration.
They are for hands of so many counts of depth and
so many counts per sample, and each is a bracket: passive below, by a storage
function, and active above, by a motion.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

import zwidth as zw
from zwidth.passivity.formulas.colgate_schenkel import window_damping
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
BLUE, RED, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#777777"
Number = Fraction | int


def device(friction: Number, damping: Number = 1) -> zw.Device:
    """Only ratios count: T = 1 and Δ = 1, and b = 1 unless given."""
    return zw.Device(
        damping=damping, coulomb_friction=friction, resolution=1, sample_period=1, delay=0, mass=1
    )


def largest_stiffness(
    friction: Number, damping: Number, start: Number, depth: int, reach: int, **law: Any
) -> tuple[float, float]:
    """Bracket of y = KT/(2b) for hands of so many counts of depth and counts per sample."""
    wall = zw.Wall(stiffness=2 * start, damping=damping, **law)
    found = zw.limit(device(friction), wall, penetration=depth, speed=reach)
    assert found.proved_passive
    assert found.proved_active
    return found.proved_passive / 2, found.proved_active / 2


def draw_bracket(axes: Axes, x: float, bracket: Sequence[float], marker: str, colour: str) -> None:
    """From proved to refuted, and a mark in the middle."""
    axes.plot([x, x], bracket, color=colour, lw=1.2)
    axes.plot(x, sum(bracket) / 2, marker, color=colour, mfc="white", ms=5.5, zorder=5)


# %%
# **(a) The plane.**  With x = B/b, y = KT/(2b) and ρ = f_c T/(bΔ) the law is x + y ≤ min(1, ρ):
# what counts is K + 2B/T, and virtual damping costs as much as a spring of 2B/T.  With ρ < 1
# Coulomb friction is what is missing, with ρ > 1 viscous damping.  A wall that never pulls has
# the same limits.
#
# Hands of at most 40 counts per sample allow a little more where viscous damping is missing, as
# friction helps against them.  The proof of the two inequalities goes interval by interval: for
# ρ > 1 and moves of at most R counts it gives x + y ≤ (ρ + R)/(1 + R), dotted.  At the lower
# right a soft wall that never pulls is a clamp and little else, as deep as these hands reach.

DEPTH = REACH = 40
RHOS = {Fraction(1, 2): RED, Fraction(2): BLUE}
plane_brackets = []
for rho in RHOS:
    limit = min(Fraction(1), rho)
    for x in (limit * (2 * k + 1) / 16 for k in range(8)):
        for clamped in (False, True):
            bracket = largest_stiffness(rho, x, limit - x, DEPTH, REACH, clamped=clamped)
            plane_brackets.append((rho, clamped, x, bracket))

# %%
# **(b) Friction.**  The smallest σ that value iteration proves, with b just large enough.  Moves
# of at most two counts are enough to meet the line: the hand that wins goes to and fro over one
# edge of the encoder.

friction_brackets = []
for beta_v in (Fraction(k, 4) for k in (0, 1, 2, 4, 6, 8, 12, 16)):
    wall = zw.Wall(stiffness=1, damping=beta_v)
    enough = Fraction(1, 2) + beta_v
    found = zw.limit(
        device(enough, enough), wall, "coulomb_friction", penetration=24, speed=2, tolerance=0.005
    )
    assert found.proved_passive
    assert found.proved_active
    friction_brackets.append((float(beta_v), (found.proved_active, found.proved_passive)))

# %%
# **(c) Many counts per sample.**  A device with friction to spare, ρ = 2.  The more counts the
# hand may cross in a sample, the less friction and encoder matter, and the limit falls to the
# linear criterion b = KT/2 + B.  The curves are the (ρ + R)/(1 + R) of (a), which is enough for
# any depth; with virtual damping and moves of a few counts value iteration finds that more is allowed.

SHARES = {Fraction(0): ("s", GREEN), Fraction(1, 4): ("o", BLUE), Fraction(1, 2): ("D", RED)}
reach_brackets = []
for x in SHARES:
    for reach in (2, 4, 8, 16, 32, 64):
        start = Fraction(2 + reach, 1 + reach) - x
        low, high = (y / float(1 - x) for y in largest_stiffness(2, x, start, 64, reach))
        reach_brackets.append((reach, x, (low, high)))

# %%
# **(d) A window of two samples.**  Here two conditions differ.  What is proved for every hand is
# x + y ≤ 1; beyond the linear criterion y + 9x/16 ≤ 1 a hand that stays inside wins.  Between the
# two there is neither a proof for every hand nor a motion that wins.  Hands of at most 8 counts
# per sample do not win there: their limits lie on the linear criterion or above it, the closer
# the farther they may move.

REACHES = {2: ("D", RED), 8: ("o", BLUE)}
window_brackets = []
for reach in REACHES:
    for x in (Fraction(k, 5) for k in range(1, 5)):
        linear = 1 - Fraction(9, 16) * x
        law = zw.rendering.Window(2)
        bracket = largest_stiffness(1, x, linear, 16, reach, velocity_filter=law)
        window_brackets.append((reach, x, float(linear), bracket))

# %%
# All four.

figure, ((plane, friction), (reaches, windows)) = plt.subplots(2, 2, figsize=(9.6, 8), layout="constrained")
for rho, colour in RHOS.items():
    limit = min(Fraction(1), rho)
    plane.fill([0, limit, 0], [0, 0, limit], color=colour, alpha=0.13, lw=0)
    plane.plot([0, limit], [limit, 0], color=colour, label=f"every hand, ρ = {float(rho):g}")
for rho, clamped, x, bracket in plane_brackets:
    draw_bracket(plane, float(x), bracket, "+" if clamped else "o", RHOS[rho])
bounded = (2 + REACH) / (1 + REACH)
plane.plot([0, bounded], [bounded, 0], ":", color=BLUE, lw=1.2, label=f"ρ = 2, {REACH} counts per sample")
plane.plot([], [], "o", color=GREY, mfc="white", label="value iteration: the wall may pull")
plane.plot([], [], "+", color=GREY, label="value iteration: never pulls")
plane.set(xlim=(0, 1.05), ylim=(0, 1.05), xlabel="virtual damping B/b", ylabel="stiffness KT/(2b)")
plane.set_title("(a) passive: x + y ≤ min(1, ρ)")
plane.legend(loc="upper right")

for damping, bracket in friction_brackets:
    draw_bracket(friction, damping, bracket, "o", RED)
friction.fill_between([0, 4.2], [0.5, 4.7], 5, color=GREEN, alpha=0.15, lw=0)
friction.plot([0, 4.2], [0.5, 4.7], color=RED, label="every hand: σ = ½ + β$_v$")
friction.plot([], [], "o", color=RED, mfc="white", label="value iteration: 24 counts deep, 2 per sample")
friction.text(0.5, 3.2, "passive", color="#00664A")
friction.set(
    xlim=(0, 4.2), ylim=(0, 5), xlabel="virtual damping β$_v$ = B/(KT)", ylabel="friction σ = f$_c$/(KΔ)"
)
friction.set_title("(b) friction that virtual damping asks for")
friction.legend(loc="lower right")

for x, (marker, colour) in SHARES.items():
    curve = [2 ** (1 + k / 20) for k in range(101)]
    formula = [((2 + r) / (1 + r) - float(x)) / float(1 - x) for r in curve]
    reaches.plot(curve, formula, color=colour, lw=1.2)
    reaches.plot([], [], marker, color=colour, mfc="white", label=f"B/b = {float(x):g}")
for reach, x, bracket in reach_brackets:
    draw_bracket(reaches, reach, bracket, *SHARES[x])
reaches.axhline(1, color=GREY, lw=1.2, ls="--")
reaches.text(2, 0.985, "linear criterion", color=GREY, va="top")
reaches.set(xscale="log", xticks=(2, 4, 8, 16, 32, 64), xticklabels=(2, 4, 8, 16, 32, 64), ylim=(0.9, 2.1))
reaches.minorticks_off()
reaches.set(xlabel="counts per sample R that the hand may cross", ylabel="K / K of the linear criterion")
reaches.set_title("(c) ρ = 2, hands up to 64 counts deep")
reaches.legend(loc="upper right")

ends = (0, 1)
needed = [1 - float(window_damping(0, x, 2, 1)) for x in ends]
windows.fill_between(ends, 0, (1, 0), color=GREEN, alpha=0.15, lw=0)
windows.plot(ends, (1, 0), color=GREEN, label="proved for every hand below")
windows.plot(ends, needed, "--", color=GREY, label="linear criterion: active above")
for reach, x, _, bracket in window_brackets:
    draw_bracket(windows, float(x), bracket, *REACHES[reach])
for reach, (marker, colour) in REACHES.items():
    text = f"value iteration: {reach} counts per sample"
    windows.plot([], [], marker, color=colour, mfc="white", label=text)
windows.set(xlim=(0, 1), ylim=(0, 1.05), xlabel="virtual damping B/b", ylabel="stiffness KT/(2b)")
windows.set_title("(d) window of 2 samples, ρ = 1, 16 counts deep")
windows.legend(loc="lower left")

# %%
# The numbers.


def off(line: float, bracket: Sequence[float]) -> float:
    """Largest relative distance of either end of a bracket from a line."""
    return max(abs(end / line - 1) for end in bracket)


print("bounded hands, proved and refuted by value iteration:")
for rho in (Fraction(1, 2), Fraction(2)):
    for clamped in (False, True):
        rows = [
            (min(1.0, float(r)) - float(x), ends)
            for r, c, x, ends in plane_brackets
            if (r, c) == (rho, clamped)
        ]
        above = [sum(bracket) / 2 - y for y, bracket in rows]
        kind = "never pulls" if clamped else "may pull"
        print(
            f"(a) ρ = {float(rho):g}, {kind}: KT/(2b) above the line by {min(above):.3f} to {max(above):.3f}"
        )
worst = max(off(0.5 + damping, bracket) for damping, bracket in friction_brackets)
print(f"(b) largest distance of σ from ½ + β_v, ends of the brackets: {worst:.2%}")
for reach in (2, 8, 64):
    lines = [f"{bracket[0]:.3f} to {bracket[1]:.3f}" for r, _, bracket in reach_brackets if r == reach]
    print(f"(c) R = {reach}: K over that of the linear criterion, B/b = 0, 1/4, 1/2: {'; '.join(lines)}")
for reach in (2, 8):
    above = [end / line - 1 for r, _, line, bracket in window_brackets if r == reach for end in bracket]
    print(f"(d) R = {reach}: above the linear criterion by {min(above):.2%} to {max(above):.2%}")
near = sum(off(0.5 + damping, bracket) < 0.01 for damping, bracket in friction_brackets)
print(f"friction: {near} of {len(friction_brackets)} brackets lie within 1 % of σ = ½ + β_v")
plt.show()
