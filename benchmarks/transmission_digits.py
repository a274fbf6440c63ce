"""Motor, transmission and hand: is every limit right to 1e-6, by a road that shares nothing with the verdict?

No sum over frequencies, no roots, no circle.  One sample period in the time domain, the next one e^{jθ} times
as large: of all speeds u of the hand's side with which the sampled position is 1, one costs the hand least.
It solves a boundary value problem of six linear differential equations, of the state (x₁, v₁, x₂) and its
multipliers, in which the held force is a constant on each of two stretches: exponentials of matrices, exact.
What it costs is (1, H)* M (1, H).  The loop is passive exactly if that is ≥ 0 for 0 < θ ≤ π, all decays while
the hand's side is held, and nothing pulls at rest.  All numbers are balls of 40 digits and more: a sign is
certain, or "unsure" is printed.

Of plants and laws of `random_transmissions.py` the largest gain is found so, to 1e-9.  At (1 − 1e-6) of it
`zw.check` must have a certificate that the independent checker accepts, at (1 + 1e-6) a violation; both roads
must say the same at two gains of any size and sign beside it.

    python transmission_digits.py [PLANTS] [FIRST SEED] [SECONDS]
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from math import cos, pi

import numpy as np
from flint import acb, acb_mat, acb_poly, arb, arb_mat, arb_poly, fmpz_poly
from random_transmissions import NEAR, Loops

import zwidth as zw
from zwidth.passivity.linear.transmission import Elastic
from zwidth.quantity.balls import ball, middle, precision

FINE, TINY, BEYOND = Fraction(1, 10**10), arb(10) ** -40, 2
"""Of the limit; what a ball may be uncertain by; coefficients beyond the last one, which must be 0."""
_NOTHING = Fraction(0)


class Unsure(Exception):
    """These digits do not tell."""


class Road:
    """A plant and a law, T = 1; the state is x₁, v₁, x₂, and p of each."""

    def __init__(self, elastic: Elastic) -> None:
        self.loop, t = elastic.loop, elastic.loop.period
        self.mass, self.stiffness, self.at_handle = elastic.mass / t**2, elastic.stiffness, elastic.at_handle
        self.own, self.inside, self.other = (
            b / t for b in (self.loop.damping, elastic.damping, elastic.handle_damping)
        )
        self.bits = 800 + 8 * int(elastic.turn) + 16 * self.loop.degree

    def _rates(self) -> list[list[Fraction]]:
        """Of the six, the sum of p₂ and the held force, of a hand that pays least.

        J = ∫ Re ū (R u + S y), R = b₂ + c, S = (−k, −c, k); stationary for R u = −½ S y − Bᵀ p and
        ṗ = −Aᵀ p − ½ Sᵀ u, B = (0, c/m, 1).
        """
        m, k, c = self.mass, self.stiffness, self.inside
        a = [[_NOTHING, Fraction(1), _NOTHING], [-k / m, -(self.own + c) / m, k / m], [_NOTHING] * 3]
        b, s = (_NOTHING, c / m, Fraction(1)), (-k / 2, -c / 2, k / 2)
        speed = [-x / (self.other + c) for x in (*s, *b)]
        rows = [[*a[i], *[_NOTHING] * 3] for i in range(3)]
        rows += [[*[_NOTHING] * 3, *(-a[j][i] for j in range(3))] for i in range(3)]
        for row, push in zip(rows, (*b, *(-x for x in s)), strict=True):
            row[:] = [x + push * u for x, u in zip(row, speed, strict=True)]
        rows += [[_NOTHING] * 4 + [Fraction(1), _NOTHING], [_NOTHING] * 6]
        return [[*row, _NOTHING, -1 / m if i == 1 else _NOTHING] for i, row in enumerate(rows)]

    def _stretches(self, rates: list[list[Fraction]]) -> list[list[list[arb]]]:
        """What a time of α, and of 1 − α, makes of everything."""
        part = self.loop.part_delay
        return [
            arb_mat([[ball(x * t) for x in row] for row in rates]).exp().tolist() for t in (part, 1 - part)
        ]

    def form(self, z: acb, early: list[list[arb]], late: list[list[arb]]) -> tuple[arb, arb, acb, arb]:
        """q, and M of reading and force at z."""
        first, last = (acb_mat([row[:6] for row in rows[:6]]) for rows in (early, late))
        pushed, after = (acb_mat([[acb(0), row[7]] for row in rows[:6]]) for rows in (early, late))
        whole, unit = last * first, acb_mat(6, 6, 1)
        now = z**-self.loop.whole_delay
        forces = now / z, now
        moved = last * pushed * forces[0] + after * forces[1]
        read = 2 if self.at_handle else 0
        system = [[*row, z * (i == 3 + read)] for i, row in enumerate((whole - unit * z).tolist())]
        system.append([acb(j == read) for j in range(7)])
        found = acb_mat(system).solve(acb_mat([*(-moved).tolist(), [acb(1), acb(0)]])).tolist()
        begin, (least, cross), work = acb_mat(found[:6]), found[6], acb_mat(1, 2)
        for rows, at, force in (
            (early, begin, forces[0]),
            (late, first * begin + pushed * forces[0], forces[1]),
        ):
            summed = acb_mat([rows[6][:6]]) * at + acb_mat([[acb(0), rows[6][7]]]) * force
            work -= summed * force.conjugate() / ball(self.mass)
        back, own = work.entries()
        if not (cross - back.conjugate()).overlaps(acb(0)) or not least.real > 0:
            raise Unsure("the form is not Hermitian, or the hand is paid without a force")
        return ((whole - unit * z).det() / z**3 / (2 * z.real - 2)).real, least.real, cross, own.real

    @cached_property
    def parts(self) -> list[arb_poly]:
        """P of 1, g and g² in the cost times what makes it a polynomial in cos θ."""
        loop, stretches = self.loop, self._stretches(self._rates())
        count = max(len(loop.denominator), len(loop.numerator) + loop.whole_delay + 1) + 2 + BEYOND
        places = [Fraction(round(2**60 * cos(pi * (i + 0.5) / count)), 2**60) for i in range(count)]
        values: list[list[arb]] = [[], [], []]
        for x in map(ball, places):
            z = acb(x, (1 - x * x).sqrt())
            q, least, cross, own = self.form(z, *stretches)
            n, d = (acb_poly(list(part))(1 / z) for part in (loop.numerator, loop.denominator))
            for kept, value in zip(
                values,
                (q * size(d), 2 * (cross * n * d.conjugate()).real * q / least, own / least * q * size(n)),
                strict=True,
            ):
                kept.append(value)
        found = [arb_poly.interpolate([ball(x) for x in places], one) for one in values]
        for one in found:
            for i in range(count - BEYOND, count):
                if not abs(one[i]) < TINY * most(one):
                    raise Unsure("what is made of the cost is no polynomial")
        return [arb_poly([one[i] for i in range(count - BEYOND)]) for one in found]

    @cached_property
    def _swings(self) -> tuple[list[arb], list[arb]]:
        """Of the hand's side held, ascending in 1/z: what moves freely, and what a force of 1 does."""
        m = self.mass
        rates = [[0, 1, 0], [-self.stiffness / m, -(self.own + self.inside) / m, -1 / m], [0, 0, 0]]
        e, f = self._stretches([[Fraction(x) for x in row] for row in rates])
        (a, b), (c, d) = [[f[i][0] * e[0][j] + f[i][1] * e[1][j] for j in (0, 1)] for i in (0, 1)]
        now, old = [f[0][2], f[1][2]], [f[i][0] * e[0][2] + f[i][1] * e[1][2] for i in (0, 1)]
        turned = [b * g[1] - d * g[0] for g in (now, old)]
        return [arb(1), -a - d, a * d - b * c], [arb(0), now[0], turned[0] + old[0], turned[1]]

    def decays(self, gain: Fraction) -> bool:
        """Whether all of it does, the hand's side held."""
        law = arb_poly([arb(c) for c in self.loop.denominator])
        if not self.at_handle:
            force = arb_poly([arb(0)] * self.loop.whole_delay + [arb(c) for c in self.loop.numerator])
            law = law * arb_poly(self._swings[0]) - force * arb_poly(self._swings[1]) * ball(gain)
        away = [abs(root) - 1 for root, _ in whole_numbers(law).complex_roots()]
        if any(abs(x) < TINY for x in away) and not self.at_handle:
            raise Unsure("a root on the unit circle")
        return all(x > TINY for x in away)

    def cost(self, gain: Fraction) -> bool:
        """Whether the cost is ≥ 0 on 0 < θ ≤ π."""
        g = ball(gain)
        p = self.parts[0] + self.parts[1] * g + self.parts[2] * (g * g)
        roots = {middle(r.real) for r, _ in whole_numbers(p).complex_roots() if r.imag.overlaps(arb(0))}
        ends = [Fraction(-1), *sorted(r for r in roots if -1 < r < 1), Fraction(1)]
        between = [p(ball((a + b) / 2)) for a, b in zip(ends, ends[1:], strict=False) if b - a > FINE**3]
        if any(x.overlaps(arb(0)) for x in between):
            raise Unsure("the sign of the cost")
        return all(x > 0 for x in between)

    def at_rest(self, gain: Fraction) -> bool:
        """Whether a hand that has come to rest is not pulled: of a law that decays."""
        top, bottom, k = gain * sum(self.loop.numerator), sum(self.loop.denominator), self.stiffness
        return (top / bottom if self.at_handle else k * top / (k * bottom + top)) >= 0

    def passive(self, gain: Fraction) -> bool:
        """Whether no hand gets energy from gain times the law."""
        with precision(self.bits):
            return self.cost(gain) and self.decays(gain) and self.at_rest(gain)


