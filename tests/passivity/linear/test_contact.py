"""Contact made and broken with a damped wall: proved at the bounds, refuted beyond them."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import sqrt
from random import Random

import pytest
from plain_loop import best_switch
from strategies import seeds

import zwidth as zw
from zwidth.passivity import formulas as forms
from zwidth.passivity.certificate import verify_document
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.criterion_choice import decide

TINY = Fraction(1, 10**9)
T = Fraction(1, 1000)

FILTERS = {
    "backward difference": (zw.rendering.BackwardDifference(), 1, 2),
    "window": (zw.rendering.Window(5), 1, Fraction(2, 5)),
    "one pole": (zw.rendering.OnePole("0.003"), 1, Fraction(1, 2)),
    "slow pole": (zw.rendering.OnePole("0.2"), 1, Fraction(2, 201)),
    "one pole without memory": (zw.rendering.OnePole(0), 1, 2),
    "finite response": (zw.rendering.VelocityFilter([3, -1], [2, 0, 0]), 2, 4),  # w = 0, 3/2, −1/2
    "finite once cancelled": (zw.rendering.VelocityFilter([1, "-0.5"], [1, "-0.5", 0]), 1, 2),
}
"""An estimate of velocity, Σ|w_j| and T ‖h_v‖₁ by hand."""


def draw(random, low, high):
    """A decimal of four digits, spread over the decades."""
    return Fraction(f"{low * (high / low) ** random.random():.3e}")


def bounds(k, b, name, step, delay):
    """The two conditions as they stand in the theorem."""
    _, gain, variation = FILTERS[name]
    return (2 * delay + 1) * k * T / 2 + abs(b) * gain, (k + abs(b) * variation / T) * step / 2


def device(damping, friction, step, delay):
    """A device at 1 kHz, the delay in samples."""
    return zw.Device(
        damping=damping, coulomb_friction=friction, resolution=step, sample_period=T, delay=delay * T
    )


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize("name", FILTERS)
def test_proved_at_each_bound_and_not_below_it(name, delay, clamped):
    """At b and f_c of the theorem a contact certificate; a billionth below either, none."""
    random = Random(f"{name} {delay}")
    k, b, step = draw(random, 10, 1000), random.choice([-1, 1]) * draw(random, 0.01, 1), Fraction("0.0002")
    law = zw.Wall(k, b, FILTERS[name][0], clamped=clamped)
    damping, friction = bounds(k, b, name, step, delay)
    for more in (1, 1 + TINY):
        verdict = check_by_closed_forms(device(damping * more, friction * more, step, delay), law)
        assert verdict.outcome == "passive"
        assert verdict.certificate.kind == "contact"
        assert verify_document(verdict.certificate.to_dict()).valid
        assert verdict.scope.contact == "made and broken"
        assert verdict.scope.also == (() if clamped else ("clamped",))
    for short in (
        device(damping * (1 - TINY), friction, step, delay),
        device(damping, friction * (1 - TINY), step, delay),
    ):
        verdict = check_by_closed_forms(short, law)
        assert verdict.certificate is None or verdict.certificate.kind != "contact"
        if verdict.certificate is not None and verdict.certificate.kind != "multiplier contact":
            assert not clamped
            assert verdict.scope.contact == "kept"


@seeds(8)
def test_both_bounds_are_necessary_for_the_backward_difference(seed):
    """B ≥ 0 without delay: a thousandth below either bound a motion takes energy out."""
    random = Random(seed)
    k, b, step = draw(random, 10, 1000), draw(random, 0.005, 1), draw(random, 1e-5, 1e-3)
    damping = forms.damped_wall_damping(k, b, T).fraction
    friction = forms.damped_wall_friction(k, b, step, T).fraction
    assert damping / (k * T) == Fraction(1, 2) + b / (k * T)  # β ≥ ½ + β_v
    assert friction / (k * step) == Fraction(1, 2) + b / (k * T)  # σ ≥ ½ + β_v
    enough = check_by_closed_forms(device(damping, friction, step, 0), zw.Wall(k, b))
    assert enough.certificate.kind == "contact"
    short = 1 - Fraction(1, 1000)
    for active in (device(damping * short, friction, step, 0), device(damping, friction * short, step, 0)):
        verdict = check_by_closed_forms(active, zw.Wall(k, b))
        assert verdict.outcome == "active"
        assert verdict.witness.verify()


@seeds(15)
def test_closed_forms(seed):
    """Both bounds by hand: any delay in whole samples, windows and one pole by the span of their memory."""
    random = Random(seed)
    k, b = draw(random, 1, 1e4), random.choice([-1, 1]) * draw(random, 1e-3, 9)
    step = draw(random, 1e-6, 1e-2)
    delay, samples, tau = random.randint(0, 5), random.randint(1, 30), draw(random, 1e-4, 1)
    for velocity, memory in (
        (zw.rendering.BackwardDifference(), T),
        (zw.rendering.Window(samples), samples * T),
        (zw.rendering.OnePole(tau), T + tau),
    ):
        decision = decide(device(1, 1, step, delay), zw.Wall(k, b, velocity))
        enough = forms.damped_wall_damping(k, b, T, delay).fraction
        assert decision.wall.required_damping(decision.loop) == enough >= decision.contact_damping
        friction = forms.damped_wall_friction(k, b, step, memory).fraction
        assert decision.wall.required_friction(step, T) == friction
    if b > 0:
        assert forms.damped_wall_friction(k, b, step, T) == forms.quantized_kelvin_voigt_friction(
            k, b, step, T
        )
    assert forms.damped_wall_damping(k, b, T) == forms.kelvin_voigt_damping(k, b, T)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: forms.damped_wall_damping(1, 1, T, Fraction(1, 2)), "delay_samples is a whole number"),
        (lambda: forms.damped_wall_damping(1, 1, T, -1), "delay_samples must be ≥ 0"),
        (lambda: forms.damped_wall_damping(-1, 1, T), "stiffness must be ≥ 0"),
        (lambda: forms.damped_wall_friction(1, 1, T, 0), "memory must be > 0"),
    ],
)
def test_outside_the_hypotheses(call, message):
    with pytest.raises(zw.InputError, match=message):
        call()


SURFACES = ("masked", "clamped", "clamped outside too", "fed with the penetration", "anything allowed")


class Touch:
    """A damped wall run by its definition in rational numbers, and the storage of the proof."""

    def __init__(self, random, surface, weights, k, b, step, delay):
        self.random, self.surface, self.weights, self.k, self.b = random, surface, weights, k, b
        self.step, self.delay = step, delay
        self.x = [-2 * step - Fraction(1, 3)] * (len(weights) + delay + 2)
        self.forces = [Fraction(0)] * (delay + 1)

    def sample(self):
        """Read the encoder and send the force on its way; returns the one that acts now."""
        q = [self.step * (v // self.step) if self.step else v for v in self.x[-len(self.weights) - 1 :]][::-1]
        if self.surface == "fed with the penetration":
            q = [max(v, 0) for v in q]
        v = sum(w * (a - c) for w, a, c in zip(self.weights, q, q[1:], strict=False)) / T
        spring, damper = self.k * max(q[0], 0), self.b * v
        force = spring + damper
        if self.surface == "masked" and q[0] <= 0:
            force = 0
        elif self.surface.startswith("clamped"):
            force = max(self.k * q[0] + damper, 0) if q[0] > 0 or "too" in self.surface else 0
        elif self.surface == "anything allowed":
            force = spring + damper * Fraction(self.random.randint(-4, 4), 4)
        self.forces.append(Fraction(force))
        return self.forces[-1 - self.delay]

    def stored(self, x):
        """V of the proof, after the positions x."""
        moves = [a - c for a, c in zip(x[:0:-1], x[-2::-1], strict=True)]
        total = self.k * max(x[-1] - self.step / 2, 0) ** 2 / 2
        for i, move in enumerate(moves[: len(self.weights) + self.delay]):
            later = sum(abs(w) for w in self.weights[max(0, i - self.delay) :])
            total += (abs(self.b) / T * later + self.k * max(self.delay - i, 0)) * move**2 / 2
        return total

    def wishes(self, force, damping, size):
        """Places where a clever hand may want to be next."""
        here = self.x[-1]
        yield here + size * Fraction(self.random.randint(-100, 100), 100)
        yield -here
        yield here - force * T / (2 * damping)
        if self.step:
            edge = self.step * (here // self.step + self.random.randint(-1, 1))
            yield from (edge, edge - Fraction(1, 10**9))
            yield here + self.random.choice([-1, 1]) * self.step / 10**6

    def least_left(self, damping, friction, moves):
        """The smallest V that any step left over, and the energy put in along the way taken."""
        least, put_in, size = Fraction(0), Fraction(0), self.random.choice([Fraction(1, 100), 1, 30])
        before = self.stored(self.x)
        for _ in range(moves):
            force = self.sample()
            options = []
            for there in self.wishes(force, damping, size):
                move = there - self.x[-1]
                work = force * move + friction * abs(move) + damping * move**2 / T
                options.append((work - self.stored([*self.x, there]) + before, work, there))
            least = min(least, *(left for left, _, _ in options))
            _, work, there = min(options) if self.random.random() < 0.6 else self.random.choice(options)
            put_in += work
            assert least < 0 or put_in >= 0
            self.x.append(there)
            before = self.stored(self.x)
        return least, put_in


def touch(seed, surface):
    """A random wall with a random finite estimate, as zwidth and as its definition see it."""
    random = Random(f"{seed} {surface}")
    weights = random.choice([[Fraction(1)], [Fraction(1, 3)] * 3, [Fraction(n, 4) for n in (3, -2, 5)]])
    k, b = draw(random, 1, 500), random.choice([-1, 1]) * draw(random, 0.01, 2)
    step, delay = random.choice([Fraction(0), draw(random, 1e-4, 0.1)]), random.randint(0, 2)
    velocity = zw.rendering.VelocityFilter(weights, [1, *[0] * (len(weights) - 1)])
    law = zw.Wall(k, b, velocity, clamped=surface.startswith("clamped"))
    decision = decide(device(1, 1, step, delay), law)
    enough = decision.wall.required_damping(decision.loop), decision.wall.required_friction(step, T)
    return Touch(random, surface, weights, k, b, step, delay), enough, law


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("seed", range(6))
def test_no_hand_takes_energy_out_of_a_certified_wall(seed, surface):
    hand, (damping, friction), law = touch(seed, surface)
    verdict = check_by_closed_forms(device(damping, friction, hand.step, hand.delay), law)
    assert (verdict.outcome, verdict.certificate.kind) == ("passive", "contact")
    least, put_in = hand.least_left(damping, friction, 60)
    assert least == 0
    assert put_in >= 0


@pytest.mark.parametrize("share", [(Fraction("0.9"), 1), (1, Fraction("0.3"))])
def test_the_same_hand_is_not_blind(share):
    """With less damping, or less friction where there is an encoder, some step breaks the storage."""

    def least(seed):
        hand, (damping, friction), _ = touch(seed, "anything allowed")
        return hand.least_left(damping * share[0], friction * share[1], 60)[0]

    assert any(least(seed) < 0 for seed in range(12))


LATE = [Fraction(1, 2), Fraction(1, 10), Fraction("1.4"), Fraction("2.75")]
"""Delays of part of a sample, in samples."""
WEIGHTS = {"backward difference": [1.0], "window": [0.2] * 5, "finite response": [0.0, 1.5, -0.5]}


def need(k, b, name, late):
    """½ (Q + √(Q² + α(1 − α) S²)), Q = (2d + 1 + 2α) K T/2 + |B| Σ|w|, S = K T + 2 |B| Σ|w|."""
    asked, alpha = abs(b) * FILTERS[name][1], float(late % 1)
    linear = float(2 * late + 1) * k * float(T) / 2 + asked
    return (linear + sqrt(linear**2 + alpha * (1 - alpha) * (k * float(T) + 2 * asked) ** 2)) / 2


def encoded(seed, name):
    """K, B, the encoder's step and the Coulomb friction that pays for it, in floats."""
    random = Random(f"{seed} {name}")
    k, b = random.uniform(10, 900), random.choice([-1, 1]) * random.uniform(0.01, 1)
    step = random.choice([0, 2e-4])
    return k, b, step, bounds(k, b, name, step, 0)[1] * (1 + 1e-12)


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("late", LATE)
@pytest.mark.parametrize("name", WEIGHTS)
def test_part_of_a_sample_late_it_is_proved_from_the_root_on(name, late, clamped):
    """A billionth above it the checker accepts contact made and broken; a billionth below, nothing."""
    k, b, step, friction = encoded(late, name)
    law = zw.Wall(k, b, FILTERS[name][0], clamped=clamped)
    above, below = (
        check_by_closed_forms(device(need(k, b, name, late) * share, friction, step, late), law)
        for share in (1 + 1e-9, 1 - 1e-9)
    )
    assert (above.outcome, above.certificate.kind) == ("passive", "contact")
    assert verify_document(above.certificate.to_dict()).valid
    assert below.outcome != "passive"


