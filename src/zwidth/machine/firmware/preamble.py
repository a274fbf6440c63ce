"""What stands at the head of an emitted text: what is proved of it, and its numbers."""

from __future__ import annotations

from hashlib import sha256
from math import ceil, floor, inf
from textwrap import wrap

from zwidth.loop.start import unloaded_range
from zwidth.machine.firmware.judged import PROVED, Judged
from zwidth.machine.firmware.law import LawProgram
from zwidth.machine.firmware.machine import Machine
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.quantity.exact import ends


def digest(text: str) -> str:
    """SHA-256 of a file with this text."""
    return sha256(text.encode()).hexdigest()


def claim(found: Judged) -> str:
    """Of the law in the machine's numbers."""
    if found.proved:
        return found.verdict.claim
    if found.verdict.outcome in PROVED:
        return f"NOT PROVED in {found.machine.number}, only in real numbers: {found.verdict.claim}"
    return f"NOT PROVED: {found.verdict.claim}"


def about(name: str, device: Device, environment: Environment, found: Judged) -> list[str]:
    """The comment at the head of the text."""
    parts = [
        f"{name}: {environment.describe(device.motion)}.",
        repr(device).strip("<>"),
        f"{claim(found)} {found.statement}",
        f"Proof: {name}.certificate.json, to be checked by: zwidth verify {name}.certificate.json",
        "Written by zwidth from the functions that it simulates; do not edit.",
    ]
    return [line for part in parts for line in (*wrap(part, 96), "")][:-1]


Define = tuple[str, str, str]
"""Name, value and meaning of a constant."""

_START = 0.01
"""Of the force limit: up to which a main program lets a law begin."""


def begins(environment: Environment, numbers: Machine) -> list[Define]:
    """Where the law may begin, if not everywhere: on the top of a detent it would give what it holds."""
    law, (lowest, highest) = numbers.law, numbers.counts
    low, high = unloaded_range(environment, _START * law.limit, 0.0)
    if law.resolution == 0.0 or (low, high) == (-inf, inf):
        return []
    least, most = ceil(max(low / law.resolution, lowest)), floor(min(high / law.resolution, highest))
    return [
        ("BEGINS_MIN", f"({least})", "a main program lets the law begin from this reading"),
        ("BEGINS_MAX", f"({most})", "to this one"),
    ]


def defines(
    device: Device, environment: Environment, law: LawProgram, numbers: Machine, certificate: str
) -> list[Define]:
    """Name, value and meaning of the constants of a text."""
    linear = device.motion == "linear"
    force, length = ("N", "m") if linear else ("N*m", "rad")
    period = float(device.exact("sample_period"))
    unit = 1.0 if numbers.fixed is None else numbers.fixed.units.scale.size(numbers.fixed.result)
    low, high = numbers.counts
    rows = [
        ("SAMPLE_PERIOD_S", repr(period), "s"),
        ("DELAY_S", repr(float(ends(device.delay)[1])), "s from reading to force, at most"),
        ("RATE_HZ", f"{1 / period:.10g}", "Hz"),
        ("ROTARY", str(int(not linear)), "1 where positions are in rad and forces in N*m"),
        ("RESOLUTION", repr(law.resolution), f"{length} per count"),
    ]
    if law.resolution > 0:
        rows += [
            ("COUNTS_MIN", f"({int(low)})", "readings below are taken as this"),
            ("COUNTS_MAX", str(int(high)), "readings above are taken as this"),
        ]
    else:
        rows += [
            ("POSITION_MIN", f"({low!r})", f"{length}; readings below are taken as this"),
            ("POSITION_MAX", repr(high), f"{length}; readings above are taken as this"),
        ]
    rows += begins(environment, numbers)
    rows.append(("FORCE_PER_UNIT", repr(unit), f"{force} per unit of the force"))
    if law.limit > 0:
        rows.append(("FORCE_LIMIT", repr(law.limit), force))
    return [*rows, ("CERTIFICATE_SHA256", f'"{digest(certificate)}"', "of the certificate beside this")]
