"""What the hand meets: walls, viscoelastic solids, transfer functions."""

from zwidth.environment.environment import Environment, RationalFunction
from zwidth.environment.transfer_function import (
    ContinuousTransferFunction,
    PulseTransferFunction,
    as_environment,
)
from zwidth.environment.velocity import BackwardDifference, OnePole, VelocityFilter, Window
from zwidth.environment.viscoelastic import GeneralizedMaxwell, Maxwell, StandardLinearSolid
from zwidth.environment.wall import Wall

__all__ = [
    "BackwardDifference",
    "ContinuousTransferFunction",
    "Environment",
    "GeneralizedMaxwell",
    "Maxwell",
    "OnePole",
    "PulseTransferFunction",
    "RationalFunction",
    "StandardLinearSolid",
    "VelocityFilter",
    "Wall",
    "Window",
    "as_environment",
]