def forces(x, k, b, weights, step, surface):
    """f(k) of a wall that acts inside only, or never pulls, or whatever |r| ≤ |B v| allows; in floats."""
    out = []
    random = Random(len(x))
    read = [x[0]] * len(weights) + [step * (v // step) if step else v for v in x]
    for place in range(len(weights), len(read)):
        moves = [read[place - j] - read[place - j - 1] for j in range(len(weights))]
        damper = b * sum(w * move for w, move in zip(weights, moves, strict=True)) / float(T)
        q = read[place]
        if surface == "anything allowed":
            out.append(k * max(q, 0) + damper * random.choice([-1, 0, 1]))
        else:
            force = k * q + damper if q > 0 else 0.0
            out.append(max(force, 0.0) if surface == "clamped" else force)
    return out


def motion(random, samples=60):
    """From rest outside: in and out in a rhythm, with some chance, and out again."""
    size = random.choice([1e-3, 3e-2, 1.0])
    centre, rhythm = random.uniform(-1, 1) * size, random.choice([[1, -1], [1, 1, -1, -1], [1, 0, -1]])
    inside = [
        centre + size * rhythm[n % len(rhythm)] * random.uniform(0.7, 1) + random.gauss(0, size / 9)
        for n in range(samples)
    ]
    return [-2 * size] * 3 + inside + [-2 * size] * 9


def got(seed, surface, share):
    """What a hand gets out along a motion at `share` of the damping of the theorem, and its largest work."""
    random = Random(f"{seed} {surface}")
    name, late = random.choice(list(WEIGHTS)), random.choice(LATE)
    k, b, step, friction = encoded(seed, name)
    x, part = motion(random), float(late % 1)
    held = {"damping": need(k, b, name, late) * share, "friction": friction, "period": float(T)}
    force = [0.0] * (int(late) + 1) + forces(x, k, b, WEIGHTS[name], step, surface)
    total, most = 0.0, 0.0
    for n, (here, there) in enumerate(pairwise(x)):
        turn = best_switch(here, there, force[n], force[n + 1], part=part, **held)
        for acting, way, time in ((force[n], turn - here, part), (force[n + 1], there - turn, 1 - part)):
            work = acting * way + friction * abs(way) + held["damping"] * way * way / (time * held["period"])
            total, most = total - work, max(most, abs(work))
    return total, most


@pytest.mark.parametrize("surface", ["masked", "clamped", "anything allowed"])
def test_part_of_a_sample_late_no_hand_gets_energy_out_at_the_bound(surface):
    """And with a third of the damping some hands do."""
    for seed in range(60):
        energy, most = got(seed, surface, 1.0)
        assert energy <= 1e-12 * most
    assert max(energy - 1e-9 * most for energy, most in (got(seed, surface, 0.33) for seed in range(60))) > 0


DEVICE = device("0.5", "0.2", "0.0005", 1)


def test_rotary_certificate():
    knob = zw.Device(
        damping="0.004", coulomb_friction="0.01", resolution="0.0015", rate=2000, motion="rotary"
    )
    verdict = check_by_closed_forms(knob, zw.Wall(3, "0.001"))
    assert set(verdict.certificate.to_dict()["law"]) == {
        "stiffness_N_m_per_rad", "virtual_damping_N_m_s_per_rad", "weights"
    }  # fmt: skip
    assert verdict.certificate.verify()


@pytest.mark.parametrize(
    ("law", "delay"),
    [(zw.Wall(180, "0.25", zw.rendering.Window(4)), 0), (zw.StandardLinearSolid(100, 20, "0.1"), 1)],
    ids=["a filter that needs less", "a solid with delay"],
)
def test_where_it_does_not_apply(law, delay):
    """The linear proof stays, for sustained contact; clamped, the same law is undecided and says why."""
    loop = device("0.2", "0.2", "0.0005", delay)
    verdict = check_by_closed_forms(loop, law)
    assert (verdict.outcome, verdict.certificate.kind) == ("passive in contact", "quantized")
    assert verdict.scope.contact == "kept"
    clamped = check_by_closed_forms(loop, law.replace(clamped=True))
    assert (clamped.outcome, clamped.certificate, clamped.witness) == ("undecided", None, None)
    assert clamped.claim.startswith("Of a law whose force is clamped no exact condition is known")
    assert clamped.scope.contact == "made and broken"
    assert " N·s/m, the device has 0.2 N·s/m; Coulomb friction of " in clamped.claim
    assert " N, it has 0.2 N. For a proof, lower the stiffness from " in clamped.claim


def test_an_active_clamped_wall_has_a_motion_of_its_own():
    """A witness in the linear law is not shown for the clamped one; what would be enough is named."""
    loop = device("0.1", 0, 0, 0)
    assert check_by_closed_forms(loop, zw.Wall(300, "0.1")).outcome == "active"
    verdict = check_by_closed_forms(loop, zw.Wall(300, "0.1", clamped=True))
    assert verdict.outcome == "active"
    assert verdict.witness.to_dict()["law"] == {"fed_with": "position", "never_pulls": True}
    assert verdict.required_damping == 0.25
    assert verdict.margins["damping"] == pytest.approx(-0.15)
    assert verdict.max_stiffness == 0


def test_a_clamped_spring_is_the_spring():
    for k in (300, 770):
        loop = device("0.15", "0.12", "0.0000224", 0)
        plain, clamped = (check_by_closed_forms(loop, zw.Wall(k, clamped=c)) for c in (False, True))
        assert plain.to_dict() == clamped.to_dict()


@pytest.mark.parametrize(("short", "limited"), [(0, True), (TINY, False)])
def test_the_limit_of_a_clamped_wall(short, limited):
    loop = device(Fraction("0.25"), 1, 0, 0)
    verdict = check_by_closed_forms(loop, zw.Wall(300, Fraction("0.1") - short, clamped=True))
    assert verdict.outcome == "passive"
    assert ("exactly at its limit" in verdict.claim) is limited


CLAMPED = zw.Wall(100, "0.02", clamped=True)
INTERVALS = {
    "law": (DEVICE, zw.Wall((100, 180), ("-0.02", "0.05")), "passive", True),
    "clamped": (DEVICE, zw.Wall((100, 180), ("-0.02", "0.05"), clamped=True), "passive", True),
    "clamped, from no damping on": (DEVICE, zw.Wall(180, (0, "0.05"), clamped=True), "passive", True),
    "timing and all": (
        DEVICE.replace(delay=0, sample_period=("0.0005", "0.001")),
        zw.Wall((100, 180), ("-0.02", "0.02"), zw.rendering.OnePole((0, "0.003"))), "passive", True,
    ),
    "one corner in sustained contact": (
        device("0.2", "0.2", "0.0005", 0), zw.Wall(180, ("0.01", "0.25"), zw.rendering.Window(4)),
        "passive in contact", False,
    ),
    "one corner by the multiplier": (
        device("0.3", "0.2", "0.0005", 0),
        zw.Wall(180, ("0.01", "0.25"), zw.rendering.Window(4)), "passive", True
    ),
    "one corner too many, clamped": (
        device("0.3", "0.2", "0.0005", 0), zw.Wall(180, ("0.01", "0.25"), clamped=True), "undecided", None
    ),
    "delays": (DEVICE.replace(delay=(0, "0.001")), zw.Wall(100, "0.02"), "passive in contact", False),
    "delays, clamped": (DEVICE.replace(delay=(0, "0.001")), CLAMPED, "undecided", None),
    "no virtual damping at its best, clamped": (
        device("0.1", 0, 0, 0), zw.Wall(300, (0, "0.1"), clamped=True), "undecided", None
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", INTERVALS)
def test_intervals(name):
    """Contact is claimed for a box only if it is proved at every corner, and between them."""
    loop, law, outcome, covered = INTERVALS[name]
    verdict = check_by_closed_forms(loop, law)
    assert verdict.outcome == outcome
    if covered is None:
        assert verdict.certificate is None
        return
    assert verdict.certificate.covered().contact == ("made and broken" if covered else "kept")
    assert verdict.scope.contact == verdict.certificate.covered().contact
    assert verify_document(verdict.certificate.to_dict()).valid
