"""What is claimed of a law before it is served, and what is refused.

A law that is passive with a regular clock of T, but not with one that is always as late as one sample in a
hundred is, is judged by the slower clock.  That is the law as it would be made for that clock: where it has
damping, a filter or an estimator its coefficients are those of T + lateness there, and the loop runs with
those of T.  Nothing is claimed of periods that vary from sample to sample; samples that are later still are
counted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from math import ceil

import numpy as np

from zwidth.errors import InputError
from zwidth.machine.servo.connection import CompiledConnection, Connection, LibraryConnection
from zwidth.model.device.device import Device
from zwidth.model.device.instead import instead_of_device
from zwidth.model.environment.environment import Environment
from zwidth.native.compiled import Array
from zwidth.passivity.transmission import seen_at_motor
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.wording import of_transmission
from zwidth.quantity.answered import answered
from zwidth.quantity.documented import Documented
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.text import shown
from zwidth.showing import Part

Decide = Callable[[Device, Environment], Verdict]

SERVED_OUTCOMES = ("passive", "theorem")
"""Of a verdict, with which a law is served without being told to."""


class NotProved(InputError):
    """A law is not served, since it is not proved passive; its verdict says what is known of it."""

    def __init__(self, verdict: Verdict, message: str) -> None:
        super().__init__(message)
        self.verdict = verdict


def judged(
    decide: Decide, device: Device, law: Environment, measured: Measured, *, simulated: bool
) -> Verdict:
    """What is claimed of a law, with the delay and the longest period that were measured.

    The delay of a simulated device is its own, whatever the machine is like.  Behind a transmission a law may
    be passive with a long delay and not with a short one: it is judged with that of the device alone, too.
    """
    seen = device if simulated else device.replace(delay=measured.delay(device))
    slower = seen.replace(sample_period=measured.longest_period(device.exact("sample_period")))
    quicker = () if device.transmission is None or simulated else (device,)
    verdict = decide(seen, law)
    for other in (slower, *quicker):
        if verdict.outcome in SERVED_OUTCOMES:
            found = decide(other, law)
            verdict = verdict if found.outcome in SERVED_OUTCOMES else found
    return verdict


def claimed(verdict: Verdict) -> str:
    """What is claimed; of a proof also for which transmission."""
    between = of_transmission(verdict.scope) if verdict.outcome in SERVED_OUTCOMES else ""
    return f"{verdict.claim} It holds for {between}." if between else verdict.claim


def refuse_not_proved(verdict: Verdict, measured: Measured) -> None:
    """Refuse to serve what has no proof."""
    if verdict.outcome not in SERVED_OUTCOMES:
        late, exchange = (shown(float(t), "s", 6) for t in measured.supposed)
        raise NotProved(
            verdict,
            f"this is not served, it is {verdict.outcome}: {verdict.claim} That is as measured here, "
            f"samples {late} late and forces {exchange} after them. Soften the wall, raise the rate, or "
            "give anyway=True (--anyway), with a small force limit",
        )


def check_kinds(device: Device, connection: Connection) -> None:
    """Refuse a device and a connection that do not go together."""
    if not isinstance(device, Device):
        raise InputError(f"the device is a zwidth.Device, {instead_of_device(device)}")
    if not isinstance(connection, (CompiledConnection, LibraryConnection)):
        raise InputError(
            f"the connection is one of zwidth.servo.devices, got {type(connection).__name__}: it says how "
            "the device is reached"
        )
    if connection.motion != device.motion:
        raise InputError(
            f"the device is {device.motion} and its connection {connection.motion}: position and force of "
            "one are metres and newtons, of the other radians and newton metres; describe the device so"
        )


def least_friction(device: Device) -> Device:
    """The device that a law and a ledger reckon with, of one mass, with the least friction that it may have.

    Of a transmission what the motor feels is left, whatever the hand does.
    """
    device = seen_at_motor(device)
    low = {key: ends(getattr(device, key))[0] for key in ("damping", "coulomb_friction", "delay")}
    found = device.replace(stiction=None, **low)
    uncertain = [key for key, value in found.parameters().items() if isinstance(value, Interval)]
    needed = [key for key in uncertain if key not in ("mass", "friction_speed")]
    if needed:
        key, unit = needed[0], device.unit(needed[0])
        typed = f'--{key.replace("_", "-")} "{shown(ends(getattr(device, key))[1], unit)}"'
        raise InputError(
            f"{key} is the interval {shown(getattr(device, key), unit)}, and a loop runs with one number: "
            f"give yours, such as {typed}; damping, coulomb_friction, delay and mass may stay intervals"
        )
    return found.replace(mass=None) if "mass" in uncertain else found


_MICROSECOND = Fraction(1, 1_000_000)


_SHARES = ("median", "of_99_percent", "largest")


@dataclass(frozen=True, repr=False)
class Measured(Documented):
    """Of a loop that ran with force 0."""

    samples: int = answered("how many were taken")
    missed: int = answered("not taken, since the loop came a period late or more", key="missed_samples")
    lateness: tuple[float, float, float] = answered("how late they were", unit="s", names=_SHARES)
    exchange: tuple[float, float, float] = answered(
        "from the start of a sample to its force being on its way", unit="s", names=_SHARES
    )
    waits: int = answered("samples for which a force waits by the protocol", key="samples_a_force_waits")

    @property
    def supposed(self) -> tuple[Fraction, Fraction]:
        """Lateness and exchange that a verdict supposes, which 99 % of the samples keep to [s]."""
        return _rounded_up(self.lateness[1]), _rounded_up(self.exchange[1])

    def delay(self, device: Device) -> Exact | Interval:
        """What a verdict is asked for: that of the device, or what 99 % keep to, whichever is longer [s]."""
        link = self.supposed[1] + self.waits * ends(device.sample_period)[1]
        low, high = (max(link, end) for end in ends(device.delay))
        return Exact(low) if low == high else Interval(low, high)

    def longest_period(self, period: Fraction) -> Fraction:
        """T and the lateness that 99 % of the samples keep to [s]."""
        return period + self.supposed[0]

    def report(self) -> Iterable[Part]:
        """Two lines."""
        more = f", and {self.waits} sample more by the protocol" if self.waits else ""
        yield f"{self.samples} samples with force 0: late by {_told(self.lateness)}; {self.missed} missed"
        yield f"from a sample to its force on its way: {_told(self.exchange)}{more}"


def measured(late: Array, exchange: Array, missed: int, waits: int) -> Measured:
    """From the columns of a run."""
    return Measured(late.size, missed, shares(late), shares(exchange), waits)


def shares(times: Array) -> tuple[float, float, float]:
    """Within which half of them are, 99 %, and all [s]."""
    p50, p99, most = np.quantile(times, [0.5, 0.99, 1.0], method="higher")
    return float(p50), float(p99), float(most)


def _told(times: tuple[float, float, float]) -> str:
    p50, p99, most = (shown(t, "s", 3) for t in times)
    return f"{p50} median, {p99} in 99 %, {most} at most"


def _rounded_up(seconds: float) -> Fraction:
    return ceil(seconds * 1_000_000) * _MICROSECOND
