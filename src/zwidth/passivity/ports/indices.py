"""How passive a linear system is: its input and output index, and the damping its sampled loop needs.

    ν  largest with ∫ u y ≥ ν ∫ u²    input feedforward index (Bao & Lee 2007; Kottenstette et al. 2014)
    ρ  largest with ∫ u y ≥ ρ ∫ y²    output feedback index
    R  least with ∫ (y − z u)² ≤ R² ∫ (y + z u)²    relative index, at a reference z
    b  least device damping with which H(z), sampled and held, is passive    (Colgate & Schenkel 1997)

ν and ρ take y·u for the power at the port: they mean something where input and
output are velocity and force.  The last takes H from position to force.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import fmpq_poly

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.discretization import Discretization
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.system import is_system, time_of
from zwidth.model.environment.transfer_function import as_environment, require_period
from zwidth.passivity import parameter_limits
from zwidth.passivity.criterion_choice import decide
from zwidth.passivity.linear.criterion import frequency, tightest
from zwidth.passivity.ports.index import PassivityIndex, PortAnswer
from zwidth.passivity.ports.largest import Largest, largest_level
from zwidth.passivity.ports.port import Port, in_lowest_terms, typed_at_most
from zwidth.passivity.ports.positive_real import in_words
from zwidth.passivity.ports.reading import assumed_period, from_polynomials, read_port
from zwidth.passivity.ports.scattering import RelativeIndex, relative_index
from zwidth.passivity.result import share_left
from zwidth.passivity.scope import Scope, unit_key
from zwidth.quantity.answered import answered, known
from zwidth.quantity.balls import as_fmpq
from zwidth.quantity.exact import RealLike
from zwidth.quantity.text import shown, told_quantity


@dataclass(frozen=True, repr=False)
class PassivityIndices(PortAnswer):
    """What `passivity_indices` found.

    It has no `margin`: no factor on a system changes whether it is passive.  ν is `input.value`.
    """

    _FORMAT = "zwidth indices 1"
    _PICTURE = "indices"

    input: PassivityIndex = answered(
        "the input feedforward index ν; null where it is infinite", stands_as={"input_index": "value"}
    )
    output: PassivityIndex = answered(
        "the output feedback index ρ, likewise", stands_as={"output_index": "value"}
    )
    sampled_damping: SampledDamping | None = known(
        "what H(z) needs of a device; None where no sample period is known"
    )
    assumed: tuple[str, ...] = known("what is assumed of the sample period; () where it is said", default=())

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        if self.outcome == "undecided":
            sign = "≥" if self.input.at_least(0) else "<"
            return f"ν {sign} 0 was found, and nothing that the checker accepts shows it: nothing is proved."
        some = {"passive": "No", "active": "An"}[self.outcome]
        return f"{some} input, from rest, takes energy out of this port."

    @property
    def assumptions(self) -> tuple[str, ...]:
        """Nothing but a sample period that nobody says: a port by itself has neither hand nor actuator."""
        return self.assumed

    def relative(self, reference: RealLike = 1) -> RelativeIndex:
        """How much of a wave comes back at most, R; the port is passive if and only if R ≤ 1.

        Parameters
        ----------
        reference
            z > 0, in the unit of output over input: against which u and y are waves.
        """
        return relative_index(self.input.port, reference)

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        rows = [("input index", self.input.describe()), ("output index", self.output.describe())]
        if self.bands:
            rows.append(("violated", in_words(self.bands)))
        if self.sampled_damping is not None:
            rows.append(("sampled and held", self.sampled_damping.describe()))
        if not self.hidden_modes_decay:
            rows.append(("hidden", "a cancelled mode does not decay"))
        return rows

    def numbers(self) -> dict[str, Any]:
        """The indices, and the damping needed by the sampled loop, as plain data."""
        damping = self.sampled_damping
        need = {} if damping is None else {unit_key("damping", damping.device.motion): damping.required}
        return {**super().numbers(), **need}


def passivity_indices(
    system: Environment | Any, device: Device | None = None, discretization: Discretization | None = None
) -> PassivityIndices:
    """Input and output passivity index of a linear system, exact, with frequency and evidence.

    Parameters
    ----------
    system
        As many inputs as outputs, each input times its own output a power: a TransferFunction or
        StateSpace of python-control, a system of scipy.signal or harold, continuous or discrete; or an
        environment, for its H(z).
    device
        What H runs on: its rate and delay for `sampled_damping`.  Needed for that with a continuous
        system or an environment; a discrete system has its own rate, and is taken without delay.
    discretization
        How a continuous system becomes H(z) on the device.

    Raises
    ------
    InputError
        If the system has not as many inputs as outputs, is discrete and not causal, of too high an
        order, or does not say whether its time is continuous; if only one of device and discretization
        is given for a continuous system, or either for a continuous system of several inputs.

    References
    ----------
    Bao & Lee, Process Control: The Passive Systems Approach, 2007.  Kottenstette, McCourt, Xia,
    Gupta & Antsaklis, Automatica 50(4), 2014.
    """
    period = None if device is None else device.exact("sample_period")
    port = read_port(system, period)
    damping = sampled_damping(system, port, device, discretization)
    back = port.inverse()
    return PassivityIndices(
        PassivityIndex("input", port, largest_level(port)),
        PassivityIndex("output", back, None if back.is_zero else largest_level(back, "zero")),
        damping,
        assumed_period(system, period),
    )


# The damping that a device needs, in every axis, for H(z), sampled and held.
#
#     b ≥ −ν of T z⁻ᵈ H(z)/(z − 1)
#
# Of one axis that is the criterion that `check` decides; with matrices in its place it asks for
# b + T z⁻ᵈ H/(z − 1) to be positive real.


@dataclass(frozen=True)
class SampledDamping:
    """The damping that a device must have for H(z), sampled and held, to give out no energy."""

    required: float | None = known("the least b that is proved; None if none is enough", quantity="damping")
    frequency: float = known("where the criterion is tightest", unit="Hz")
    device: Device = known("the one given; without one, one of no damping and no delay")

    @property
    def scope(self) -> Scope:
        """The linear criterion: of a one-sided law it speaks of contact that is kept, and of no encoder."""
        return Scope(contact="kept", damping=float(self.device.exact("damping")), motion=self.device.motion)

    @property
    def margin(self) -> float | None:
        """As of an `Answer`, of the device's damping; None if none is enough."""
        return share_left(self.required, float(self.device.exact("damping")))

    def describe(self) -> str:
        """The need in a line."""
        if self.required is None:
            return "no damping is enough"
        required = told_quantity(self.required, "damping", self.device.motion, 9)
        return f"b ≥ {required}, tightest at {shown(self.frequency, 'Hz', 6)}"

    def __repr__(self) -> str:
        return f"<SampledDamping {self.describe()}>"


