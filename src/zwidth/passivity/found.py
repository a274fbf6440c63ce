"""What was found of a loop: the outcome and the evidence for it, without a word."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.outcome import Outcome
from zwidth.passivity.result import PassivityAnswer
from zwidth.passivity.scope import Scope
from zwidth.passivity.witness.violation import Violation
from zwidth.passivity.witness.witness import Witness

if TYPE_CHECKING:
    from zwidth.passivity.formulas.nonlinear_spring import EndlessPull
    from zwidth.passivity.storage import AvailableStorage
    from zwidth.passivity.storage.evidence.gain import Gain

Finding = Literal[
    "open",
    "unconfirmed",
    "between corners",
    "depends on values",
    "no lowest energy",
    "no coupling",
    "no coupling is enough",
]
"""Why a loop is undecided: neither shown; a proof that the checker did not confirm; proved at the corners of
intervals and not between them; active at one corner and not at others; a spring that pulls away for ever, but
no more than Coulomb friction holds; a scene without a coupling; one behind a coupling that loses nothing."""


class Need(NamedTuple):
    """What is enough of "damping" [N·s/m; N·m·s/rad] or "coulomb_friction" [N; N·m], and what there is."""

    name: str
    needed: float
    has: float


@dataclass(frozen=True, repr=False)
class Found(PassivityAnswer):
    """What was found of a sampled loop: the outcome, what it is about, and the evidence.

    `Verdict` is this in words, and says what each entry is.
    """

    outcome: Outcome
    scope: Scope
    device: Device
    environment: Environment
    certificate: Certificate | None = None
    violation: Violation | EndlessPull | None = None
    motion: Witness | Gain | None = None
    available_storage: AvailableStorage | None = None
    finding: Finding = "open"
    at_limit: bool = False
    theorem: str = ""
    needs: tuple[Need, ...] = ()

    @property
    def is_proved(self) -> bool:
        """True for "passive" and for "passive in contact"."""
        return self.outcome in ("passive", "passive in contact")

    @cached_property
    def witness(self) -> Witness | Gain | None:
        """The motion that takes energy out, made when it is first asked for.

        None where the loop is not active, or no motion that was found is short enough to be written down.
        """
        if self.motion is not None or self.violation is None:
            return self.motion
        return self.violation.witness
