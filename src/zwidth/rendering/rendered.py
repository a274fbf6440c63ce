"""An environment with the laws that render it, in a row: wall, then controller, then limits."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

from zwidth.environment.environment import Environment, RationalFunction
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.quantity.parameter import Reads, part
from zwidth.rendering.stage import Stage


def _stages(given: Iterable[Any], name: str) -> tuple[Stage, ...]:
    stages = tuple(given)
    if not stages:
        raise InputError("no law was given: an environment alone is simulated as it is")
    for stage in stages:
        if not isinstance(stage, Stage):
            raise InputError(
                f"a law is one of zwidth.rendering, such as PassivityController(), got {type(stage).__name__}"
            )
    return stages


@dataclass(frozen=True)
class Rendered(Environment):
    """An environment behind one or more laws: what `render` gives.

    Parameters
    ----------
    environment
        What the hand meets: an `Environment`, or a discrete system of python-control or scipy.signal.
    stages
        The laws, from the environment to the actuator.

    Raises
    ------
    InputError
        If there is no law, or one of them is none.
    """

    environment: Reads[Environment, Any] = part(
        "environment", lambda given, _: as_environment(given), meaning="what the hand meets"
    )
    stages: tuple[Stage, ...] = part("laws", _stages, meaning="from the environment to the actuator")

    def __post_init__(self) -> None:
        super().__post_init__()
        inner, stages = self.environment, self.stages
        while isinstance(inner, Rendered):
            stages = (*inner.stages, *stages)
            inner = inner.environment
        self._keep(environment=inner, stages=stages)

    @property
    def unilateral(self) -> bool:
        """As the environment."""
        return self.environment.unilateral

    @property
    def clamped(self) -> bool:
        """As the environment; a controller behind it may pull."""
        return self.environment.clamped

    @property
    def linear(self) -> bool:
        """Not: the laws look at the sign of energy, contact or motion."""
        return False

    @property
    def has_transfer_function(self) -> bool:
        """False."""
        return False

    def pulse_transfer_function(self, sample_period: Fraction) -> RationalFunction:
        """None: raises InputError."""
        raise InputError(
            f"there is no H(z) of this, its laws are not linear: {self.describe()}; zwidth.check decides it "
            "on other roads"
        )

    def describe(self, motion: str = "linear") -> str:
        """Environment and laws, on one line."""
        laws = ", ".join(stage.describe(motion) for stage in self.stages)
        return f"{self.environment.describe(motion)}, with {laws}"

    @property
    def fed_with(self) -> Literal["position", "penetration"]:
        """As the environment."""
        return self.environment.fed_with

    @property
    def met(self) -> Environment:
        """The environment."""
        return self.environment

    def around(self, environment: Environment) -> Environment:
        """Another environment behind the same laws."""
        return Rendered(environment, self.stages)


def render(environment: Environment | Any, *stages: Stage) -> Rendered:
    """An environment rendered by laws in a row, from the environment to the actuator.

    Parameters
    ----------
    environment
        What the hand meets.
    stages
        `PassivityController()`, `SlewLimit(…)`, …, see `zwidth.rendering`.

    Raises
    ------
    InputError
        If there is no law, or one of them is none.
    """
    return Rendered(environment, stages)


def stages_of(environment: Environment) -> tuple[Stage, ...]:
    """The laws that render an environment, from it to the actuator; none where it is given as it is."""
    return environment.stages if isinstance(environment, Rendered) else ()