def sampled_damping(
    system: Environment | Any, port: Port, device: Device | None, discretization: Discretization | None
) -> SampledDamping | None:
    """What the system, read as this port, needs of a device; None where no sample period is known."""
    of_several = port.axes > 1
    if of_several and (discretization is not None or (device is not None and port.time == "continuous")):
        raise InputError(
            "several inputs are sampled and held as H(z) only: discretize the system first, and leave "
            "discretization out"
        )
    if device is None and discretization is not None:
        raise InputError("a discretization needs the device whose rate it is for; give device = …")
    on = device or _bare(system)
    if on is None:
        return None
    if of_several:
        return _of_several_axes(port, on)
    decision = decide(on, as_environment(system, discretization))
    _, cosine = tightest(decision.loop)
    return SampledDamping(
        parameter_limits.required_damping(decision), frequency(cosine, decision.loop.period), on
    )


def _bare(system: Any) -> Device | None:
    """A device of no damping at the rate that a discrete system says."""
    period = time_of(system)[1] if is_system(system) else None
    return None if period is None else Device(damping=0, sample_period=period)


def _of_several_axes(port: Port, device: Device) -> SampledDamping:
    """Minus the input index, for whole samples of delay at the rate that H(z) was made for."""
    period = device.exact("sample_period")
    require_period(port.period, period)
    delay = device.exact("delay") / period
    if delay.denominator != 1:
        raise InputError(
            f"the delay is {float(delay):g} samples; with several axes the damping is decided for whole "
            "samples: round the delay up and down"
        )
    found = largest_level(_integrated(port, period, int(delay)))
    if not isinstance(found, Largest):
        return SampledDamping(None, 0.0, device)
    cosine = Fraction(-1) if found.cosine is None else found.cosine  # of equals the highest, as for one axis
    required = 0.0 - typed_at_most(min(found.low, Fraction(0)))
    return SampledDamping(required, frequency(cosine, period), device)


def _integrated(port: Port, period: Fraction, delay: int) -> Port:
    """T H(z)/(zᵈ (z − 1)), in lowest terms."""
    d = fmpq_poly(list(port.denominator)) * fmpq_poly([0] * delay + [-1, 1])
    gain = as_fmpq(period)
    n = [[fmpq_poly(list(p)) * gain for p in row] for row in port.outputs]
    found = in_lowest_terms(n, d)
    assert found is not None, "a denominator is not zero"
    return from_polynomials(found[1], found[0], "discrete", period)
