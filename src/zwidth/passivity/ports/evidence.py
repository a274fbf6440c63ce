"""An input by which a port gives out more than a level allows: the search for it, and documents."""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import acos, log10, pi, sin, sqrt
from typing import Any, Literal

import numpy as np
from flint import fmpq, fmpq_mat, fmpz_poly

from zwidth.passivity.certificate import FORMAT, positivity_document
from zwidth.passivity.linear.exact_algebra import as_real, negative_direction
from zwidth.passivity.ports.circle import places_of
from zwidth.passivity.ports.motion import (
    Axes,
    Motion,
    absorbed,
    absorbed_at,
    absorbed_in_samples,
    answer,
    answers,
    form_at,
    place,
    played,
    to_float,
)
from zwidth.passivity.ports.port import Port
from zwidth.passivity.ports.positive_real import OFFSET, Proof, prove_minors
from zwidth.passivity.result import Evidence
from zwidth.quantity.balls import as_fmpq, as_fraction
from zwidth.quantity.text import shown


@dataclass(frozen=True, repr=False)
class ExtractingInput(Evidence):
    """An input from rest by which a port gives out more than a level of its index allows.

    Attributes
    ----------
    document
        The system, the level and the motion, as the independent checker reads them.
    share
        What comes out above the level, per ∫ u² (∫ y² for the output index).
    port, motion
        F and φ, from which u and y follow.
    """

    document: dict[str, Any]
    share: float
    port: Port
    motion: Motion

    @property
    def kind(self) -> str:
        """ "burst", a sinusoid that fades in and out; "polynomial" or "sequence"."""
        return self.motion.kind

    @property
    def frequency(self) -> float | None:
        """Of a burst, its middle frequency [Hz]; None for another motion."""
        return None if self.kind != "burst" else float(self._middle()) / (2 * pi)

    @property
    def phasors(self) -> list[tuple[float, float]]:
        """Of a burst, each input's (amplitude, the largest 1; phase [rad]) at the middle frequency."""
        if self.kind != "burst":
            return []
        side = self.port.inputs if self._is_of_input() else self.port.outputs
        found = answer(side, place(self.port, self._middle()), self.motion.axes)
        u = [complex(*map(to_float, a)) for a in found]
        largest = max(u, key=abs)
        return [(abs(a / largest), phase(a / largest)) for a in u]

    def signals(self, points: int = 1000) -> tuple[list[float], Any, Any]:
        """(t [s], u, y), u with a peak of 1; of a discrete port its samples, whatever `points`.

        With several axes u and y are lists of one signal for each.
        """
        t, u, y = played(self.port, self.motion, points)
        if not self._is_of_input():
            u, y = y, u
        peak = max(abs(a) for axis in u for a in axis) or 1.0
        u, y = ([[a / peak for a in axis] for axis in side] for side in (u, y))
        return (t, u[0], y[0]) if self.port.axes == 1 else (t, u, y)

    def to_dict(self) -> dict[str, Any]:
        """The motion as plain data."""
        return self.document

    def describe(self) -> str:
        """The motion in a sentence."""
        of = "∫u²" if self._is_of_input() else "∫y²"
        if self.port.time == "discrete":
            of = of.replace("∫", "Σ")
        axes = f" in {self.port.axes} axes" if self.port.axes > 1 else ""
        return f"{self._form()}{axes}, from rest: {self.share:.4g} {of} comes out above the level"

    def _form(self) -> str:
        if self.kind == "burst":
            return f"a burst of {shown(self.frequency or 0, 'Hz', 6)}"
        if self.kind == "polynomial":
            return f"a polynomial over {shown(float(self.motion.numbers[0]), 's', 4)}"
        return f"{len(self.motion.axes[0])} samples"

    def _is_of_input(self) -> bool:
        return bool(self.document["index"] == "input")

    def _middle(self) -> Fraction:
        """The middle frequency of a burst [rad/s]."""
        step, cycles, _ = self.motion.numbers
        return step * cycles


# The search for an input that takes more out of a port than a level allows.
#
# Where Π_σ has a negative eigenvalue, a burst at that frequency with the amplitudes and phases of its
# eigenvector does, if it is long enough.  Where it has none and a pole lies where it may not, energy
# comes out of what grows: the form W of polynomials (or short sequences) is then not ≥ 0, and
# elimination says where.


_MOST_CYCLES = 1 << 22
_LONGEST_SEQUENCE = 1 << 17
_TERMS = 24
_LENGTHS = (2, 4, 8, 16, 32, 48)
_LARGEST_ORDER = 24

Kind = Literal["polynomial", "sequence"]

_ALONE: Axes = ((Fraction(1), Fraction(0)),)
"""One axis: its amplitude and phase only scale and shift a burst."""


def find_motion(port: Port, level: Fraction, cosine: Fraction | None) -> Motion | None:
    """A motion with W < 0 at the level, looked for at `cosine` first; None if none is found."""
    continuous = port.time == "continuous"
    for c in _frequencies(port, level, cosine):
        burst = _burst(port, level, c) if continuous else _discrete_burst(port, level, c)
        if burst is not None:
            return burst
    return _polynomial(port, level) if continuous else _sequence(port, level)


