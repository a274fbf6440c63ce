"""A device's own watchdog, and the period at which it is fed."""

from __future__ import annotations

from zwidth.errors import InputError


def check_watchdog(watchdog: float, sample_period: float) -> None:
    """Refuse a watchdog that one late sample would set off.

    Parameters
    ----------
    watchdog
        After so long without a force the device ends it [s].
    sample_period
        Of the loop [s].
    """
    if watchdog < 2 * sample_period:
        raise InputError(
            f"watchdog must be at least two sample periods, {2 * sample_period:g} s, or one late sample ends "
            f"the force; got {watchdog:g} s"
        )
