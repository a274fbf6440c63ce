"""A tissue whose parameters change, tracked sample by sample as a standard linear solid.

    F_t = −p F_{t−1} + b0 u_t + b1 u_{t−1},   u = max(x, 0)

by recursive least squares with forgetting, in one of three forms.  Where F is noisy, plain least squares is
biased: F_{t−1} carries the noise of the last sample into what F_t is regressed on, and the slower the
tissue relaxes beside the sample period, the worse.  "instrumental" puts the F̂_{t−1} of the solid it
started from, free of that noise, beside it as instrument and has no such bias, where the noise of one
sample says nothing of the next motion; the nearer the relaxation time at the start, the less it scatters.
"output-error" puts the F̂_{t−1} of its own estimate in the place of the measured one: without that bias too
where it converges, but slower.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

import numpy as np

from zwidth.data.logs import Finding
from zwidth.data.tissue import recursion
from zwidth.data.tissue.findings import passed_over
from zwidth.data.tissue.first_order import RULES, Rule, Solid, as_rule, coefficients, solid_of_five
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.passivity.formulas.hypotheses import nonnegative, number
from zwidth.quantity.exact import Exact, RealLike
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Method = Literal["least-squares", "instrumental", "output-error"]

_SLOWEST = 1e5
"""Longest relaxation time in sample periods: beyond, 1 + p is lost in the noise of any force."""


class Track(NamedTuple):
    """The solid after each sample, ε the error of prediction, the trace of P (see `RecursiveSolid`), and what
    was found in the record: samples that were passed over."""

    stiffness: Array
    branch_stiffness: Array
    branch_damping: Array
    error: Array
    trace: Array
    findings: tuple[Finding, ...] = ()


@dataclass(frozen=True, init=False)
class RecursiveSolid:
    """Tracks μ0, μ1 and η1 of a tissue, ``F_t = −p F_{t−1} + b0 u_t + b1 u_{t−1}``.

    Parameters
    ----------
    sample_period
        T > 0 [s].
    initial
        The solid that it starts from: (μ0, μ1, η1), all > 0 [N/m, N/m, N·s/m; N·m/rad, N·m/rad,
        N·m·s/rad].  The relaxation time η1/μ1 should be of the right decade.
    method
        "instrumental" (default), "output-error" or "least-squares".
    rule
        "ramp" (default) for a material measured while it moves; "bilinear" or "backward" for what a
        controller renders by Tustin's rule or backward Euler.
    forgetting
        λ, > 0 and ≤ 1: a sample counts for 1/(1 − λ) samples. Default 0.999.
    noise
        Standard deviation of the force's noise, > 0 [N; N·m]; with the initial solid it sets how fast the
        first samples are believed. Default 0.01.
    dead_zone
        Errors of prediction up to this teach nothing [N; N·m]. Default 0.
    largest_trace
        Of P as a multiple of that at the start, > 0: P grows no further where the motion says nothing.
        Default 1. "instrumental" needs no such bound.
    stiffest
        Bound of μ0 and of μ1 [N/m; N·m/rad]; None: no bound.
    relaxation_times
        Bounds of η1/μ1 [s]; None: T/10 to 100 000 T.

    Notes
    -----
    What is returned is admissible: μ0, μ1 ≥ 0, η1/μ1 > 0 and within the bounds.  The regression itself runs
    without bounds, so that nothing measured is lost; what it finds is moved to the nearest bound, number by
    number.

    P is that of ((1 + p)/g, (b0 + b1)/(g S), −b1/S), g = T μ1/η1 and S = μ0 + μ1 at the start, all of the
    size of 1; it begins as the identity over noise²; times noise² it is the covariance of these three.
    "instrumental" has no P: `Track.trace` is what stands for it, and is bounded by what the noise leaves to
    know.
    """

    sample_period: Exact
    initial: Solid
    method: Method
    rule: Rule
    forgetting: Exact
    noise: Exact
    dead_zone: Exact
    largest_trace: Exact
    stiffest: Exact | None
    relaxation_times: tuple[Exact, Exact]

    def __init__(
        self,
        sample_period: RealLike,
        initial: tuple[RealLike, RealLike, RealLike],
        *,
        method: Method = "instrumental",
        rule: Rule = "ramp",
        forgetting: RealLike = "0.999",
        noise: RealLike = "0.01",
        dead_zone: RealLike = 0,
        largest_trace: RealLike = 1,
        stiffest: RealLike | None = None,
        relaxation_times: tuple[RealLike, RealLike] | None = None,
    ) -> None:
        period = positive("sample_period", sample_period)
        if method not in get_args(Method):
            raise InputError(f'method is "least-squares", "instrumental" or "output-error", got {method!r}')
        keep = positive("forgetting", forgetting)
        if keep > 1:
            raise InputError(f"forgetting is at most 1, got {keep:g}: with 1 nothing is forgotten")
        zone = Exact(nonnegative("dead_zone", dead_zone, "it is a size of errors", "force"))
        values = {
            "sample_period": period,
            "initial": solid_given(initial),
            "method": method,
            "rule": as_rule(rule),
            "forgetting": keep,
            "noise": positive("noise", noise, "force"),
            "dead_zone": zone,
            "largest_trace": positive("largest_trace", largest_trace),
            "stiffest": None if stiffest is None else positive("stiffest", stiffest, "stiffness"),
            "relaxation_times": _times(relaxation_times, period),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def start(self) -> Tracker:
        """A tracker that has seen nothing yet, to be fed sample by sample."""
        return Tracker(self)

    def track(self, position: ArrayLike, force: ArrayLike, time: ArrayLike | None = None) -> Track:
        """The solid after each sample of a record.

        Samples at an end of the sensor's range teach nothing; after them, and after a hole in time, the
        tracker begins anew with what it knows.

        Parameters
        ----------
        position
            x, positive inside [m; rad].
        force
            With which the tissue resists [N; N·m].
        time
            Of the samples [s], to see holes; None: there are none.

        Raises
        ------
        InputError
            If they are not arrays of one length, finite, or the record is of no tissue: it pulls the probe
            in.
        """
        return self.start().track(position, force, time)

    def numbers(self) -> Array:
        """As the compiled step reads them."""
        low, high = (float(t) for t in self.relaxation_times)
        method = float(get_args(Method).index(self.method))
        period = float(self.sample_period)
        return np.array(
            [
                float(self.forgetting),
                float(self.dead_zone),
                float(self.largest_trace) * 3.0 / float(self.noise) ** 2,
                method,
                float(RULES.index(self.rule)),
                period,
                self.initial.stiffness + self.initial.branch_stiffness,
                period * self.initial.branch_stiffness / self.initial.branch_damping,
                inf if self.stiffest is None else float(self.stiffest),
                low,
                high,
                float(self.noise) ** 2,
                *coefficients(*self.initial, period, self.rule),
            ]
        )


class Tracker:
    """A `RecursiveSolid` at work: one call per sample.

    Parameters
    ----------
    settings
        What it tracks, and how.
    """

    def __init__(self, settings: RecursiveSolid) -> None:
        self.settings = settings
        self._numbers = settings.numbers()
        self._memory = np.zeros(recursion.MEMORY)
        at, scale, share = recursion.THETA, self._numbers[recursion.SCALE], self._numbers[recursion.SHARE]
        p, b0, b1 = self._numbers[recursion.START :]
        self._memory[at : at + 3] = (1 + p) / share, (b0 + b1) / (share * scale), -b1 / scale
        recursion.admit(self._numbers, self._memory)
        self.forget()

    def update(self, position: float, force: float) -> Solid:
        """The solid after one sample more.

        Parameters
        ----------
        position
            x, positive inside [m; rad].
        force
            With which the tissue resists [N; N·m].  A sample that is not finite is passed over, and the next
            one begins anew.
        """
        recursion.step(self._numbers, self._memory, float(position), float(force))
        return self.solid

    def track(self, position: ArrayLike, force: ArrayLike, time: ArrayLike | None = None) -> Track:
        """The solid after each sample of a record that goes on where the last one ended.

        Parameters
        ----------
        position, force, time
            As for `RecursiveSolid.track`.
        """
        x, f = (np.array(part, dtype=float, order="C") for part in (position, force))
        if x.ndim != 1 or x.shape != f.shape or not (np.isfinite(x).all() and np.isfinite(f).all()):
            raise InputError("position and force are two arrays of one length, of finite numbers")
        out = np.empty((5, x.size))
        passed, findings = passed_over(
            x, f, time, float(self.settings.sample_period), self._numbers[recursion.SCALE]
        )
        f[passed] = np.nan
        recursion.run(self._numbers, self._memory, x, f, out)
        return Track(out[0], out[1], out[2], out[3], out[4], findings)

    @property
    def solid(self) -> Solid:
        """μ0, μ1, η1 of the moment, admissible."""
        return Solid(*(float(v) for v in self._memory[recursion.SOLID : recursion.SOLID + 3]))

    def forget(self) -> None:
        """Forget all that was measured: another tissue is touched, and what was learnt is only a guess."""
        at, start = recursion.COVARIANCE, 1.0 / float(self.settings.noise) ** 2
        instruments = self.settings.method == "instrumental"
        self._memory[at : recursion.TRACE] = 0.0
        self._memory[at : at + 9] = 0.0 if instruments else start * np.eye(3).ravel()
        self._memory[recursion.TRACE] = 3.0 * start


_WHY = "nothing is learned without it"


def positive(name: str, value: RealLike, quantity: str = "") -> Exact:
    return Exact(number(name, value, "> 0", _WHY, quantity))


def solid_given(initial: tuple[RealLike, RealLike, RealLike], bound: str = "> 0") -> Solid:
    if isinstance(initial, str) or not hasattr(initial, "__len__") or len(initial) != 3:
        raise InputError(f"initial is (μ0, μ1, η1), three numbers > 0; got {initial!r}")
    names = ("stiffness", "branch_stiffness", "branch_damping")
    return Solid(
        *(float(number(f"initial {n}", v, bound, _WHY, n)) for n, v in zip(names, initial, strict=True))
    )


def _times(given: tuple[RealLike, RealLike] | None, period: Exact) -> tuple[Exact, Exact]:
    if given is None:
        return Exact(period.fraction / 10), Exact(period.fraction * int(_SLOWEST))
    low, high = (positive("relaxation_times", value, "delay") for value in given)
    if low >= high:
        got = f"{shown(low, 's', 6)} and {shown(high, 's', 6)}"
        raise InputError(f"relaxation_times are (shortest, longest), got {got}")
    return low, high


def track_five_parameters(
    position: ArrayLike,
    force: ArrayLike,
    sample_period: RealLike,
    *,
    forgetting: RealLike = "0.999",
    initial_covariance: float = 1e6,
) -> Mapping[str, Array]:
    """The published regression on five parameters, beside which there is a line of others as good.

    F_t = −a1 F_{t−1} − a2 F_{t−2} + b1 u_t + b2 u_{t−1} + b3 u_{t−2}, estimated by least squares with
    forgetting, is the bilinear recursion of a standard linear solid, three parameters, times (1 + z⁻¹).
    With (1 + c z⁻¹) for any c the same motion fits as well, so that P grows along that line as λ⁻ᵏ and the
    estimates drift.  Use `RecursiveSolid`; this is here to show it.

    Parameters
    ----------
    position, force
        As for `RecursiveSolid.track`; samples in contact only.
    sample_period
        T > 0 [s].
    forgetting
        λ. Default 0.999.
    initial_covariance
        P at the start, times the identity.

    Returns
    -------
    Mapping
        "a1", "a2", "b1", "b2", "b3", "stiffness", "branch_stiffness", "branch_damping" by equation (32) of
        the paper, and "trace" of P, each an array.

    Raises
    ------
    InputError
        If the samples are not two arrays of one length.

    References
    ----------
    "A passivity criterion for real-time haptic simulation of viscoelastic soft tissues", appendix 2.
    """
    period = float(positive("sample_period", sample_period))
    keep = float(positive("forgetting", forgetting))
    x, f = (np.ascontiguousarray(part, dtype=float) for part in (position, force))
    if x.ndim != 1 or x.shape != f.shape:
        raise InputError("position and force are two arrays of one length")
    out = np.full((6, x.size), np.nan)
    p = (initial_covariance * np.eye(5)).ravel()
    recursion.run_five(np.zeros(5), p, np.zeros(10), x, f, keep, out)
    with np.errstate(divide="ignore", invalid="ignore"):
        solid = solid_of_five(out[0], out[2], out[4], period)
    names = ("a1", "a2", "b1", "b2", "b3", "trace", "stiffness", "branch_stiffness", "branch_damping")
    return dict(zip(names, (*out, *solid), strict=True))