def _frequencies(port: Port, level: Fraction, cosine: Fraction | None) -> Iterator[Fraction]:
    """c at which Π_σ may be negative: the given one, and one where it is."""
    if cosine is not None and -1 < cosine < 1:
        yield cosine
    found = prove_minors(port, level)
    if isinstance(found, Fraction):
        yield found


def _burst(port: Port, level: Fraction, cosine: Fraction) -> Motion | None:
    """As few cycles as are enough; smooth enough for u and y to be without jumps."""
    omega, power = sqrt((1 - cosine) / (1 + cosine)), port.order // 2 + 1
    for axes in _directions(port, level, Fraction(omega)):
        cycles = power + 1
        while cycles <= _MOST_CYCLES:
            step = Fraction(f"{omega / cycles:.9g}")
            motion = Motion("burst", (step, Fraction(cycles), Fraction(power)), axes)
            if absorbed(port, level, motion) < 0:
                return motion
            cycles *= 2
    return None


def _discrete_burst(port: Port, level: Fraction, cosine: Fraction) -> Motion | None:
    """Windowed sinusoids in whole numbers and then rest, doubled in length until it is enough."""
    angle, tangent = acos(float(cosine)), Fraction(sqrt((1 - cosine) / (1 + cosine)))
    for axes in _directions(port, level, tangent):
        latent = np.array([complex(alpha, -beta) for alpha, beta in axes])
        length = 8
        while length * port.axes <= _LONGEST_SEQUENCE:
            window = np.array([sin(pi * (i + 1) / (length + 1)) ** 2 for i in range(length)])
            turns = np.exp(1j * angle * (np.arange(length) - (length - 1) / 2))
            phi = (latent[:, None] * window * turns).real / np.abs(latent).max()
            for scale in (10, 1000, 10**6):
                whole = np.rint(scale * phi).astype(int)
                rows = [[*row, *[0] * port.order] for row in whole.tolist()]
                if whole.any() and absorbed_in_samples(port, level, rows) < 0:
                    return Motion("sequence", (), tuple(tuple(map(Fraction, row)) for row in rows))
            length *= 2
    return None


def _directions(port: Port, level: Fraction, tangent: Fraction) -> Iterator[Axes]:
    """(α_i, β_i) with aᴴ Π_σ a < 0 at this place: the eigenvector in few digits, or one by elimination."""
    at = place(port, tangent)
    for axes in [_ALONE] if port.axes == 1 else _candidates(form_at(port, level, at)):
        if absorbed_at(port, level, at, axes) < 0:
            yield axes
            return


def _candidates(form: tuple[fmpq_mat, fmpq_mat]) -> Iterator[Axes]:
    scale = max(abs(x) for part in form for x in part.entries())
    if scale == 0:
        return
    real, imaginary = (np.array([[to_float(x / scale) for x in row] for row in p.tolist()]) for p in form)
    vector = np.linalg.eigh(real + 1j * imaginary)[1][:, 0]
    vector = vector / vector[np.argmax(np.abs(vector))]
    for digits in (4, 9, 15):
        yield tuple((_decimal(a.real, digits), _decimal(-a.imag, digits)) for a in vector)
    exact = negative_direction(as_real(*form))
    if exact is not None:
        size = form[0].nrows()
        values = [as_fraction(x) for x in exact]
        yield tuple((values[i], -values[size + i]) for i in range(size))


