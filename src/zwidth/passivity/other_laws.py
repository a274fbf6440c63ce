"""Laws without H(z): which road decides them.

    a nonlinear spring       its slopes; else value iteration, or a motion
    a Hunt–Crossley contact  value iteration, for hands within bounds
    a scene                  the coupling before it
    laws in a chain            force bounding at the end; a wall with as much virtual damping covers them;
                             a proof on paper, where the last law has one; value iteration

Each road says of whom it speaks: the scope of the verdict is that of the proof.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import PulseTransferFunction
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering.rendered import laws_of
from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.covering_wall import covering
from zwidth.passivity.formulas.colgate_stanley_brown import ideal_device, law_of, needed_damping
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.outcome_evidence import Need
from zwidth.passivity.scope import Law, Scope, scope_of
from zwidth.passivity.storage.domain import losses_of
from zwidth.passivity.storage.gain import Gain
from zwidth.passivity.storage.law import finite_law
from zwidth.passivity.value_iteration_fallback import with_value_iteration
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.exact import Exact, Interval, ends

_ACTUATOR = ("force_limit", "force_resolution", "motor_inductance", "supply_voltage", "current_limit")
"""What a device states of its actuator."""

Progress = Callable[[int], None]

Values = Callable[[Verdict], Verdict]
"""What value iteration adds to a verdict, or nothing."""


def check_other(
    device: Device, law: Environment, closed: Closed, progress: Progress | None = None, iterate: bool = True
) -> Verdict:
    """The verdict on a law without H(z).

    `device`: where parameters are intervals, damping, Coulomb friction and resolution are taken at their
    worst; `law`: a `NonlinearSpring`, a `HuntCrossley` contact, a scene, or what `render` gives; `closed`:
    how a wall that covers laws in a chain is decided; `progress`: told the number of states that still
    improve, while values are iterated; `iterate`: False to iterate none.
    """
    worst = _at_its_worst(device)
    asked = scope_of(device, law)

    def values(verdict: Verdict) -> Verdict:
        """A motion refutes, a proof of bounded hands stands beside the verdict."""
        return with_value_iteration(worst, law, verdict, progress) if iterate else verdict

    if law.points:
        verdict = _spring(worst, law, asked, values)
    elif law.power_law is not None:
        verdict = values(Verdict("undecided", asked, worst, law))
    elif law.starts_at_rest:
        verdict = decide_behind_coupling(Verdict("undecided", asked, worst, law), closed)
    elif laws_of(law):
        verdict = _row(worst, law, asked, closed, values)
    else:
        raise InputError(f"no road is known to a verdict on {law.describe(device.motion)}")
    ranged = any(isinstance(getattr(device, key), Interval) for key in _WITH_A_WORST)
    if verdict.outcome == "active" and ranged:  # at the worst: more friction may hold it
        return replace(verdict, outcome="undecided", scope=asked, finding="depends on values")
    if isinstance(device.resolution, Interval):  # values were iterated on counts of one size
        return replace(verdict, available_storage=None)
    return verdict


_WITH_A_WORST = ("damping", "coulomb_friction", "resolution")


def _at_its_worst(device: Device) -> Device:
    """Least friction and largest counts: whatever is proved then is proved of the whole box."""
    if device.is_certain:
        return device
    given = device.parameters()
    low = {k: Exact(ends(given[k])[0]) for k in ("damping", "coulomb_friction") if k in given}
    return device.replace(**low, resolution=Exact(ends(device.resolution)[1]))


def _spring(device: Device, law: Environment, asked: Scope, values: Values) -> Verdict:
    from zwidth.passivity.formulas.nonlinear_spring import certify_spring, refute_spring, spring_need

    need = spring_need(device, law)
    b, friction = device.exact("damping"), device.exact("coulomb_friction")
    needs = (
        Need("damping", need.damping, float(b)),
        Need("coulomb_friction", float(need.coulomb_friction), float(friction)),
    )
    verdict = Verdict("undecided", asked, device, law, needs=needs)
    certificate = certify_spring(device, law)
    covered = certificate.covered()
    if covered is None:
        runaway = refute_spring(device, law)
        if runaway is not None:
            return replace(verdict, outcome="active", violation=runaway)
        motion = _on_a_slope(device, law)
        if motion is not None:
            return replace(verdict, outcome="active", motion=motion)
        verdict = verdict if need.bounded else replace(verdict, finding="no lowest energy")
        return values(verdict)
    if need.spare(b) < 0:  # Coulomb friction pays for what damping lacks
        verdict = replace(verdict, needs=())
    limited = friction == need.coulomb_friction > 0 or need.spare(b) == 0
    return _proved(verdict, certificate, asked, limited)


def _on_a_slope(device: Device, law: Environment) -> Gain | None:
    """A motion on a rise that is too steep, within the device's force limit where there is one; or None."""
    if device.exact("resolution") == 0:
        return None
    from zwidth.passivity.storage.slope_motion import slope_motion  # numpy takes its time

    loop = finite_law(device, law), losses_of(device), device.motion
    most = None if device.force_limit is None else ends(device.force_limit)[0]
    return (slope_motion(*loop, most=most) if most else None) or slope_motion(*loop)


def _proved(verdict: Verdict, certificate: Certificate, scope: Scope, at_limit: bool = False) -> Verdict:
    return replace(verdict, outcome="passive", scope=scope, certificate=certificate, at_limit=at_limit)


def _row(device: Device, law: Environment, asked: Scope, closed: Closed, values: Values) -> Verdict:
    from zwidth.passivity.bounding import check_bounding, is_bounded

    verdict = Verdict("undecided", asked, device, law)
    if is_bounded(law):
        bounding = check_bounding(device, law)
        if bounding.certificate is not None:
            return _proved(verdict, bounding.certificate, bounding.scope)
    covered = covering(device, law)
    if covered is not None:
        proved = closed(*covered)
        if proved.outcome == "passive" and proved.certificate is not None:
            scope = proved.scope.replace(also=(), law=(_covered(device, covered[0]),))
            return _proved(verdict, proved.certificate, scope, proved.at_limit)
    on_paper = _on_paper(verdict)
    return values(verdict) if on_paper is None else on_paper


def _covered(device: Device, less: Device) -> Law:
    spent = less.exact("coulomb_friction") < device.exact("coulomb_friction")
    return "covered with less friction" if spent else "covered by a wall"


def _on_paper(verdict: Verdict) -> Verdict | None:
    """The theorem of the last law in the row, if it has one for this device."""
    law = verdict.environment
    theorem = laws_of(law)[-1].theorem(LoopContext(verdict.device, law.met))
    ideal = verdict.device.replace(**dict.fromkeys(_ACTUATOR))  # the scope says that the actuator is
    if theorem is None or not theorem.holds_on(ideal):
        return None
    return replace(verdict, outcome="theorem", theorem=theorem.statement)


# A scene behind a virtual coupling is decided by the coupling alone, whatever it is made of:
#     Σ f_k (y_k − y_{k−1}) ≥ −S of the scene      by the way it is stepped
#     b ≥ ¼ F(θ) [s (1 − cos θ) + (κ²/s)(1 + cos θ)]      then no hand takes energy out
#
# The second is decided, and certified, for the law Ĥ(z) that needs as much (`colgate_stanley_brown`).  With
# an encoder no Coulomb friction is enough for every scene: then it is proved of a handle read without steps.


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
