"""
What does each rendering law give for the stiffness that it keeps?
==================================================================

Three devices of the catalogue are asked for a wall twice as stiff as their viscous damping pays for,
K = 4b/T.  Every law of the bench renders it: :doc:`how they work </laws>`.  Of the haptic paddle all
numbers are published.  What the sources do not say is chosen here: 1 kHz and no Coulomb friction for the
course plant; a mass of 0.1 kg, no Coulomb friction and an ideal encoder for the PHANToM.
"""

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from numpy.typing import NDArray

import zwidth as zw
from zwidth.show import plots
from zwidth.study.bench import standard_laws

plt.rcParams.update(plots.LOOK)
chosen: dict[str, dict[str, Any]] = {
    "haptic-paddle": {},
    "course-plant": {"rate": "1 kHz", "coulomb_friction": 0},
    "phantom": {"mass": "0.1"},
}
benches = {}
for name, rest in chosen.items():
    device = zw.catalogue.device(name, **rest)
    wall = zw.Wall(round(4 * float(device.damping) / float(device.sample_period)))
    laws = standard_laws(device, wall)
    del laws["held"]  # an environment that is computed slowly, which diverges here
    benches[name] = zw.compare(device, wall, laws)

names = list(dict.fromkeys(str(law) for bench in benches.values() for law in bench.scores.law.values))
number = {law: n for n, law in enumerate(names, 1)}

# %%
# To the right what is felt, as a part of what is wanted; upwards the most energy that the law gave out
# under a fast finger or a pushed dowel.  The best place is at the right, at the foot, and green.
# Numbers that stand together are laws that fall together.

MARKS = {
    "passive": ("o", "#009E73", 7),
    "theorem": ("s", "#0072B2", 7),
    "active": ("X", "#D55E00", 6.5),
    "undecided": ("D", "#8A6D00", 9),
}
FOOT, TOP, APART = 1e-3, 300.0, 0.19  # of the axis [mJ], [mJ]; of two labels [decades]


def groups(scores: xr.Dataset, wanted: float) -> list[tuple[tuple[float, float, str], list[int]]]:
    """Laws that lie within a twentieth of a decade of each other, with their place."""
    found: list[tuple[tuple[float, float, str], list[int]]] = []
    for law in scores.law.values:
        one = scores.sel(law=law)
        given = max(float(one.generated_energy), float(one.dowel_energy), 1e-3 * FOOT) * 1e3
        given = min(given, TOP)
        place = (float(one.static_stiffness) / wanted, np.log10(given), str(one.status.item()))
        for known, laws in found:
            if abs(known[0] - place[0]) < 0.03 and abs(known[1] - place[1]) < 0.05 and known[2] == place[2]:
                laws.append(number[str(law)])
                break
        else:
            found.append((place, [number[str(law)]]))
    return sorted(found)


def spread(heights: Sequence[float]) -> NDArray[np.float64]:
    """The same order, no two closer than APART."""
    order, result = np.argsort(heights, kind="stable"), np.array(heights)
    for before, after in zip(order, order[1:], strict=False):
        result[after] = max(result[after], result[before] + APART)
    highest = np.log10(TOP)
    for place in order[::-1]:
        result[place] = min(result[place], highest)
        highest = result[place] - APART
    return result


figure, axes = plt.subplots(
    1, 4, figsize=(9.6, 6.4), layout="constrained", width_ratios=(1, 1, 1, 0.8), sharey=True
)
for axis, (name, bench) in zip(axes, benches.items(), strict=False):
    wanted = float(bench.environment.stiffness)
    found = groups(bench.scores, wanted)
    for ((felt, given, status), numbers), height in zip(
        found, spread([place[1] for place, _ in found]), strict=True
    ):
        axis.plot([felt, 1.12], 10.0 ** np.array([given, height]), color="0.8", lw=0.6, zorder=1)
        mark, colour, size = MARKS[status]
        axis.plot(felt, 10.0**given, mark, color=colour, ms=size, mec="w", mew=0.4, zorder=4 - size / 9)
        label = ", ".join(map(str, numbers))
        axis.text(1.14, 10.0**height, label, fontsize=7.5, va="center", color=colour)
    axis.axvline(1, color="0.6", lw=0.8, ls=":", zorder=0)
    axis.set(yscale="log", ylim=(FOOT / 2, TOP), xlim=(0, 1.7), xticks=(0, 0.5, 1))
    axis.set_title(f"{name}, {wanted:g} N/m")
    axis.set_xlabel("stiffness felt over wanted")
axes[0].set_ylabel(f"energy given out [mJ]; {FOOT:g} stands for less")
for status, (mark, colour, size) in MARKS.items():
    axes[3].plot([], [], mark, color=colour, ms=size, mew=0, label=status)
axes[3].axis("off")
axes[3].text(0, 1.0, "\n".join(f"{n:2d}  {law}" for law, n in number.items()), va="top",
             fontsize=7.5, transform=axes[3].transAxes, linespacing=1.35)  # fmt: skip
axes[3].legend(loc="lower left", bbox_to_anchor=(-0.1, -0.03))

# %%
# Proved with a certificate are the virtual coupling and force bounding.  The coupling gives a third of the
# stiffness.  It gives out energy, too: a held spring does; the proof says that the friction of the device
# takes more.  On the course plant the coupling is not passive: an encoder without Coulomb friction pays a
# hand that toggles over an edge, however soft the wall.  Force bounding that knows of the encoder's counts
# is proved on each device and keeps far more: a push that was paid for may be as stiff as one likes.
#
# Virtual damping, much the same in another form as extrapolation, matched poles and prediction, keeps the
# stiffness of the wall and gives out next to nothing in these touches; a hand that moves to and fro from
# sample to sample refutes each of them.  Which of the two matters is a question about the hand.

for name, bench in benches.items():
    shown = bench.scores.sel(law=["wall", "virtual-damping", "virtual-coupling"])
    felt = shown.static_stiffness / float(bench.environment.stiffness)
    given = 1e3 * np.maximum(shown.generated_energy, shown.dowel_energy)
    rows = zip(shown.law.values, given.values, felt.values, strict=True)
    print(f"{name}: {', '.join(f'{law} {g:.3g} mJ at {f:.0%}' for law, g, f in rows)}")
plt.show()