def _polynomial(port: Port, level: Fraction) -> Motion | None:
    """Polynomials over a few durations, of the pace at which the port grows."""
    lowest, terms = port.order, max(2, _TERMS // port.axes)
    if lowest > _LARGEST_ORDER:
        return None
    poles, width = port.poles(), range(lowest + terms)
    known = fmpz_poly(list(port.denominator)) if poles is None else poles.numer()
    means = fmpq_mat([[fmpq(1, i + j + 1) for j in width] for i in width])  # of xⁱ⁺ʲ over [0, 1]
    for tau in _paces(places_of(known)):
        found = _grown(port, level, "polynomial", (tau, Fraction(lowest)), terms, means)
        if found is not None:
            return found
    return None


def _sequence(port: Port, level: Fraction) -> Motion | None:
    """The first of growing lengths at which the form of φ is not ≥ 0."""
    for length in _LENGTHS:
        if length * port.axes > 2 * max(_LENGTHS):
            return None
        once = fmpq_mat([[fmpq(int(i == j)) for j in range(length)] for i in range(length)])
        found = _grown(port, level, "sequence", (), length, once)
        if found is not None:
            return found
    return None


def _grown(
    port: Port, level: Fraction, kind: Kind, head: tuple[Fraction, ...], terms: int, weight: fmpq_mat
) -> Motion | None:
    """A motion of so many terms with W < 0, in few digits where these are enough."""
    direction = negative_direction(_form(port, level, list(_units(kind, head, port.axes, terms)), weight))
    if direction is None:
        return None
    exact = [as_fraction(x) for x in direction]
    for digits in (3, 6, 12, 24):
        motion = Motion(kind, head, _by_axis(_rounded(exact, digits), port.axes))
        if absorbed(port, level, motion) < 0:
            return motion
    return Motion(kind, head, _by_axis(exact, port.axes))


def _units(kind: Kind, head: tuple[Fraction, ...], axes: int, terms: int) -> Iterator[Motion]:
    for one in range(axes * terms):
        numbers = [Fraction(int(k == one)) for k in range(axes * terms)]
        yield Motion(kind, head, _by_axis(numbers, axes))


def _form(port: Port, level: Fraction, motions: Sequence[Motion], weight: fmpq_mat) -> list[list[fmpq]]:
    """½ (u_iᵀz_j + u_jᵀz_i), z = y − σ u, of all pairs of motions: of coefficients, with their weight."""
    pairs, width = [answers(port, motion) for motion in motions], range(weight.ncols())
    total = fmpq_mat(len(pairs), len(pairs))
    for axis in range(port.axes):
        u, y = (fmpq_mat([[pair[side][axis][k] for k in width] for pair in pairs]) for side in (0, 1))
        total += u * weight * (y - u * as_fmpq(level)).transpose()
    form: list[list[fmpq]] = ((total + total.transpose()) * fmpq(1, 2)).tolist()
    return form


def _paces(places: Sequence[complex]) -> list[Fraction]:
    """Durations [s]: a few times 1/σ of what grows among the poles, and of the size of every one."""
    rates = [p.real for p in places if p.real > 1e-9 * abs(p)] + [abs(p) for p in places if p] + [1.0]
    return [Fraction(f"{factor / pace:.3g}") for factor in (2, 8, 32) for pace in rates]


def _rounded(values: Sequence[Fraction], digits: int) -> list[Fraction]:
    """To so many digits of the largest, as decimals."""
    largest = max(abs(v) for v in values)
    decade = digits - round(log10(largest)) if largest else 0
    unit = Fraction(10) ** decade
    return [Fraction(round(v * unit)) / unit for v in values]


def _by_axis(values: Sequence[Fraction], axes: int) -> Axes:
    terms = len(values) // axes
    return tuple(tuple(values[i * terms : (i + 1) * terms]) for i in range(axes))


def _decimal(value: float, digits: int) -> Fraction:
    return Fraction(f"{value:.{digits}f}")


def index_document(name: str, port: Port, level: Fraction, evidence: dict[str, Any]) -> dict[str, Any]:
    """`evidence`, a kind with a proof or a motion, about an index of a port from inputs to outputs."""
    claim = {"index": name, "level": str(level), "system": _system_document(port)}
    return {"format": FORMAT, "kind": evidence["kind"], **claim, **evidence}


def _system_document(port: Port) -> dict[str, Any]:
    denominator = _text(reversed(port.denominator))
    if port.axes == 1:
        numerator = _text(reversed(port.outputs[0][0]))
        return {"time": port.time, "numerator": numerator, "denominator": denominator}
    numerators = [[_text(reversed(p)) for p in row] for row in port.outputs]
    return {"time": port.time, "numerators": numerators, "denominator": denominator}


def proof_document(proof: Proof) -> dict[str, Any]:
    """The kind of a proof, and the proof."""
    if proof.resolvent is None:
        positivity = positivity_document(proof.minors[0].positivity)
        return {"kind": "positive real", "proof": {"offset": str(OFFSET), "positivity": positivity}}
    minors = [{"power": m.power, "positivity": positivity_document(m.positivity)} for m in proof.minors]
    resolvent = {
        "numerators": [[_text(reversed(p)) for p in row] for row in proof.resolvent.numerators],
        "denominator": _text(reversed(proof.resolvent.denominator)),
    }
    told = {"offset": str(OFFSET), "minors": minors, "resolvent": resolvent}
    return {"kind": "positive real matrix", "proof": told}


def motion_document(motion: Motion) -> dict[str, Any]:
    """The kind of a motion's document, and the motion."""
    alone = len(motion.axes) == 1
    told = {"kind": motion.kind, **_numbers(motion)}
    return {"kind": "extraction" if alone else "matrix extraction", "motion": told}


def _numbers(motion: Motion) -> dict[str, Any]:
    rows = [_text(axis) for axis in motion.axes]
    axes = rows[0] if len(rows) == 1 else rows
    if motion.kind == "sequence":
        return {"latent": axes}
    numbers = _text(motion.numbers)
    if motion.kind == "polynomial":
        return {"duration_s": numbers[0], "lowest_power": numbers[1], "coefficients": axes}
    burst = dict(zip(("step_rad_per_s", "cycles", "power"), numbers, strict=True))
    if len(rows) == 1:  # a phase of its own would move all of the burst and no more
        return burst
    return {**burst, "cosine": [a for a, _ in rows], "sine": [b for _, b in rows]}


def _text(values: Iterable[Fraction | int]) -> list[str]:
    return [str(x) for x in values]
