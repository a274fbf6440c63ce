"""Whether what shook is a motor on its cable: decided by what would be without the cable.

Between √(k/m₁), the handle held, and √(k (1/m₁ + 1/m₂)), nobody there, the handle's damping pays little or
nothing.  The loop that was found, late as it was stated, is active on this cable; in one piece, with the
damping of both sides, it is passive: so the cable is what keeps it shaking.  A force that comes later than
stated, or that something else feeds more, is another cause.
"""

from __future__ import annotations

from collections.abc import Iterator

from zwidth.data.diagnosis.causes import CAUSES, follows
from zwidth.data.diagnosis.change import PASSIVE, law_of, text_of
from zwidth.data.diagnosis.evidence import Evidence
from zwidth.errors import InputError
from zwidth.model.device import Device, in_one
from zwidth.passivity.check import check
from zwidth.passivity.transmission import TransmissionVerdict, seen_at_motor
from zwidth.quantity.exact import middle
from zwidth.quantity.text import at_most, shown

STRUCTURE = "structural resonance"

_APART, _NEAR = 0.5, 0.85
"""Of the frequency at which the motor swings with the handle held: from where one body explains nothing, and
from where that is what swings, as far as the device's numbers may be wrong."""

SURE_AT_LEAST = 0.93
"""All of 40 simulated logs that were called so were: with 95 % confidence that is 0.05^(1/40) or more."""


def move_apart(seen: Evidence, device: Device) -> bool:
    """Whether it shakes so fast that motor and handle are two."""
    held = None if device.transmission is None else device.transmission.rings(device.mass)[0]
    return held is not None and seen.vibration.frequency > _APART * held


def judged(seen: Evidence, device: Device) -> tuple[str | None, tuple[str, ...]]:
    """Why it shakes so fast, and what shows it; no cause where the loop that was found does not say."""
    if seen.law is None or not follows(seen):
        return None, ()
    law, device = law_of(seen, device), _of_middles(device)
    try:
        found, whole = check(device, law), check(in_one(device), law)
        if seen.sees_delay and seen.delay > seen.known.delay + seen.loop_period:
            later = check(device.replace(delay=text_of(seen.delay)), law)
            cause = "delay" if later.outcome == "active" and found.outcome in PASSIVE else None
        elif not CAUSES["sampling"].shown(seen):
            cause = None
        elif found.outcome == "active" and whole.outcome in PASSIVE:
            assert isinstance(found, TransmissionVerdict)
            told = tuple(_told(seen, device, found))
            return (STRUCTURE, told) if told else (None, ())
        else:
            cause = "sampling" if whole.outcome == "active" else None
    except InputError:
        return None, ()
    return cause, () if cause is None else tuple(CAUSES[cause].evidence(seen))


def _of_middles(device: Device) -> Device:
    """The same with one value of each number: as the evidence has it."""
    between = device.transmission
    assert between is not None
    own, behind = ({k: middle(v) for k, v in of.parameters().items()} for of in (device, between))
    return device.replace(**own, transmission=between.replace(**behind))


def _told(seen: Evidence, device: Device, found: TransmissionVerdict) -> Iterator[str]:
    assert device.transmission is not None
    assert seen.law is not None
    held, free = device.transmission.rings(device.mass)
    if held is None or seen.vibration.frequency < _NEAR * held:
        return
    nobody = "" if free is None else f", nobody there at {shown(free, 'Hz', 3)}"
    at = shown(seen.vibration.frequency, "Hz", 3)
    yield f"the motor swings on its cable at {at}: the handle held it does at {shown(held, 'Hz', 3)}{nobody}"
    unit, of = seen.unit("stiffness"), seen.unit("damping")
    own, b = (middle(each.damping) or 0.0 for each in (seen_at_motor(device), in_one(device)))
    yield f"of b = {shown(b, of, 3)} the motor feels {shown(own, of, 3)} there: the handle's brakes little"
    this, any_other = found.max_stiffness_viscous, found.max_stiffness_any_transmission
    bears = f"{shown(at_most(this, unit) or 0.0, unit, 4)} on this cable"
    bears += "" if any_other is None else f", {shown(at_most(any_other, unit), unit, 4)} on any"
    yield f"K = {shown(seen.law.stiffness, unit, 3)} is above what is passive: {bears}"
    handle, at_motor = middle(device.transmission.handle_damping), device.transmission.encoder == "motor"
    short = 0.5 * seen.law.stiffness * seen.loop_period - (middle(device.damping) or 0.0)
    if at_motor and handle and 0 < short < handle and not (seen.law.damping or seen.known.delay):
        enough = handle * short / (handle - short)
        yield f"{shown(enough, of, 3)} of damping inside the cable would do, however stiff it is"
