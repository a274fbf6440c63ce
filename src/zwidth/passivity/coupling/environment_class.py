"""What is known of an environment when its law is not: between which slopes, or how far from passive.

A class is an inequality that each of its environments keeps for every motion y of its end, with
e = y(k) − y(k−1), Δf = f(k) − f(k−1) and Φ′ = f.  A static spring whose slope lies between μ and L:

    |½ (f(k) + f(k−1)) e − ΔΦ| ≤ P/(2 (L − μ)),    P = (Δf − μ e)(L e − Δf) ≥ 0

for the curve lies in a parallelogram about its chord.  Anything with excess or shortage:

    Σ f(k) e ≥ −S + Σ [ι e²/T + ο T f(k)²]

The first bounds what comes out only if Φ has a lower bound: a constant force has none, and neither has a
negative spring.  Slopes from μ > 0 up force one on it; for others it is a hypothesis that has to be stated.

ι is what it dissipates as a damper in parallel would, ο as one in series; where they are negative, that
much is lacking.  A spring is short by ι = μT/2 at most.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from zwidth.errors import InputError
from zwidth.model.environment import NonlinearSpring
from zwidth.passivity.formulas.hypotheses import number
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import shown, told_quantity


@dataclass(frozen=True, init=False, kw_only=True)
class SlopeBounds:
    """Static springs, nonlinear or one-sided, with slopes μ ≤ f′ ≤ L and a potential Φ ≥ Φ_min > −∞.

    Without the bound on Φ the hand may travel downhill for ever and gain, though nothing is gained on any
    closed path: a constant force has the slope 0.

    Parameters
    ----------
    least
        μ [N/m; N·m/rad]: 0 for a wall that is touched and left, negative where the force falls with depth.
    greatest
        L ≥ μ [N/m; N·m/rad].
    bounded_below
        True states that every spring of the class has such a Φ, as one that ends in stops on both sides, or
        whose force is 0 outside.  Needed where μ ≤ 0; from μ > 0 up it is so by itself.

    Raises
    ------
    InputError
        If they are not numbers, or in the wrong order, or the bound on Φ is not stated where it has to be.
    """

    least: Exact
    greatest: Exact
    bounded_below: bool

    def __init__(self, least: RealLike, greatest: RealLike, *, bounded_below: bool | None = None) -> None:
        low, high = (
            number(name, slope, quantity="stiffness")
            for name, slope in (("least", least), ("greatest", greatest))
        )
        if low > high:
            raise InputError(f"the least slope is no more than the greatest; got {least} and {greatest}")
        object.__setattr__(self, "least", Exact(low))
        object.__setattr__(self, "greatest", Exact(high))
        object.__setattr__(self, "bounded_below", _stated(low, bounded_below))

    @classmethod
    def of(cls, spring: NonlinearSpring) -> SlopeBounds:
        """The slopes of a spring given by points, and 0, for beyond the points its force is constant.

        Raises
        ------
        InputError
            If it is no `NonlinearSpring`, or pushes away for ever at one end, so that Φ has no least value.
        """
        if not isinstance(spring, NonlinearSpring):
            raise InputError(f"slopes are read from a NonlinearSpring, got {type(spring).__name__}")
        x, f = ([p.fraction for p in points] for points in (spring.positions, spring.forces))
        if f[0] > 0 or f[-1] < 0:
            raise InputError(
                f"the first force must be ≤ 0 and the last ≥ 0, got {float(f[0]):g} and {float(f[-1]):g}: "
                "a force that leads away beyond the points gives out energy for ever; end it with a stop"
            )
        slopes = [(f1 - f0) / (x1 - x0) for (x0, f0), (x1, f1) in pairwise(zip(x, f, strict=True))]
        return cls(min(Fraction(0), *slopes), max(Fraction(0), *slopes), bounded_below=True)

    def input_index(self, sample_period: RealLike) -> Exact:
        """ι = μT/2 [N·s/m; N·m·s/rad]: f(k) e ≥ ΔΦ + ½ μ e²."""
        return Exact(self.least.fraction * number("sample_period", sample_period) / 2)

    def describe(self, motion: str = "linear") -> str:
        """The class in words, with the hypothesis on Φ."""
        unit = GLOSSARY["stiffness"].unit_for(motion)
        least = f"{float(self.least) * spoken(unit)[0]:.6g}"
        return (
            f"every static spring with slopes from {least} to {shown(self.greatest, unit, 6)} whose "
            "potential is bounded below"
        )


def _stated(least: Fraction, bounded_below: bool | None) -> bool:
    """True where Φ is bounded below, by the slopes or because it is said to be."""
    if bounded_below is True or (least > 0 and bounded_below is None):
        return True
    if bounded_below is None:
        raise InputError(
            f"a spring with slopes down to {float(least):g} may lead away for ever, as a constant force "
            "does, and give out energy without end: say bounded_below=True if the potential of every spring "
            "of the class is bounded below, as of a wall that is touched and left; SlopeBounds.of reads it "
            "off a spring"
        )
    raise InputError(
        f"bounded_below is True or left out, got {bounded_below!r}: before springs that lead away for ever "
        "no device is passive"
    )


@dataclass(frozen=True, init=False, kw_only=True)
class PassivityExcess:
    """Environments whose excess of passivity is known, static or not, linear or not; below 0 a shortage.

    Both 0 are the passive ones.  A damper, however nonlinear, with gains g to G [N·s/m], g + G > 0, has
    ι = gG/(g + G) and ο = 1/(g + G).

    Parameters
    ----------
    input
        ι of either sign [N·s/m; N·m·s/rad].
    output
        ο of either sign [m/(N·s); rad/(N·m·s)]; 4 ι ο ≤ 1.

    Raises
    ------
    InputError
        If they are not numbers, or 4 ι ο > 1 with both positive.
    """

    input: Exact
    output: Exact

    def __init__(self, input: RealLike = 0, output: RealLike = 0) -> None:
        iota, omicron = number("input", input, quantity="damping"), number("output", output)
        if iota > 0 and 4 * iota * omicron > 1:
            raise InputError(
                f"4 · input · output must be ≤ 1, got {float(4 * iota * omicron):.6g}: then no force f and "
                "velocity v but 0 keep f v ≥ ι v² + ο f²; make one of the two smaller"
            )
        object.__setattr__(self, "input", Exact(iota))
        object.__setattr__(self, "output", Exact(omicron))

    def describe(self, motion: str = "linear") -> str:
        """The class in words; that its store is bounded below is part of the inequality."""
        above = told_quantity(self.input, "damping", motion)
        below = shown(self.output, "rad/N/m/s" if motion == "rotary" else "m/N/s", 6)
        return f"every environment with input index {above} and output index {below}"
