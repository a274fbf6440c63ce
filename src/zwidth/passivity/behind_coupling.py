"""A scene behind a virtual coupling: decided by the coupling alone, whatever the scene is made of.

    Σ f_k (y_k − y_{k−1}) ≥ −S of the scene      by the way it is stepped
    b ≥ ¼ F(θ) [s (1 − cos θ) + (κ²/s)(1 + cos θ)]      then no hand takes energy out

The second is decided, and certified, for the law Ĥ(z) that needs as much (`formulas.coupling_need`).  With
an encoder no Coulomb friction is enough for every scene: then it is proved of a handle that is read without
steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from zwidth.model.device import Device
from zwidth.model.environment import PulseTransferFunction
from zwidth.model.environment.environment import Environment
from zwidth.passivity.formulas.coupling_need import ideal_device, law_of, needed_damping
from zwidth.passivity.found import Need
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import ends

Closed = Callable[[Device, Environment], LinearVerdict]
"""How a law with H(z) is decided."""


def decide_behind_coupling(open_still: Verdict, closed: Closed) -> Verdict:
    """The verdict on a scene, from one that is undecided."""
    device, coupling = open_still.device, open_still.environment.coupling
    if coupling is None:
        return replace(open_still, finding="no coupling")
    period = device.exact("sample_period")
    need = needed_damping(coupling.stiffness, coupling.damping, period, device.exact("delay"))
    if need is None:
        return replace(open_still, finding="no coupling is enough")
    proved = closed(ideal_device(device), PulseTransferFunction(*law_of(need, period)))
    least = proved.required_damping
    has = float(device.exact("damping"))
    verdict = replace(open_still, needs=() if least is None else (Need("damping", float(least), has),))
    if proved.outcome != "passive" or proved.certificate is None:
        return verdict
    stepped = bool(ends(device.resolution)[1])
    scope = verdict.scope.replace(
        contact="made and broken", law=("behind a coupling",), encoder="not counted" if stepped else "ideal"
    )
    return replace(
        verdict,
        outcome="passive without encoder steps" if stepped else "passive",
        scope=scope,
        certificate=proved.certificate,
        at_limit=proved.at_limit,
    )
