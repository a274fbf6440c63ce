"""The loop once more, at 60 digits: what the simulator is held against.

Nothing here is taken from the simulator.  Between two changes the handle obeys

    M ẍ + (b + c) ẋ + k x = F + k x_a(t) + c ẋ_a − f_a(t) − σ f_c,      M = m + m_h,

with x_a straight and f_a constant, a ramp, or an exponential.  Its solution is a sum of
polynomials times exponentials, Σ p(s) e^{μs}, and so are velocity, acceleration and every
force; a product of two such sums is integrated term by term, which gives the energies.
Zeros are enclosed by Rolle's theorem: e^{−μs} f is monotone between the zeros of (D − μ) f,
which has one term less.  What is left in the end is one term, without a zero, or one
oscillation, whose zeros are known.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

from mpmath import mp, mpf

DIGITS = 60
"""Carried; some ten are lost where a short piece of motion is the difference of long ones."""

Number = Any
"""An mpf, or an mpc where the motion oscillates."""


@dataclass(frozen=True)
class Loop:
    """Device, wall, hand and clock; plain floats, taken as the exact binary numbers they are.

    The hand's force holds for an interval, its anchor is given at every sample instant, one more.
    """

    mass: float
    damping: float
    coulomb: float
    period: float
    resolution: float
    wall_stiffness: float
    position: float
    stiction: float | None = None
    wall_damping: float = 0.0
    velocity: float = 0.0
    phase: float = 0.0
    delay: float = 0.0
    converter_step: float = 0.0
    force_limit: float = 0.0
    slew: float = 0.0
    lag: float = 0.0
    hand_mass: float = 0.0
    hand_stiffness: float = 0.0
    hand_damping: float = 0.0
    force: Sequence[float] = ()
    anchor: Sequence[float] = ()


ENERGIES = (
    "hand_work",
    "actuator_work",
    "viscous_loss",
    "coulomb_loss",
    "hand_source_work",
    "hand_damper_loss",
)


class Trace:
    """At every sample instant, forces just after it; energies since t = 0 [J] by name.

    The hand's force is given at all but the last instant: no interval follows that one.
    `reversals` are the instants [s] when the handle came to rest or turned round, `releases`
    those when it broke loose.
    """

    def __init__(self) -> None:
        self.position, self.velocity, self.count, self.commanded_force = [], [], [], []
        self.actuator_force, self.hand_force, self.reversals, self.releases = [], [], [], []
        self.energy: dict[str, list[mpf]] = {name: [] for name in ENERGIES}


@lru_cache(maxsize=256)
def exponential(rate: Number, s: mpf) -> Number:
    return mp.exp(rate * s) if rate else mpf(1)


def horner(coefficients: Sequence[Number], s: mpf) -> Number:
    value = mpf(0)
    for coefficient in reversed(coefficients):
        value = value * s + coefficient
    return value


@dataclass(frozen=True)
class Sum:
    """``f(s) = Σ p(s) e^{μs}``, real on the whole; p(s) = p₀ + p₁ s + …, different μ."""

    terms: dict[Number, tuple[Number, ...]]

    def __call__(self, s: mpf) -> mpf:
        return mp.re(sum((horner(p, s) * exponential(rate, s) for rate, p in self.terms.items()), mpf(0)))

    def __add__(self, other: Sum) -> Sum:
        terms = dict(self.terms)
        for rate, p in other.terms.items():
            q = terms.get(rate, ())
            long, short = (p, q) if len(p) > len(q) else (q, p)
            terms[rate] = tuple(a + b for a, b in zip(long, short, strict=False)) + long[len(short) :]
        return Sum(terms)

    def __rmul__(self, factor: mpf) -> Sum:
        return Sum({rate: tuple(factor * a for a in p) for rate, p in self.terms.items()} if factor else {})

    def derivative(self, shift: Number = 0) -> Sum:
        """(D − shift) f."""
        terms = {}
        for rate, p in self.terms.items():
            slope = tuple(n * a for n, a in enumerate(p))[1:]
            if rate == shift:
                new = slope
            else:
                new = tuple((rate - shift) * a + b for a, b in zip(p, (*slope, 0), strict=True))
            if any(new):
                terms[rate] = new
        return Sum(terms)


def polynomial(*coefficients: Number) -> Sum:
    return Sum({mpf(0): coefficients})


def integral(f: Sum, g: Sum, s: mpf) -> mpf:
    """∫₀ˢ f g."""
    total = mpf(0)
    for mu, p in f.terms.items():
        for nu, q in g.terms.items():
            product = [mpf(0)] * (len(p) + len(q) - 1)
            for i, a in enumerate(p):
                for j, b in enumerate(q):
                    product[i + j] += a * b
            rate = mu + nu
            if rate:
                total += _exponential_integral(product, rate, s, exponential(mu, s) * exponential(nu, s))
            else:
                total += s * horner([a / (n + 1) for n, a in enumerate(product)], s)
    return mp.re(total)


def _exponential_integral(p: list[Number], rate: Number, s: mpf, growth: Number) -> Number:
    q: list[Number] = [mpf(0)]
    for n in reversed(range(len(p))):
        q.insert(0, (p[n] - (n + 1) * q[0]) / rate)
    return horner(q, s) * growth - q[0]


def motion(mass: mpf, damping: mpf, stiffness: mpf, drive: Sum, x: mpf, v: mpf) -> Sum:
    """The solution of ``M ẍ + B ẋ + k x = drive`` from x and v, for any damping ratio."""
    roots = _roots(mass, damping, stiffness)
    forced = Sum({})
    for rate, p in drive.terms.items():
        at = (mass * rate**2 + damping * rate + stiffness, 2 * mass * rate + damping, mass)
        forced += Sum({rate: _forced(at, roots.count(rate), p)})
    rest, speed = x - forced(mpf(0)), v - forced.derivative()(mpf(0))
    first, second = roots
    if first == second:
        return forced + Sum({first: (rest, speed - first * rest)})
    share = (speed - second * rest) / (first - second)
    return forced + Sum({first: (share,)}) + Sum({second: (rest - share,)})


def _roots(mass: mpf, damping: mpf, stiffness: mpf) -> list[Number]:
    discriminant = damping**2 - 4 * mass * stiffness
    if not discriminant or not stiffness:
        return [-damping / mass, mpf(0)] if not stiffness else 2 * [-damping / (2 * mass)]
    spread = mp.sqrt(discriminant)
    return [(-damping + spread) / (2 * mass), (-damping - spread) / (2 * mass)]


def _forced(at: Sequence[Number], multiplicity: int, p: Sequence[Number]) -> tuple[Number, ...]:
    """q with ``L q + L′ q′ + L″/2 q″ = p``, the operator's L(μ), L′(μ), L″(μ)/2 given."""
    m, q = multiplicity, [mpf(0)] * (len(p) + 3)
    for n in reversed(range(len(p))):
        known = sum(at[j] * q[n + j] * _falling(n + j, j) for j in range(m + 1, 3))
        q[n + m] = (p[n] - known) / (at[m] * _falling(n + m, m))
    return tuple(q[: len(p) + m])


