"""How passive a linear system is: its input and output index, and the damping its sampled loop needs.

    ν  largest with ∫ u y ≥ ν ∫ u²    input feedforward index (Bao & Lee 2007; Kottenstette et al. 2014)
    ρ  largest with ∫ u y ≥ ρ ∫ y²    output feedback index
    b  least device damping with which H(z), sampled and held, is passive    (Colgate & Schenkel 1997)

ν and ρ take y·u for the power at the port: they mean something where input and
output are velocity and force.  The last takes H from position to force.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from zwidth.device import Device
from zwidth.environment.discretization import Discretization
from zwidth.environment.environment import Environment
from zwidth.environment.matrix_system import size_of
from zwidth.environment.system import is_system
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.passivity import limits
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.decision import decide
from zwidth.passivity.document import unit_key
from zwidth.passivity.linear.supremum import frequency, tightest
from zwidth.passivity.outcome import Outcome
from zwidth.passivity.ports.extracted import Extraction
from zwidth.passivity.ports.index import PassivityIndex
from zwidth.passivity.ports.multiport.index import MatrixIndex
from zwidth.passivity.ports.multiport.largest import largest_matrix_level
from zwidth.passivity.ports.multiport.reading import read_matrix_port
from zwidth.passivity.ports.multiport.sampled import sampled_damping
from zwidth.passivity.ports.port import read_port
from zwidth.passivity.ports.port_index import PortIndex
from zwidth.passivity.ports.positive_real import largest_level
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Scope
from zwidth.quantity.text import quantity_unit


@dataclass(frozen=True)
class SampledDamping:
    """The damping that a device must have for H(z), sampled and held, to give out no energy.

    Attributes
    ----------
    required
        The least b that is proved [N·s/m; N·m·s/rad]; None if none is enough.
    frequency
        Where the criterion is tightest [Hz].
    device
        The device that was given; without one, one of no damping and no delay.
    """

    required: float | None
    frequency: float
    device: Device

    @property
    def scope(self) -> Scope:
        """The linear criterion: of a one-sided law it speaks of contact that is kept, and of no encoder."""
        return Scope(contact="kept", damping=float(self.device.exact("damping")), motion=self.device.motion)

    @property
    def margin(self) -> float | None:
        """b − required of the device [N·s/m; N·m·s/rad]; None if none is enough."""
        return None if self.required is None else float(self.device.exact("damping")) - self.required

    def describe(self) -> str:
        """The need in a line."""
        if self.required is None:
            return "no damping is enough"
        unit = quantity_unit("damping", self.device.motion)
        return f"b ≥ {self.required:.9g} {unit}, tightest at {self.frequency:.6g} Hz"

    def __repr__(self) -> str:
        return f"<SampledDamping {self.describe()}>"


@dataclass(frozen=True, repr=False)
class PassivityIndices(PassivityAnswer):
    """What `passivity_indices` found.

    Attributes
    ----------
    input, output
        The input feedforward index ν and the output feedback index ρ.
    sampled_damping
        What H(z) needs of a device; None where no sample period is known.
    """

    FORMAT = "zwidth indices 1"
    PICTURE = "indices"

    input: PassivityIndex
    output: PassivityIndex
    sampled_damping: SampledDamping | None

    @cached_property
    def outcome(self) -> Outcome:
        """ "passive" for ν ≥ 0 with a proof that the checker accepts; "active" for ν < 0; equality counts."""
        if not self.input.at_least(0):
            return "active"
        return "passive" if self.input.certificate(0).verify() else "undecided"

    @property
    def claim(self) -> str:
        """The outcome in a sentence."""
        if self.outcome == "undecided":
            return "No input takes energy out of this port; the checker did not confirm it."
        some = {"passive": "No", "active": "An"}[self.outcome]
        return f"{some} input, from rest, takes energy out of this port."

    @property
    def margin(self) -> float:
        """ν, in the unit of output over input."""
        return self.input.value

    @property
    def hidden_modes_decay(self) -> bool:
        """False when a mode that cancels between poles and zeros does not decay: no index sees it."""
        return self.input.port.hidden_modes_decay

    @property
    def certificate(self) -> Certificate | None:
        """The proof that the port is passive; None if it is not."""
        return self.input.certificate(0) if self.passive else None

    @property
    def witness(self) -> Extraction | None:
        """A motion from rest that takes energy out; None if the port is passive, or none was found."""
        return self.input.refute(0)

    @property
    def scope(self) -> Scope:
        """A linear port by itself: every hand, no surface, no encoder, nothing sampled but what G(z) is."""
        return Scope(contact="both sides")

    def rows(self) -> list[tuple[str, str]]:
        """The main numbers as (name, text) for a report."""
        rows = [("input index", self.input.describe()), ("output index", self.output.describe())]
        if self.sampled_damping is not None:
            rows.append(("sampled and held", self.sampled_damping.describe()))
        if not self.hidden_modes_decay:
            rows.append(("hidden", "a cancelled mode does not decay"))
        return rows

    def numbers(self) -> dict[str, Any]:
        """The indices, and the damping needed by the sampled loop, as plain data."""
        damping = self.sampled_damping
        need = {} if damping is None else {unit_key("damping", damping.device.motion): damping.required}
        return {"input_index": self.input.value, "output_index": self.output.value, **need}

    def __repr__(self) -> str:
        rows = "; ".join(f"{name} {text}" for name, text in self.rows())
        return f"<PassivityIndices {self.outcome}: {rows}>"


def passivity_indices(
    system: Environment | Any,
    device: Device | None = None,
    discretization: Discretization | None = None,
) -> PassivityIndices:
    """Input and output passivity index of a linear system, exact, with frequency and evidence.

    Parameters
    ----------
    system
        As many inputs as outputs, each input times its own output a power: a TransferFunction or
        StateSpace of python-control, a system of scipy.signal, continuous or discrete; or an
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
    if is_system(system) and size_of(system) != (1, 1):
        return _of_several_axes(system, device, discretization)
    port = read_port(system, None if device is None else device.exact("sample_period"))
    return PassivityIndices(
        PortIndex("input", port, largest_level(port)),
        PortIndex("output", port.inverse(), None if port.is_zero else largest_level(port.inverse(), "zero")),
        _sampled(system, device, discretization),
    )


