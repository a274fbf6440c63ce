"""A rendered tissue whose parameters change under the hand, and no hand gets energy out.

    f = μ0 u + μ1 e  inside, 0 outside,    u = max(x, 0),    e ← a (e + Δu),    a = τ/(τ + T), τ = η1/μ1

is the standard linear solid by backward Euler.  It holds V = ½ μ0 u² + ½ (μ1/a) e², and while its parameters
stay, with b ≥ b_req = μ0 T/2 + μ1 η1 T/(2 η1 + μ1 T), what hand and damping put in is never less than what V
rises by. Parameters that change under the hand are another matter: a stiffer spring at the same depth holds
more than was put in, ½ Δμ0 u² of it, and gives it out on the way back, each frozen wall being passive.  So

    E ← E + f Δx + (b/T) Δx² − ΔV                      what was put in and is not stored: never falls
    μ ← μ + s (μ* − μ),  s ≤ 1 the largest with V(μ) ≤ V + E     a rise is paid for from E
    μ* ← μ*  min(1, b/b_req(μ*)),  τ as it is          and the target is passive

in (μ0, μ1, μ1/a), in which V is linear and b_req convex.  Softer is free, so is everything outside when the
branch has relaxed.  The energy taken out is never more than 0.  The proof: docs, "A tissue that changes
under the hand".
"""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from zwidth.data.tissue.first_order import Solid
from zwidth.data.tissue.recursive import RecursiveSolid, solid_given
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.native.compiled import Array, compiled
from zwidth.passivity.formulas.hypotheses import nonnegative
from zwidth.quantity.exact import RealLike
from zwidth.quantity.parameter import read_number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_STARTED, _X, _U, _E, _MU0, _MU1, _BETA, _DECAY, _FORCE, _ENERGY = range(10)
_MEMORY = 10

_SHADE = 1.0 - 1e-12
"""Of the damping, so that rounding does not ask for more than there is."""

_LEAST = 1e-40
"""As everywhere: no haptic quantity is smaller.  A branch with less is none."""


class Rendered(NamedTuple):
    """After each sample: the force, the solid that gives it, and the account E [J]."""

    force: Array
    stiffness: Array
    branch_stiffness: Array
    branch_damping: Array
    energy: Array


class AdaptiveSolid:
    """Renders a standard linear solid whose parameters follow a target, and stays passive.

    Proved: no motion of any hand takes energy out, whatever the targets.  Hypotheses: the device takes at
    least its b; an encoder without counts; no delay, regular samples, no force limit reached, an amplifier
    without lag.

    Parameters
    ----------
    device
        What the hand holds: its damping b > 0 and sample period T are used.
    initial
        (μ0, μ1, η1) at the start, before any contact; scaled down to what is passive.
    tracking
        How `observe` tracks a tissue; None: targets come from `retune` alone.
    largest_energy
        Of the account E [J]; None: no bound.  What was dissipated long ago can pay for no more than this.

    Raises
    ------
    InputError
        If the device has no damping or a delay, or the solid is none.
    """

    def __init__(
        self,
        device: Device,
        initial: tuple[RealLike, RealLike, RealLike],
        *,
        tracking: RecursiveSolid | None = None,
        largest_energy: RealLike | None = None,
    ) -> None:
        damping, period = float(device.exact("damping")), float(device.exact("sample_period"))
        if damping <= 0:
            raise InputError("an adaptive solid is paid for with the device's damping, and this one has none")
        if device.exact("delay") != 0:
            raise InputError("an adaptive solid is proved without delay; the device has one")
        most = inf
        if largest_energy is not None:
            most = float(nonnegative("largest_energy", largest_energy, "a debt is never allowed", "energy"))
        self._numbers = np.array([damping / period, period, most])
        self._memory = np.zeros(_MEMORY)
        self._tracker = None if tracking is None else tracking.start()
        self._target = _target(solid_given(initial, ""), damping, period)
        self._memory[_MU0 : _MU0 + 4] = self._target

    def retune(self, solid: Solid | tuple[float, float, float]) -> Solid:
        """Set what the rendered solid is to become; returns it as scaled down to what is passive.

        Parameters
        ----------
        solid
            (μ0, μ1, η1), μ ≥ 0 and η1 ≥ 0.
        """
        damping = self._numbers[0] * self._numbers[1]
        self._target = _target(Solid(*solid), float(damping), float(self._numbers[1]))
        return _as_solid(*self._target, float(self._numbers[1]))

    def observe(self, position: float, force: float) -> Solid:
        """A sample of the tissue itself: track it, and make what is found the target.

        Parameters
        ----------
        position, force
            Of the probe that touches the tissue: [m; rad], [N; N·m].

        Raises
        ------
        InputError
            If there is no `tracking`.
        """
        if self._tracker is None:
            raise InputError("give tracking=RecursiveSolid(…) for a solid that observes a tissue")
        return self.retune(self._tracker.update(position, force))

    def force(self, position: float) -> float:
        """The force at the hand's position at this sample [N; N·m].

        Parameters
        ----------
        position
            x of the hand, positive inside [m; rad].

        Raises
        ------
        InputError
            If it is not finite.
        """
        if not abs(position) < inf:
            raise InputError(f"the position of the hand must be finite, got {position}")
        return float(_step(self._numbers, self._memory, float(position), *self._target))

    def render(self, position: ArrayLike, solids: ArrayLike) -> Rendered:
        """All samples of a motion, each with its target.

        Parameters
        ----------
        position
            x of the hand [m; rad].
        solids
            (μ0, μ1, η1) wanted at each, an array of as many rows.

        Raises
        ------
        InputError
            If their lengths differ.
        """
        x = np.ascontiguousarray(position, dtype=float)
        wanted = np.asarray(solids, dtype=float)
        if x.ndim != 1 or wanted.shape != (x.size, 3):
            raise InputError(f"for {x.size} positions give as many rows (μ0, μ1, η1), got {wanted.shape}")
        out = np.empty((5, x.size))
        for k, (here, row) in enumerate(zip(x, wanted, strict=True)):
            self.retune(Solid(*(float(v) for v in row)))
            out[0, k] = self.force(here)
            out[1:4, k] = self.solid
            out[4, k] = self.energy
        return Rendered(*out)

    @property
    def solid(self) -> Solid:
        """What is rendered now."""
        mu0, mu1, beta, decay = (float(v) for v in self._memory[_MU0 : _MU0 + 4])
        return _as_solid(mu0, mu1, beta, decay, float(self._numbers[1]))

    @property
    def energy(self) -> float:
        """E, what was put in and is not stored: a lower bound of what hand and friction have paid [J]."""
        return float(self._memory[_ENERGY])

    @property
    def required_damping(self) -> float:
        """b_req of what is rendered now [N·s/m; N·m·s/rad]; never more than b."""
        return required_damping(self.solid, float(self._numbers[1]))