def _falling(n: int, times: int) -> int:
    return (1, n, n * (n - 1))[times]


def zeros(f: Sum, end: mpf) -> Iterator[mpf]:
    """Where f changes sign in (0, end), in order."""
    terms = {rate: p for rate, p in f.terms.items() if any(p)}
    real = [rate for rate in terms if not mp.im(rate)]
    if not real:
        yield from _oscillation_zeros(terms, end)
    elif len(terms) > 1 or len(terms[real[0]]) > 1:
        edges = [mpf(0), *zeros(f.derivative(real[0]), end), end]
        for low, high in pairwise(edges):
            if f(low) * f(high) < 0:
                yield crossing(f, low, high)


def _oscillation_zeros(terms: dict[Number, tuple[Number, ...]], end: mpf) -> Iterator[mpf]:
    """Of 2 Re(C e^{λs}), its angle being an odd number of quarter turns."""
    for rate, (factor,) in terms.items():
        if rate.imag > 0:
            turn = mp.ceil(mp.arg(factor) / mp.pi + mpf(1) / 2)
            while (s := ((turn - mpf(1) / 2) * mp.pi - mp.arg(factor)) / rate.imag) < end:
                yield s
                turn += 1


def crossing(f: Sum, low: mpf, high: mpf) -> mpf:
    """The zero between low and high: Newton's method, bisection where that leaves the bracket."""
    slope, rising = f.derivative(), f(high) > 0
    s, width = (low + high) / 2, high - low
    while True:
        value = f(s)
        low, high = (low, s) if (value > 0) == rising else (s, high)
        steep = slope(s)
        new = s - value / steep if steep else low
        if not low < new < high:
            new = (low + high) / 2
        if abs(new - s) <= width * mpf(10) ** (5 - DIGITS) or not low < new < high:
            return new
        s = new


