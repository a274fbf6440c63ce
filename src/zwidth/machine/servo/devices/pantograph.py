"""Where the tip of a pantograph is, and which torques give it a force: five bars, two motors side by side.

    A = l (cos θ₁, sin θ₁),   B = (d, 0) + l (cos θ₂, sin θ₂)
    |P − A| = |P − B| = L,    P the one of the two points that lies to the left of A → B
    τᵢ = F · ∂P/∂θᵢ           (the power of the torques is that of the force)

with u = P − A and w = P − B, and D = u_x w_y − u_y w_x, the constraints give

    ∂P/∂θ₁ = (u · ∂A/∂θ₁)/D (w_y, −w_x),   ∂P/∂θ₂ = (w · ∂B/∂θ₂)/D (−u_y, u_x).

The origin is the axis of the first motor, x points from it to the second, y away from the base to the hand.
Campion, Wang and Hayward 2005 (the Pantograph Mk-II), with the axes and the signs of Haply's hAPI.
"""

from __future__ import annotations

import math

from zwidth.native.compiled import Array, compiled


@compiled
def locate(first: float, second: float, arms: Array, found: Array) -> bool:
    """Position of the tip and its change with the angles; False where the arms cannot meet.

    Of θ₁, θ₂ [rad] and the arms l, L, d [m]; `found` takes x, y [m], ∂x/∂θ₁, ∂y/∂θ₁, ∂x/∂θ₂, ∂y/∂θ₂ [m/rad].
    """
    inner, outer, base = arms[0], arms[1], arms[2]
    ax, ay = inner * math.cos(first), inner * math.sin(first)
    bx, by = base + inner * math.cos(second), inner * math.sin(second)
    hx, hy = bx - ax, by - ay
    apart = math.sqrt(hx * hx + hy * hy)
    if not 0.0 < apart < 2.0 * outer:  # no number is in no interval either
        return False
    height = math.sqrt(outer * outer - 0.25 * apart * apart) / apart
    ux, uy = 0.5 * hx - height * hy, 0.5 * hy + height * hx
    wx, wy = ux - hx, uy - hy
    area = ux * wy - uy * wx
    if area == 0.0:
        return False
    along_first = (uy * ax - ux * ay) / area
    along_second = (wy * (bx - base) - wx * by) / area
    found[0], found[1] = ax + ux, ay + uy
    found[2], found[3] = along_first * wy, -along_first * wx
    found[4], found[5] = -along_second * uy, along_second * ux
    return True
