"""A body behind a coupling, stepped as a program would: the forces of a motion, in exact numbers."""

from __future__ import annotations

from collections import deque
from fractions import Fraction


class _Explicit:
    """State at the sample; `after` is one step of the integrator under a force that is held."""

    def __init__(self, body, after):
        self.y, self.v, self.body, self._after = Fraction(0), Fraction(0), body, after

    def seen(self, _):
        return self.y, self.v

    def step(self, f):
        self.y, self.v = self._after(self.body, self.y, self.v, f)


class _Implicit:
    """State at the sample before; `after` is the step that ends at this one, under its force."""

    def __init__(self, body, after):
        self.y = self.v = self.f = Fraction(0)
        self.body, self._after = body, after

    def seen(self, f):
        there, _, speed = self._after(self.body, self.y, self.v, self.f, f)
        return there, speed

    def step(self, f):
        self.y, self.v, _ = self._after(self.body, self.y, self.v, self.f, f)
        self.f = f


class _Verlet:
    """y⁺ is known once f is, and v with it."""

    def __init__(self, body):
        self.y = self.before = Fraction(0)
        self.body = body

    def _next(self, f):
        m, b, k, t = self.body  # m (y⁺ − 2y + y⁻)/t² = f − k y − b (y⁺ − y⁻)/(2t)
        right = f - k * self.y + b * self.before / (2 * t) + m * (2 * self.y - self.before) / t**2
        return right / (m / t**2 + b / (2 * t))

    def seen(self, f):
        return self.y, (self._next(f) - self.before) / (2 * self.body[3])

    def step(self, f):
        self.before, self.y = self.y, self._next(f)


def _slope(body, y, v, f):
    m, b, k, _ = body
    return v, (f - b * v - k * y) / m


def _forward(body, y, v, f):
    t = body[3]
    dy, dv = _slope(body, y, v, f)
    return y + t * dy, v + t * dv


def _semi_implicit(body, y, v, f):
    t = body[3]
    v += t * _slope(body, y, v, f)[1]
    return y + t * v, v


def _midpoint_rule(body, y, v, f):
    t = body[3]
    dy, dv = _slope(body, y, v, f)
    dy, dv = _slope(body, y + t / 2 * dy, v + t / 2 * dv, f)
    return y + t * dy, v + t * dv


def _runge_kutta(body, y, v, f):
    t = body[3]
    a = _slope(body, y, v, f)
    b = _slope(body, y + t / 2 * a[0], v + t / 2 * a[1], f)
    c = _slope(body, y + t / 2 * b[0], v + t / 2 * b[1], f)
    d = _slope(body, y + t * c[0], v + t * c[1], f)
    return (
        y + t / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]),
        v + t / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1]),
    )


def _backward(body, y, v, _, f):
    m, b, k, t = body
    v = (m * v + t * (f - k * y)) / (m + t * b + t**2 * k)
    return y + t * v, v, v


def _middle(body, y, v, f):
    m, b, k, t = body  # v⁺ from the means of both ends, where y⁺ = y + t (v + v⁺)/2
    after = (m * v + t * (f - b * v / 2 - k * y - k * t * v / 4)) / (m + t * b / 2 + k * t**2 / 4)
    return y + t * (v + after) / 2, after


def _implicit_midpoint(body, y, v, _, f):
    moved, after = _middle(body, y, v, f)
    return moved, after, (v + after) / 2


def _trapezoidal(body, y, v, before, f):
    moved, after = _middle(body, y, v, (before + f) / 2)
    return moved, after, after


_BODIES = {
    "forward-euler": lambda body: _Explicit(body, _forward),
    "semi-implicit-euler": lambda body: _Explicit(body, _semi_implicit),
    "velocity-verlet": _Verlet,
    "runge-kutta-2": lambda body: _Explicit(body, _midpoint_rule),
    "runge-kutta-4": lambda body: _Explicit(body, _runge_kutta),
    "backward-euler": lambda body: _Implicit(body, _backward),
    "implicit-midpoint": lambda body: _Implicit(body, _implicit_midpoint),
    "trapezoidal": lambda body: _Implicit(body, _trapezoidal),
}


def solved(line, wanted):
    """The f with line(f) = wanted(f), both straight lines."""
    gap = [line(Fraction(f)) - wanted(Fraction(f)) for f in (0, 1)]
    return gap[0] / (gap[0] - gap[1])


def forces(law, period, positions):
    """The force at each sample, from rest at 0."""
    k, b, t = law.stiffness.fraction, law.damping.fraction, period
    numbers = (law.virtual_mass, law.body_damping, law.body_stiffness)
    body = _BODIES[law.integrator]((*(number.fraction for number in numbers), t))
    d = int(law.exchange_delay)
    run = _at_once if d == 0 else (_naive if law.wave_impedance is None else _by_waves)
    before, found, answer = Fraction(0), [], run(law, body, d, t)
    next(answer)
    for x in positions:
        speed = (x - before) / t
        found.append(answer.send(lambda y, v, x=x, w=speed: k * (x - y) + b * (w - v)))
        before = x
    return found


def _at_once(law, body, d, t):
    f = None
    while True:
        pull = yield f
        f = solved(lambda f: f, lambda f, pull=pull: pull(*body.seen(f)))
        body.step(f)


def _naive(law, body, d, t):
    out, back = deque([Fraction(0)] * d), deque([(Fraction(0), Fraction(0))] * d)
    f = None
    while True:
        pull = yield f
        f = pull(*back.popleft())
        out.append(f)
        here = out.popleft()
        back.append(body.seen(here))
        body.step(here)


def _by_waves(law, body, d, t):
    r = law.wave_impedance.fraction
    out, back = deque([Fraction(0)] * d), deque([Fraction(0)] * d)
    y = there = Fraction(0)
    f = None
    while True:
        pull = yield f
        came = back.popleft()  # f − r v of the body
        f = solved(
            lambda f: f, lambda f, pull=pull, came=came, y=y: pull(y + t * (f - came) / r, (f - came) / r)
        )
        y += t * (f - came) / r
        out.append(f + (f - came))
        arrived = out.popleft()  # f + r v of the coupling

        def moved(g, there=there):
            return (body.seen(g)[0] - there) / t

        g = solved(lambda g, moved=moved: g + r * moved(g), lambda g, arrived=arrived: arrived)
        back.append(g - r * moved(g))
        there = body.seen(g)[0]
        body.step(g)