def first_loss(f: Sum, end: mpf) -> mpf | None:
    """Where f, positive just after 0, first falls below zero; None if not before the end."""
    start = end * mpf(10) ** (20 - DIGITS)
    edges = [s for s in zeros(f.derivative(), end) if s > start]
    for low, high in pairwise([mpf(0), *edges, end]):
        if f(high) < 0:
            return crossing(f, low, high)
    return None


class _Run:
    """The state between two changes, and how it goes on."""

    def __init__(self, loop: Loop) -> None:
        self.loop, self.trace = loop, Trace()
        self.time, self.x, self.v = mpf(0), mpf(loop.position), mpf(loop.velocity)
        self.way = int(mp.sign(self.v))
        self.target = self.actuator = mpf(0)
        self.energy = {name: mpf(0) for name in ENERGIES}
        self.breakaway = mpf(loop.coulomb if loop.stiction is None else loop.stiction)

    def advance(self, end: mpf, force: mpf, anchor: mpf, speed: mpf) -> None:
        """To the instant `end`; the anchor given at that instant, with its speed."""
        while self.time < end:
            self._piece(end - self.time, force, anchor - speed * (end - self.time), speed)
        self.time = end

    def _piece(self, length: mpf, force: mpf, anchor: mpf, speed: mpf) -> None:
        loop = self.loop
        actuator, length = self._actuator(length)
        tied = mpf(loop.hand_stiffness), mpf(loop.hand_damping)
        pull = polynomial(force + tied[0] * anchor + tied[1] * speed, tied[0] * speed)
        at_rest = pull + polynomial(-tied[0] * self.x) + mpf(-1) * actuator
        if not self.way and abs(at_rest(mpf(0))) > self.breakaway:
            self.way = int(mp.sign(at_rest(mpf(0))))
        if self.way:
            drive = pull + mpf(-1) * actuator + polynomial(-self.way * mpf(loop.coulomb))
            mass = mpf(loop.mass) + loop.hand_mass
            x = motion(mass, loop.damping + tied[1], tied[0], drive, self.x, self.v)
            event = first_loss(mpf(self.way) * x.derivative(), length)
            self._finish(x, actuator, length if event is None else event, force, anchor, speed)
            if event is not None:
                self.v, self.way = mpf(0), 0
                self.trace.reversals.append(self.time)
        else:
            event, way = self._release(at_rest, length)
            self._finish(polynomial(self.x), actuator, event, force, anchor, speed)
            if way:
                self.way = way
                self.trace.releases.append(self.time)

    def _actuator(self, length: mpf) -> tuple[Sum, mpf]:
        """f_a from now on, and how long that holds."""
        loop, gap = self.loop, self.target - self.actuator
        if loop.lag:
            return polynomial(self.target) + Sum({-1 / mpf(loop.lag): (-gap,)}), length
        if loop.slew and gap:
            rise = abs(gap) / loop.slew
            if rise > self.time * mpf(10) ** (10 - DIGITS):
                return polynomial(self.actuator, mp.sign(gap) * loop.slew), min(rise, length)
        return polynomial(self.target), length

    def _release(self, at_rest: Sum, length: mpf) -> tuple[mpf, int]:
        """When the net force outgrows the stiction, and the way it then goes; 0 if it does not."""
        found = (length, 0)
        for way in (1, -1):
            event = first_loss(polynomial(self.breakaway) + mpf(-way) * at_rest, length)
            if event is not None and event < found[0]:
                found = (event, way)
        return found

    def _finish(self, x: Sum, actuator: Sum, s: mpf, force: mpf, anchor: mpf, speed: mpf) -> None:
        """Move on by s and count the energies."""
        loop, v = self.loop, x.derivative()
        spring = mpf(loop.hand_stiffness) * (polynomial(anchor, speed) + mpf(-1) * x)
        apart = polynomial(speed) + mpf(-1) * v
        tie = spring + mpf(loop.hand_damping) * apart
        hand = polynomial(force) + tie + mpf(-loop.hand_mass) * v.derivative()
        x_end = x(s)
        for name, joules in {
            "hand_work": integral(hand, v, s),
            "actuator_work": -integral(actuator, v, s),
            "viscous_loss": loop.damping * integral(v, v, s),
            "coulomb_loss": loop.coulomb * abs(x_end - self.x),
            "hand_source_work": force * (x_end - self.x) + speed * integral(tie, polynomial(mpf(1)), s),
            "hand_damper_loss": loop.hand_damping * integral(apart, apart, s),
        }.items():
            self.energy[name] += joules
        self.x, self.v, self.actuator, self.time = x_end, v(s), actuator(s), self.time + s

    def hand_force(self, force: mpf, anchor: mpf, speed: mpf) -> mpf:
        """f_h now, the hand's mass accelerated by what is left of the forces."""
        loop = self.loop
        pull = force + loop.hand_stiffness * (anchor - self.x) + loop.hand_damping * (speed - self.v)
        net = pull - (self.actuator if loop.lag or loop.slew else self.target)
        way = self.way or (int(mp.sign(net)) if abs(net) > self.breakaway else 0)
        left = net - way * mpf(loop.coulomb) - loop.damping * self.v if way else mpf(0)
        return pull - loop.hand_mass * left / (mpf(loop.mass) + loop.hand_mass)

    def record(self, count: int, command: mpf) -> None:
        """Write the present state down."""
        trace, jumps = self.trace, not (self.loop.lag or self.loop.slew)
        trace.position.append(self.x)
        trace.velocity.append(self.v)
        trace.count.append(count)
        trace.commanded_force.append(command)
        trace.actuator_force.append(self.target if jumps else self.actuator)
        for name, joules in self.energy.items():
            trace.energy[name].append(joules)


