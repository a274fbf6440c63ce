"""The compiled laws by their codes, written out.

Step functions are translated to C, and call each other by their names.
"""

from __future__ import annotations

from zwidth.links import held_waves, naive_waves, position_hold, time_domain, two_layer, wave_port
from zwidth.native.compiled import Array, compiled


@compiled
def force(code: float, p: Array, s: Array) -> float:
    """The force of any port for the coming period."""
    if code == wave_port.WAVE_PORT:
        return wave_port.force(p, s)
    if code == held_waves.HELD_WAVES:
        return held_waves.force(p, s)
    if code == naive_waves.NAIVE_WAVES:
        return naive_waves.force(p, s)
    if code == position_hold.POSITION_HOLD:
        return position_hold.force(p, s)
    if code == time_domain.TIME_DOMAIN:
        return time_domain.force(p, s)
    return two_layer.force(p, s)


@compiled
def send(code: float, p: Array, s: Array, moved: float) -> None:
    """What any port does after the move."""
    if code == wave_port.WAVE_PORT:
        wave_port.send(p, s, moved)
    elif code == held_waves.HELD_WAVES:
        held_waves.send(p, s, moved)
    elif code == naive_waves.NAIVE_WAVES:
        naive_waves.send(p, s, moved)
    elif code == position_hold.POSITION_HOLD:
        position_hold.send(p, s, moved)
    elif code == time_domain.TIME_DOMAIN:
        time_domain.send(p, s, moved)
    else:
        two_layer.send(p, s, moved)
