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
from functools import cached_property
from typing import Any

from zwidth.model.device import Device
from zwidth.model.environment.discretization import Discretization
from zwidth.model.environment.environment import Environment
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.ports.bands import Band, in_words
from zwidth.passivity.ports.extracting_input import ExtractingInput
from zwidth.passivity.ports.index import PassivityIndex, evidenced
from zwidth.passivity.ports.largest import largest_level
from zwidth.passivity.ports.reading import assumed_period, read_port
from zwidth.passivity.ports.relative import RelativeIndex, relative_index
from zwidth.passivity.ports.sampled import SampledDamping, sampled_damping
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Outcome, Scope, unit_key
from zwidth.quantity.exact import RealLike


@dataclass(frozen=True, repr=False)
class PassivityIndices(PassivityAnswer):
    """What `passivity_indices` found.

    Attributes
    ----------
    input, output
        The input feedforward index ν and the output feedback index ρ.
    sampled_damping
        What H(z) needs of a device; None where no sample period is known.
    assumed
        What is assumed of the sample period; () where it is said.
    """

    FORMAT = "zwidth indices 1"
    PICTURE = "indices"

    input: PassivityIndex
    output: PassivityIndex
    sampled_damping: SampledDamping | None
    assumed: tuple[str, ...] = ()

    @cached_property
    def outcome(self) -> Outcome:
        """ "passive": ν ≥ 0 with a proof; "active": ν < 0 with a motion; the checker has accepted either."""
        return evidenced(self.input)

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

    @cached_property
    def witness(self) -> ExtractingInput | None:
        """A motion from rest that takes energy out; None if the port is passive, or none was found."""
        return self.input.refute(0)

    @cached_property
    def bands(self) -> tuple[Band, ...]:
        """Frequencies at which a sinusoid takes energy out, in ascending order; () where none does."""
        return self.input.bands()

    def relative(self, reference: RealLike = 1) -> RelativeIndex:
        """How much of a wave comes back at most, R; the port is passive if and only if R ≤ 1.

        Parameters
        ----------
        reference
            z > 0, in the unit of output over input: against which u and y are waves.

        Raises
        ------
        InputError
            If the reference is not positive.
        """
        return relative_index(self.input.port, reference)

    @property
    def scope(self) -> Scope:
        """A linear port by itself: every hand, no surface, no encoder, nothing sampled but what G(z) is."""
        return Scope(contact="both sides", transmission="")

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
        violated = [[band.low, band.high] for band in self.bands]
        found = {"input_index": self.input.value, "output_index": self.output.value}
        return {**found, "violated_Hz": violated, **need}

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