def size(x: acb) -> arb:
    """|x|²."""
    return x.real * x.real + x.imag * x.imag


def most(p: arb_poly) -> arb:
    """The largest coefficient."""
    return max((abs(c).mid() for c in p.coeffs()), default=arb(0))


def whole_numbers(p: arb_poly) -> fmpz_poly:
    """The middle of each coefficient, in a unit far below the largest."""
    parts = [middle(c) for c in p.coeffs()]
    largest = max(map(abs, parts))
    unit = Fraction(2) ** (largest.numerator.bit_length() - largest.denominator.bit_length() - 300)
    return fmpz_poly([round(c / unit) for c in parts])


def limit_of(road: Road, start: float) -> Fraction | None:
    """The largest gain of the coarse ones that is passive, made as large as it goes; None without one."""
    gains = [Fraction(f"{start * 4.0**power:.6g}") for power in range(4, -24, -1)]
    first = next((i for i, gain in enumerate(gains) if road.passive(gain)), 0)
    if first == 0:
        return None
    below, above = gains[first], gains[first - 1]
    while above - below > below * FINE:
        middle_one = Fraction(f"{float(above + below) / 2:.16g}")
        below, above = (middle_one, above) if road.passive(middle_one) else (below, middle_one)
    return below


def one(seed: int) -> Iterator[str]:
    """What was compared; "wrong" or "unsure" first where something is."""
    loops, rng = Loops(seed), np.random.default_rng([seed, 2])
    road = Road(loops.elastic(Fraction(1)))
    limit = limit_of(road, loops.start)
    around = limit or Fraction(f"{loops.start:.6g}")
    gains = [around * Fraction(f"{rng.choice([-1, 1]) * 10 ** rng.uniform(-2, 2):.6g}") for _ in range(2)]
    yield "a limit" if limit else "no limit"
    for gain in [*([limit * (1 - NEAR), limit * (1 + NEAR)] if limit else []), *gains]:
        verdict = zw.check(loops.device, loops.at(gain), contact="kept", iterate=False)
        evidence, truth = verdict.certificate or verdict.violation, road.passive(gain)
        right = verdict.outcome == ("passive" if truth else "active")
        near = "at the limit" if limit and abs(gain / limit - 1) <= NEAR else "beside it"
        if right and evidence is not None and evidence.verify():
            yield f"{verdict.outcome} {near}"
        else:
            kind = "undecided" if verdict.outcome == "undecided" else "wrong"
            yield f"{kind}: {verdict.outcome} at {float(gain)}, {near}, and not {truth}: {verdict.claim}"


def main() -> int:
    """Run and print."""
    defaults = ("1000", "40000", "1e9")
    count, first, seconds = map(float, (*sys.argv[1:4], *defaults[len(sys.argv) - 1 :]))
    seen: Counter[str] = Counter()
    start, done = time.process_time(), 0
    for seed in range(int(first), int(first + count)):
        if time.process_time() - start > seconds:
            break
        try:
            found = list(one(seed))
        except Unsure as told:
            found = [f"unsure: {told}"]
        for text in found:
            seen[text.split(":")[0]] += 1
            if ":" in text:
                print(f"seed {seed}: {text}", flush=True)
        done += 1
    for what, number in sorted(seen.items()):
        print(f"{number:>7} {what}")
    print(f"{done} plants in {time.process_time() - start:.0f} s of the processor, from seed {int(first)}")
    return int(seen["wrong"] > 0)


if __name__ == "__main__":
    sys.exit(main())