def _of_several_axes(
    system: Any, device: Device | None, discretization: Discretization | None
) -> PassivityIndices:
    port = read_matrix_port(system)
    back = port.inverse()
    given = device or _bare(system)
    if discretization is not None or (device is not None and port.time == "continuous"):
        raise InputError(
            "several inputs are sampled and held as H(z) only: discretize the system first, and leave "
            "discretization out"
        )
    damping = None if given is None else sampled_damping(port, given)
    return PassivityIndices(
        MatrixIndex("input", port, largest_matrix_level(port)),
        MatrixIndex("output", back, None if back.is_zero else largest_matrix_level(back, "zero")),
        None if damping is None or given is None else SampledDamping(*damping, given),
    )


def _sampled(
    system: Environment | Any, device: Device | None, discretization: Discretization | None
) -> SampledDamping | None:
    if device is None:
        if discretization is not None:
            raise InputError("a discretization needs the device whose rate it is for; give device = …")
        device = _bare(system)
        if device is None:
            return None
    decision = decide(device, as_environment(system, discretization))
    _, cosine = tightest(decision.loop)
    return SampledDamping(limits.required_damping(decision), frequency(cosine, decision.loop.period), device)


def _bare(system: Any) -> Device | None:
    """A device of no damping at the rate that a discrete system says."""
    dt = getattr(system, "dt", None)
    if dt is None or dt is True or dt == 0:
        return None
    return Device(damping=0, sample_period=Fraction(repr(float(dt))))
