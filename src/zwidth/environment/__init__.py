"""What the hand meets: walls, viscoelastic solids, transfer functions, nonlinear springs."""

from typing import TYPE_CHECKING, Any

from zwidth.environment.environment import Environment, RationalFunction
from zwidth.environment.transfer_function import (
    ContinuousTransferFunction,
    PulseTransferFunction,
    as_environment,
)
from zwidth.environment.velocity import BackwardDifference, OnePole, VelocityFilter, Window
from zwidth.environment.viscoelastic import GeneralizedMaxwell, Maxwell, StandardLinearSolid
from zwidth.environment.wall import Wall

if TYPE_CHECKING:
    from zwidth.environment.nonlinear_spring import NonlinearSpring

__all__ = [
    "BackwardDifference",
    "ContinuousTransferFunction",
    "Environment",
    "GeneralizedMaxwell",
    "Maxwell",
    "NonlinearSpring",
    "OnePole",
    "PulseTransferFunction",
    "RationalFunction",
    "StandardLinearSolid",
    "VelocityFilter",
    "Wall",
    "Window",
    "as_environment",
]


def __getattr__(name: str) -> Any:
    if name != "NonlinearSpring":
        raise AttributeError(f"module 'zwidth.environment' has no attribute {name!r}")
    from zwidth.environment.nonlinear_spring import NonlinearSpring  # few loops have one

    return NonlinearSpring
