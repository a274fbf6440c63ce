"""An environment with the laws that render it, in a row: wall, then controller, then limits."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.model.environment.environment import Environment, RationalFunction
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.rendering.rendering_law import RenderingLaw
from zwidth.quantity.parameter import Reads, part


def _laws(given: Iterable[Any], name: str) -> tuple[RenderingLaw, ...]:
    laws = tuple(given)
    if not laws:
        raise InputError("no law was given: an environment alone is simulated as it is")
    for law in laws:
        if not isinstance(law, RenderingLaw):
            raise InputError(
                f"a law is one of zwidth.rendering, such as PassivityController(), got {type(law).__name__}"
            )
    return laws


@dataclass(frozen=True)
class Rendered(Environment):
    """An environment behind one or more laws: what `render` gives.

    Parameters
    ----------
    environment
        What the hand meets: an `Environment`, or a discrete system of python-control, scipy.signal or harold.
    laws
        The laws, from the environment to the actuator.

    Raises
    ------
    InputError
        If there is no law, or one of them is none.
    """

    environment: Reads[Environment, Any] = part(
        "environment", lambda given, _: as_environment(given), meaning="what the hand meets"
    )
    laws: tuple[RenderingLaw, ...] = part("laws", _laws, meaning="from the environment to the actuator")

    def __post_init__(self) -> None:
        super().__post_init__()
        inner, laws = self.environment, self.laws
        while isinstance(inner, Rendered):
            laws = (*inner.laws, *laws)
            inner = inner.environment
        self._keep(environment=inner, laws=laws)

    @property
    def unilateral(self) -> bool:
        return self.environment.unilateral

    @property
    def clamped(self) -> bool:
        """As the environment; a controller behind it may pull."""
        return self.environment.clamped

    linear = False
    """Not: the laws look at the sign of energy, contact or motion."""

    has_transfer_function = False

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        raise InputError(
            f"there is no H(z) of this, its laws are not linear: {self.describe()}; zwidth.check decides it "
            "on other roads"
        )

    def describe(self, motion: str = "linear") -> str:
        laws = ", ".join(law.describe(motion) for law in self.laws)
        return f"{self.environment.describe(motion)}, with {laws}"

    @property
    def fed_with(self) -> Literal["position", "penetration"]:
        return self.environment.fed_with

    @property
    def met(self) -> Environment:
        return self.environment

    def around(self, environment: Environment) -> Environment:
        """Another environment behind the same laws."""
        return Rendered(environment, self.laws)


def render(environment: Environment | Any, *laws: RenderingLaw) -> Rendered:
    """An environment rendered by laws in a chain, from the environment to the actuator.

    Parameters
    ----------
    environment
        What the hand meets.
    laws
        `PassivityController()`, `SlewLimit(…)`, …, see `zwidth.rendering`.

    Raises
    ------
    InputError
        If there is no law, or one of them is none.
    """
    return Rendered(environment, laws)


def laws_of(environment: Environment) -> tuple[RenderingLaw, ...]:
    """The laws that render an environment, from it to the actuator; none where it is given as it is."""
    return environment.laws if isinstance(environment, Rendered) else ()
