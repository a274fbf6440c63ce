"""Is a network of which the waves are known passive?

    b = S a,    power in = |a|² − |b|²,    passive ⇔ S bounded real: stable, ‖S(jω)‖ ≤ 1 at every frequency

(Anderson & Vongpanitlerd, Network Analysis and Synthesis, 1973, ch. 2.)  With u = a − Σb and y = a + Σb,
Σ of signs, uᵀy is that power, and some Σ makes u invertible: then S is bounded real exactly if u → y
is positive real, which is decided, proved and refuted as for every other port.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from itertools import product
from math import inf, isfinite, sqrt
from typing import Any

import numpy as np
from flint import fmpq_poly

from zwidth.errors import InputError
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.ports.evidence import index_document, proof_document
from zwidth.passivity.ports.index import PassivityIndex, PortAnswer, told_place
from zwidth.passivity.ports.largest import largest_level
from zwidth.passivity.ports.port import Polynomials, Port, as_polynomials, leverrier, typed_at_most
from zwidth.passivity.ports.positive_real import OFFSET, Band, bands, in_words, is_stable, prove_level
from zwidth.passivity.ports.reading import assumed_period, from_polynomials, read_port
from zwidth.passivity.result import share_left
from zwidth.quantity.answered import answered, answers, known
from zwidth.quantity.exact import Exact, RealLike
from zwidth.showing import Part, Shown


@dataclass(frozen=True, repr=False)
class ScatteringPassivity(PortAnswer):
    """What `scattering_passivity` found."""

    _FORMAT = "zwidth scattering 1"

    signs: tuple[int, ...] = answered("Σ: which sign each b has in u = a − Σb and y = a + Σb")
    input: PassivityIndex = known("the input index of u → y; ≥ 0 where S is bounded real")
    assumed: tuple[str, ...] = known("what is assumed of the sample period; () where it is said", default=())

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        if self.outcome == "undecided":
            return "Nothing that the checker accepts was found: nothing is proved."
        if self.outcome == "passive":
            return "No waves into this network, from rest, bring back more than they carry."
        return "Waves into this network, from rest, bring back more than they carry."

    @property
    def assumptions(self) -> tuple[str, ...]:
        """That of which S is the waves; and a sample period that nobody says."""
        return ("every port has a positive real reference, which S was made with", *self.assumed)

    @cached_property
    @answers("‖S‖; null where it is without bound", stands_as={"largest_gain": "value"})
    def gain(self) -> RelativeIndex:
        """‖S‖∞: how much of a wave comes back, at most."""
        return relative_index(self.input.port)

    def _left(self) -> float | None:
        """1 − ‖S‖∞."""
        return share_left(self.gain.value, 1)

    def waves(self, points: int = 1000) -> tuple[list[float], list[list[float]], list[list[float]]] | None:
        """(t [s], a, b) of the witness, a signal for each port; None where there is no witness."""
        if self.witness is None:
            return None
        t, u, y = self.witness.signals(points)
        if len(self.signs) == 1:
            u, y = [u], [y]
        a = [[(p + q) / 2 for p, q in zip(*axis, strict=True)] for axis in zip(u, y, strict=True)]
        b = [
            [sign * (q - p) / 2 for p, q in zip(*axis, strict=True)]
            for sign, axis in zip(self.signs, zip(u, y, strict=True), strict=True)
        ]
        return t, a, b

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        rows = [("largest gain", self.gain.describe().replace("R = ", "‖S‖ = "))]
        if self.bands:
            rows.append(("violated", in_words(self.bands)))
        if not self.hidden_modes_decay:
            rows.append(("hidden", "a cancelled mode does not decay"))
        return rows


def scattering_passivity(system: Any) -> ScatteringPassivity:
    """Whether S is bounded real, exactly, with a proof or with waves that bring back more than they carry.

    Parameters
    ----------
    system
        S, a rational matrix from incident waves a to reflected waves b, each port with a positive real
        reference: a system of python-control, scipy.signal or harold, continuous or discrete.  For a
        table of measured or simulated samples there is `scattering_table`.

    Raises
    ------
    InputError
        As `passivity_indices`.
    """
    signs, port = direct_power_of(read_port(system), Fraction(1))
    return ScatteringPassivity(
        signs, PassivityIndex("input", port, largest_level(port)), assumed_period(system)
    )


# The relative index of a port: how much of a wave comes back, at most.
#
#     R = least with ∫ |y − z u|² ≤ R² ∫ |y + z u|²,   R = ‖S‖∞,   S = (G − z)(G + z)⁻¹
#
# from rest.  S is the scattering matrix at the reference z, in the unit of y/u; the port is passive if and
# only if R ≤ 1, whatever z (Anderson & Vongpanitlerd, Network Analysis and Synthesis, 1973, sec. 2.6-2.7).
# For R itself the reference counts: it says against what "all comes back" is measured.
#
# R holds if and only if the port of u' = R a − b, y' = R a + b, a = y + z u, b = y − z u is positive real at
# level 0; so one decision and one kind of proof serve here too.  The largest is found from band to band
# (Bruinsma & Steinbuch, Systems & Control Letters 14, 1990).


_CLOSE = Fraction(1, 10**12)
"""Relative distance of the two ends between which R is told."""

_SIMPLE = 10**5
"""Denominators of levels that are tried for R itself, such as 1."""

_MOST_ROUNDS = 60

_SMALLEST = Fraction(1, 10**9)
"""Below it R is not told apart from 0."""


@dataclass(frozen=True, repr=False)
class RelativeIndex(Shown):
    """How much of a wave comes back from a port, at most, with where."""

    port: Port = known("G")
    reference: Fraction = known("z, in the unit of output over input")
    bounds: tuple[Fraction, Fraction] | None = known(
        "rationals between which R lies, both decided exactly; None where it is without bound: some wave "
        "from rest comes back without end"
    )
    cosine: Fraction | None = known(
        "c = cos θ of the frequency at which R is reached, to some digits; None where it is without bound"
    )

    @property
    def value(self) -> float:
        """The least double that is proved; inf where none is."""
        return inf if self.bounds is None else -typed_at_most(-self.bounds[1])

    @property
    def frequency(self) -> float | None:
        """Where it is reached [Hz]; inf in the limit; None where R is without bound."""
        return None if self.cosine is None else self.port.frequency(self.cosine)

    def at_most(self, level: RealLike) -> bool:
        """Whether R is at most this level, decided exactly."""
        return _holds(waves_of(self.port, self.reference), _positive(level))

    def bands(self, level: RealLike = 1) -> tuple[Band, ...]:
        """Where more than this level comes back: the bands of violation at level 1."""
        return bands(power_of(waves_of(self.port, self.reference), _positive(level)), Fraction(0))

    def certificate(self, level: RealLike | None = None) -> Certificate:
        """The proof that R is at most the level, by default `value`: of the port (u', y') that it makes.

        Raises
        ------
        InputError
            If it is more, or has no finite value.
        """
        if level is None and self.bounds is None:
            raise InputError("the relative index is without bound; there is nothing to certify")
        at = Fraction(repr(self.value)) if level is None else _positive(level)
        _, port = direct_power_of(waves_of(self.port, self.reference), at)
        proof = prove_level(port, Fraction(0))
        if proof is None:
            raise InputError(
                f"the relative index is {self.value:.17g}, so {float(at):.17g} cannot be certified; "
                "give a higher level"
            )
        return Certificate((index_document("input", port, Fraction(0), proof_document(proof)),))

    def describe(self) -> str:
        """The index in a line."""
        if self.bounds is None:
            return "R = ∞: there is an unstable pole, or a wave comes back without end"
        return f"R = {self.value:.9g} {told_place(self.frequency)}"

    def __repr__(self) -> str:
        return f"<RelativeIndex {self.describe()}>"

    def report(self) -> Iterable[Part]:
        """What it is."""
        yield f"relative index {self.describe()}"


def relative_index(port: Port, reference: RealLike = 1) -> RelativeIndex:
    """R of a port at a reference, between two rationals a part in 10¹² from each other."""
    z = Exact(reference).fraction
    if z <= 0:
        raise InputError(
            f"the reference of a wave must be > 0, got {float(z):g}: a + b and a − b are scaled by it"
        )
    if not is_stable(port, OFFSET - z):
        return RelativeIndex(port, z, None, None)
    waves = waves_of(port, z)
    cosine = max((Fraction(1), Fraction(0), Fraction(-1)), key=partial(_reflected, waves))
    low = _lower(_reflected(waves, cosine))
    for _ in range(_MOST_ROUNDS):
        high = low * (1 + _CLOSE)
        above = bands(power_of(waves, high), Fraction(0))
        if not above:
            break
        cosine = max((band.middle for band in above), key=partial(_reflected, waves))
        low = max(high, _lower(_reflected(waves, cosine)))
    low, high = _narrowed(partial(_holds, waves), low, high)
    simple = high.limit_denominator(_SIMPLE)
    if low <= simple < high and _holds(waves, simple):
        high = simple
    return RelativeIndex(port, z, (Fraction(0) if low <= _SMALLEST else low, high), cosine)


def _narrowed(holds: Callable[[Fraction], bool], low: Fraction, high: Fraction) -> tuple[Fraction, Fraction]:
    """Both ends where rounding had put them on the wrong side: `high` holds, `low` does not, or is least."""
    step = _CLOSE
    while not holds(high):
        low, high, step = high, high * (1 + step), 4 * step
    step = _CLOSE
    while low > _SMALLEST and holds(low):
        low, high, step = max(low * (1 - min(step, Fraction(1, 2))), _SMALLEST), low, 4 * step
    while high - low > 2 * _CLOSE * high and high > _SMALLEST:
        middle = Fraction(f"{float((low + high) / 2):.15g}")
        low, high = (low, middle) if holds(middle) else (middle, high)
    return low, high


def _positive(level: RealLike) -> Fraction:
    value = Exact(level).fraction
    if value <= 0:
        raise InputError(
            f"a level of the relative index must be > 0, got {float(value):g}: it is a ratio of sizes"
        )
    return value


def _lower(value: float) -> Fraction:
    """In few digits, and not 0."""
    return max(Fraction(f"{value:.15g}"), _SMALLEST)


def _holds(waves: Port, level: Fraction) -> bool:
    return prove_level(power_of(waves, level), Fraction(0)) is not None


def _reflected(waves: Port, cosine: Fraction) -> float:
    """The largest singular value of S at c, to rounding; of an S that is stable.

    Beside it where the waves in are not independent, as at c = −1 of polynomials of unlike degrees.
    """
    for beside in (Fraction(0), Fraction(1, 2**20), Fraction(1, 2**12)):
        found = _size_at(waves, cosine * (1 - beside))
        if isfinite(found):
            return found
    return 0.0


def _size_at(waves: Port, cosine: Fraction) -> float:
    zeta = complex(float(cosine), -sqrt(max(float(1 - cosine**2), 0.0)))
    back, into = waves.on_circle
    bits = max(c.bit_length() for side in (back, into) for row in side for p in row for c in p)

    def at(side: Any) -> Any:
        shift = max(bits - 900, 0)
        return np.array(
            [[np.polyval([float(c >> shift) for c in p[::-1]], zeta) for p in row] for row in side]
        )

    try:
        scattering = np.linalg.solve(at(into).T, at(back).T)
    except np.linalg.LinAlgError:
        return inf
    return float(np.linalg.norm(scattering, 2))


# Waves into a port and out of it, and the port that takes in what they carry.
#
#     a = y + z u,  b = y − z u      of a port u → y at the reference z > 0
#     u' = R a − Σb,  y' = R a + Σb,  u'ᵀy' = R² |a|² − |b|²      Σ of signs
#
# b = S a with ‖S‖ ≤ R if and only if u' → y' is positive real, whatever Σ, as long as there is such a port.
# det(R a − Σb) = det a · det(R − ΣS), and R − ΣD is invertible for some Σ, whatever D = S(∞): of all Σ one
# with the highest degree is taken, so that y' answers u' as soon as b answers a.


Signs = tuple[int, ...]


def waves_of(port: Port, reference: Fraction) -> Port:
    """b from a, of a port from u to y."""
    own, other = reference.denominator, reference.numerator
    back, into = (_mixed(port, own, sign * other) for sign in (-1, 1))
    return _with(port, back, into)


def power_of(waves: Port, level: Fraction, signs: Sequence[int] | None = None) -> Port:
    """u' = R a − Σb and y' = R a + Σb at R = level; Σ = 1 where no signs are given."""
    top, bottom = level.numerator, level.denominator
    signs = signs or (1,) * waves.axes
    outputs, inputs = (_mixed(waves, [way * sign * bottom for sign in signs], top) for way in (1, -1))
    return _with(waves, outputs, inputs)


def direct_power_of(waves: Port, level: Fraction) -> tuple[Signs, Port]:
    """Σ, and y' as N/d times u', for a document."""
    highest = _degree(waves.inputs)
    best, chosen = -1, (1,) * waves.axes
    for signs in product((1, -1), repeat=waves.axes):
        degree = _degree(power_of(waves, level, signs).inputs)
        if degree > best:
            best, chosen = degree, signs
        if degree == highest:
            break
    assert best >= 0, "R − ΣS is invertible for some signs Σ"
    return chosen, _direct(power_of(waves, level, chosen))


def _direct(port: Port) -> Port:
    if port.axes == 1:
        return port
    fraction = port.fraction()
    assert fraction is not None, "u' has an inverse"
    return from_polynomials(fraction[1], fraction[0], port.time, port.period, port.hidden_modes_decay)


def _with(port: Port, outputs: Polynomials, inputs: Polynomials) -> Port:
    """Other sides of the same signals."""
    denominator = inputs[0][0] if port.axes == 1 else port.denominator
    return Port(outputs, inputs, denominator, port.time, port.period, port.hidden_modes_decay)


def _mixed(port: Port, of_outputs: int | Sequence[int], of_inputs: int) -> Polynomials:
    """Rows of N and D, added so many times."""
    times = [of_outputs] * port.axes if isinstance(of_outputs, int) else of_outputs
    return tuple(
        tuple(_sum(n, of_n, d, of_inputs) for n, d in zip(*rows, strict=True))
        for of_n, *rows in zip(times, port.outputs, port.inputs, strict=True)
    )


def _sum(n: tuple[int, ...], of_n: int, d: tuple[int, ...], of_d: int) -> tuple[int, ...]:
    size = max(len(n), len(d))
    first, second = ((*p, *(0,) * (size - len(p))) for p in (n, d))
    total = [x * of_n + y * of_d for x, y in zip(first, second, strict=True)]
    while len(total) > 1 and not total[-1]:
        total.pop()
    return tuple(total)


def _degree(side: Polynomials) -> int:
    """Of the determinant; −1 where it vanishes."""
    if len(side) == 1:
        return len(side[0][0]) - 1 if any(side[0][0]) else -1
    return int(leverrier(as_polynomials(side), fmpq_poly([1])).minors[-1].degree())
