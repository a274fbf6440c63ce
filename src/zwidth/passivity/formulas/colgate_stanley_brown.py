"""What a virtual coupling (Colgate, Stanley & Brown 1995) asks of the device, whatever passive is behind it.

    b ≥ ¼ F(θ) [s (1 − cos θ) + (κ²/s)(1 + cos θ)],  0 ≤ θ ≤ π
    κ = K_c T,   s = K_c T + 2 B_c > 0,   delay = (d + α) T
    F = (1 − α) F_{d+1} + α F_{d+2},   F_n = n + 2 Σ_{j<n} (n − j) cos jθ

Derived for this project.  The right side is Σ A_j cos jθ, which a law Ĥ(z) without delay needs: its verdict
decides the condition.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from zwidth.model.device import Device


def needed_damping(
    stiffness: Fraction, damping: Fraction, period: Fraction, delay: Fraction
) -> list[Fraction] | None:
    """A_j of the need Σ A_j cos jθ [N·s/m]; None for K_c T + 2 B_c ≤ 0, where it has no bound.

    ¼ F(θ) [(s + κ²/s) − (s − κ²/s) cos θ], with F as in the module.
    """
    kappa = stiffness * period
    s = kappa + 2 * damping
    if kappa == 0 and damping == 0:
        return [Fraction(0)]
    if s <= 0:
        return None
    whole = int(delay // period)
    fejer = _fejer(whole + 1, delay / period - whole)
    mean, swing = (s + kappa**2 / s) / 4, (s - kappa**2 / s) / 4
    sides = [Fraction(0), *fejer, Fraction(0), Fraction(0)]  # of index −1 … n, which is even about 0
    sides[0] = fejer[1] if len(fejer) > 1 else Fraction(0)
    even = [mean * sides[j + 1] - swing / 2 * (sides[j] + sides[j + 2]) for j in range(len(fejer) + 1)]
    return [even[0], *(2 * a for a in even[1:])]


def _fejer(n: int, alpha: Fraction) -> list[Fraction]:
    """Half-coefficients a_j of F = a_0 + 2 Σ a_j cos jθ."""
    top = n if alpha else n - 1
    return [(1 - alpha) * max(n - j, 0) + alpha * (n + 1 - j) for j in range(top + 1)]


def law_of(need: Sequence[Fraction], period: Fraction) -> tuple[list[Fraction], list[Fraction]]:
    """Ĥ(z) without delay that needs Σ A_j cos jθ: T Ĥ = 2 A_0 − Σ A_j (z^{1−j} − z^{−j})."""
    taps = [Fraction(0)] * len(need)
    taps[0] = 2 * need[0]
    for j, a in enumerate(need[1:], start=1):
        taps[j - 1] -= a
        taps[j] += a
    return [tap / period for tap in taps], [Fraction(1)] + [Fraction(0)] * (len(taps) - 1)


def ideal_device(device: Device) -> Device:
    """The device with an ideal encoder, no Coulomb friction and no delay: what Ĥ(z) is checked on."""
    return device.replace(resolution=0, coulomb_friction=0, stiction=None, delay=0)