def required_damping(solid: Solid, period: RealLike) -> float:
    """b_req = μ0 T/2 + μ1 η1 T/(2 η1 + μ1 T), backward Euler [N·s/m; N·m·s/rad].

    Parameters
    ----------
    solid
        (μ0, μ1, η1), all ≥ 0.
    period
        T [s].
    """
    (mu0, mu1, eta), t = solid, float(read_number(period, "sample_period", "period"))
    branch = 1.0 / (2.0 / (mu1 * t) + 1.0 / eta) if mu1 > _LEAST and eta > _LEAST else 0.0
    return mu0 * t / 2 + branch


def _target(wanted: Solid, damping: float, period: float) -> tuple[float, float, float, float]:
    """(μ0, μ1, μ1/a, a) of a solid, scaled down to what is passive; its relaxation time is kept."""
    if not all(0.0 <= value < inf for value in wanted):
        raise InputError(f"a solid has μ0, μ1 and η1 ≥ 0 and finite, got {tuple(wanted)}")
    need = required_damping(wanted, period)
    scale = 1.0 if need <= damping * _SHADE else damping * _SHADE / need
    mu0, mu1, eta = (scale * v for v in wanted)
    if not (mu1 > _LEAST and eta > _LEAST):
        return mu0, 0.0, 0.0, 0.5
    decay = eta / (eta + mu1 * period)
    return mu0, mu1, mu1 / decay, decay


def _as_solid(mu0: float, mu1: float, beta: float, decay: float, period: float) -> Solid:
    if not mu1:
        return Solid(mu0, 0.0, 0.0)
    return Solid(mu0, mu1, mu1 * period * mu1 / (beta - mu1)) if beta > mu1 else Solid(mu0, mu1, inf)


@compiled
def _step(q: Array, m: Array, x: float, mu0: float, mu1: float, beta: float, decay: float) -> float:
    """One sample: the account of the last move, the change of parameters that it can pay, the force."""
    u = max(x, 0.0)
    if m[_STARTED] == 0.0:
        m[_STARTED], m[_X], m[_U] = 1.0, x, u
        if u > 0.0:  # nobody has paid for what is met inside: it begins as nothing
            m[_MU0], m[_MU1], m[_BETA] = 0.0, 0.0, 0.0
    moved = x - m[_X]
    stored = 0.5 * (m[_MU0] * m[_U] * m[_U] + m[_BETA] * m[_E] * m[_E])
    # never more than a u: the proof for a hand that leaves needs it, and a smaller a may ask for less
    e = min(m[_DECAY] * (m[_E] + u - m[_U]), min(m[_DECAY], decay) * u)
    now = 0.5 * (m[_MU0] * u * u + m[_BETA] * e * e)
    energy = m[_ENERGY] + m[_FORCE] * moved + q[0] * moved * moved - (now - stored)
    wanted = 0.5 * (mu0 * u * u + beta * e * e)
    share = 1.0 if wanted <= now else min(max(energy, 0.0) / (wanted - now), 1.0)
    if share > 0.0:
        m[_MU0] += share * (mu0 - m[_MU0])
        m[_MU1] += share * (mu1 - m[_MU1])
        m[_BETA] += share * (beta - m[_BETA])
        m[_DECAY] = m[_MU1] / m[_BETA] if m[_BETA] > 0.0 else decay
    if share == 1.0:
        m[_MU0], m[_MU1], m[_BETA], m[_DECAY] = mu0, mu1, beta, decay
    force = m[_MU0] * u + m[_MU1] * e if x > 0.0 else 0.0
    m[_X], m[_U], m[_E], m[_FORCE] = x, u, e, force
    m[_ENERGY] = min(energy - share * (wanted - now), q[2])
    return force
