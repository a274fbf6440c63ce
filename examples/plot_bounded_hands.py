"""
How much stiffer may the wall be for a real hand?
=================================================

The limits 2b/T and 2f_c/Δ of Abbott & Okamura (2005) hold for every hand, also
for one that moves by any distance within a sample.  No real hand does.  A hand
of speed v at most, on average over each sample, wins nothing as long as::

    K ≤ (2f_c + 2b v)/(Δ + v T)        that is, v ≤ (2f_c − K Δ)/(K T − 2b)

This is proved, whatever the depth.  What a bounded depth adds has no formula: the
available storage is computed count by count, and each point is a bracket, proved passive
below by a storage function and active above by a motion.
"""

from fractions import Fraction

import matplotlib.pyplot as plt

import zwidth as zw
from zwidth.passivity.bracket import Bracket
from zwidth.passivity.formulas.abbott_okamura import abbott_okamura_stiffness
from zwidth.passivity.storage.gain import Gain
from zwidth.show import plots

plt.rcParams.update(plots.LOOK)
paddle = zw.catalogue.device("haptic-paddle")
b, friction, count, period = (
    paddle.exact(name) for name in ("damping", "coulomb_friction", "resolution", "sample_period")
)
sampling, encoder = (float(k) for k in abbott_okamura_stiffness(b, friction, count, period))


def formula(speed: Fraction) -> float:
    """Largest stiffness that is proved for hands up to a speed, at any depth [N/m]."""
    return float(min((2 * friction + 2 * b * speed) / (count + speed * period), 2 * friction / count))


def bracket(depth: str, counts: int) -> Bracket:
    """The bracket for hands of so much depth [m] that move so many counts in a sample."""
    start = zw.Wall(stiffness=formula(counts * count / period))
    return zw.limit(paddle, start, penetration=depth, speed=counts * count / period)


def ends(found: Bracket) -> tuple[float, float]:
    """What is proved passive, and active: both are found for these hands [N/m]."""
    assert found.proved_passive
    assert found.proved_active
    return found.proved_passive, found.proved_active


# %%
# Speeds are whole counts per sample, from 1 to 134, which is 0.022 to 3 m/s.

DEPTHS = {
    "0.0002": ("D", "#009E73"),
    "0.0005": ("s", "#D55E00"),
    "0.002": ("o", "#0072B2"),
    "0.01": ("+", "#222222"),
}
counts = (1, 2, 4, 8, 23, 45, 134)
brackets = {(depth, n): bracket(depth, n) for depth in DEPTHS for n in counts}
winner = brackets["0.0002", 4]
assert isinstance(winner.witness, Gain)

# %%
# At 10 mm the brackets hold the formula, which is then the limit itself.  Where a hand could cross all of
# its depth in one sample the limit levels off: being faster helps it no more.
#
# On the right, what the hand must do just above the limit, here at 4 counts per sample and 0.2 mm: in,
# it stops each time just short of an edge of the encoder (dotted), so that little force is held; out, it
# stops each time on an edge, so that much is.  Friction takes the same from every move.

figure, axes = plt.subplot_mosaic(
    [["limit", "position"], ["limit", "force"], ["limit", "energy"]],
    figsize=(9.6, 5.2),
    width_ratios=(3, 2),
    layout="constrained",
)
left = axes["limit"]
for (depth, n), found in brackets.items():
    marker, colour = DEPTHS[depth]
    speed = float(n * count / period)
    left.plot([speed, speed], ends(found), color=colour, lw=1.2)
    left.plot(speed, sum(ends(found)) / 2, marker, color=colour, mfc="white", ms=5.5)
for depth, (marker, colour) in DEPTHS.items():
    text = f"value iteration: up to {1000 * float(depth):g} mm deep"
    left.plot([], [], marker, color=colour, mfc="white", label=text)
speeds = [Fraction(2 * 10 ** (k / 40)).limit_denominator(10**6) / 100 for k in range(89)]
left.plot(
    [*map(float, speeds)],
    [float(formula(v)) for v in speeds],
    color="#777777",
    lw=1.2,
    zorder=1,
    label="formula: any depth",
)
for limit, text in ((sampling, "2b/T: every hand"), (encoder, "2f$_c$/Δ: hands that creep")):
    left.axhline(limit, color="#777777", ls="--", lw=1)
    left.text(3.4, limit * 1.03, text, ha="right", va="bottom", color="#777777")
left.set(xscale="log", yscale="log", xlim=(0.018, 3.5), ylim=(250, 15_000))
left.set(xticks=(0.02, 0.05, 0.1, 0.2, 0.5, 1, 2), xticklabels=(0.02, 0.05, 0.1, 0.2, 0.5, 1, 2))
ticks = (300, 500, 1000, 2000, 5000, 10_000)
left.set(yticks=ticks, yticklabels=ticks)
left.minorticks_off()
left.set(xlabel="largest speed of the hand [m/s]", ylabel="largest passive stiffness K [N/m]")
left.set_title("Haptic Paddle: how stiff, for whom")
left.legend(loc="upper right", bbox_to_anchor=(1, 0.9))
plots.draw_cycle([axes[name] for name in ("position", "force", "energy")], winner.witness)
for name in ("position", "force"):
    axes[name].sharex(axes["energy"])
    axes[name].tick_params(labelbottom=False)

# %%
# The numbers.

print(f"every hand: {sampling:g} N/m; hands that creep: {encoder:.0f} N/m")
for n in counts:
    v = n * count / period
    both = [ends(brackets[depth, n]) for depth in ("0.0005", "0.01")]
    values = "; ".join(f"{low:.0f} to {high:.0f} N/m" for low, high in both)
    print(
        f"hands up to {float(v):.3f} m/s: {formula(v):.0f} N/m by the formula; 0.5 mm, 10 mm deep: {values}"
    )
deep = [(formula(n * count / period), *ends(brackets["0.01", n])) for n in counts]
hold = sum(low <= limit <= high for limit, low, high in deep)
print(f"10 mm deep: {hold} of {len(deep)} brackets hold the formula")
print(f"just above the limit, at {ends(winner)[1]:.0f} N/m: {winner.witness.describe()}")
print(f"admissible speed at 770 N/m: {zw.check(paddle, zw.Wall(stiffness=770)).admissible_speed:.3f} m/s")
half = Fraction(1, 2)
print(f"every hand: {sampling:g} N/m; hands up to {float(half):g} m/s: {formula(half):.0f} N/m")
plt.show()
