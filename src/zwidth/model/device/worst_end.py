"""Of an interval, where one value is needed: the end at which most energy leaks in, or least is lost."""

from __future__ import annotations

from zwidth.model.device.device import Device
from zwidth.quantity.exact import Exact, Interval, ends
from zwidth.quantity.text import in_words, shown

_WORST = {
    **dict.fromkeys(("delay", "sample_period", "resolution", "force_resolution"), 1),
    **dict.fromkeys(("damping", "coulomb_friction", "force_limit"), 0),
}
"""By parameter, which of the two ends that is.  Of a mass it is neither."""


def at_worst_end(device: Device) -> tuple[Device, str]:
    """The device with single values, and what was taken in a sentence; "" where nothing was to choose."""
    taken = {
        key: Exact(ends(given)[_WORST[key]])
        for key, given in device.parameters().items()
        if key in _WORST and isinstance(given, Interval)
    }
    if not taken:
        return device, ""
    told = ", ".join(f"{in_words(key)} {shown(value, device.unit(key))}" for key, value in taken.items())
    return device.replace(**taken), f"of an interval the worst end is taken, for one value is needed: {told}"
