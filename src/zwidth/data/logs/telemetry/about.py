"""What a law tells of itself: the text of a packet, its numbers as they stand in the law's header.

    zwidth telemetry 1
    period_s 0.001
    resolution 2.24e-05
    force_per_unit 1.0
    force_most 5.0
    certificate 9f86d0…

One byte of flags stands before it: 1, positions are in rad; 2, forces are sent as whole units of the law.
Otherwise one unit of a force that is sent is ``force_most / 32767``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from zwidth.errors import InputError

FORMAT = "zwidth telemetry 1"

_ROTARY, _EXACT = 1, 2
_NUMBERS = ("period_s", "resolution", "force_per_unit", "force_most")


@dataclass(frozen=True, kw_only=True)
class About:
    """What telemetry says of its law.

    Parameters
    ----------
    motion
        "linear" or "rotary".
    period
        T [s].
    resolution
        Of a count [m; rad].
    force_unit
        Of a force that is sent [N; N·m].
    force_most
        Largest force that can be sent [N; N·m].
    certificate
        SHA-256 of the law's certificate.
    """

    motion: Literal["linear", "rotary"]
    period: float
    resolution: float
    force_unit: float
    force_most: float
    certificate: str


def about_in(content: bytes) -> About:
    """What a packet of text says."""
    flags, text = content[0], content[1:].decode("ascii", "replace")
    first, *lines = text.splitlines() or [""]
    if first != FORMAT:
        raise InputError(
            f'this telemetry says it is "{first}", and "{FORMAT}" is read; use the zwidth of its law'
        )
    said = dict(line.partition(" ")[::2] for line in lines)
    try:
        period, resolution, unit, most = (float(said[name]) for name in _NUMBERS)
        positive = min(period, resolution, unit, most) > 0
    except (KeyError, ValueError):
        positive = False
    if not positive:
        raise InputError(
            f"the telemetry must state {', '.join(_NUMBERS)} as numbers > 0, got {text!r}: "
            "check what law.h defines"
        )
    return About(
        motion="rotary" if flags & _ROTARY else "linear",
        period=period,
        resolution=resolution,
        force_unit=unit if flags & _EXACT else most / 32767,
        force_most=most,
        certificate=said.get("certificate", ""),
    )