def simulate(loop: Loop, samples: int) -> Trace:
    """The loop over so many sample intervals, from rest of the actuator."""
    with mp.workdps(DIGITS):
        run, period = _Run(loop), mpf(loop.period)
        whole = int(mp.floor(mpf(loop.delay) / period))
        rest = mpf(loop.delay) - whole * period
        commands: list[mpf] = []
        before = 0
        for k in range(samples + 1):
            count = int(mp.floor((run.x + mpf(loop.phase) * loop.resolution) / loop.resolution))
            commands.append(_command(loop, count, before if k else count))
            before = count
            if not rest and k >= whole:
                run.target = commands[k - whole]
            run.record(count, commands[k])
            if k < samples:
                _interval(run, k, commands[k - whole] if k >= whole else None, rest)
        return run.trace


def _interval(run: _Run, k: int, command: mpf | None, rest: mpf) -> None:
    loop, period = run.loop, mpf(run.loop.period)
    force = mpf(loop.force[k]) if loop.force else mpf(0)
    x_a, x_b = (mpf(loop.anchor[k]), mpf(loop.anchor[k + 1])) if loop.anchor else (mpf(0), mpf(0))
    speed = (x_b - x_a) / period
    run.trace.hand_force.append(run.hand_force(force, x_a, speed))
    if rest:
        run.advance(k * period + rest, force, x_a + speed * rest, speed)
        if command is not None:
            run.target = command
    run.advance((k + 1) * period, force, x_b, speed)


def _command(loop: Loop, count: int, before: int) -> mpf:
    """K x_m + B Δx_m/T inside, 0 outside; to the converter's step, then to the limit."""
    if count <= 0:
        return mpf(0)
    damper = loop.wall_damping * (count - before) / mpf(loop.period)
    force = loop.resolution * (loop.wall_stiffness * mpf(count) + damper)
    if loop.converter_step:
        force = loop.converter_step * mp.nint(force / loop.converter_step)
    return max(-mpf(loop.force_limit), min(mpf(loop.force_limit), force)) if loop.force_limit else force
