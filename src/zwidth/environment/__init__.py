"""What the hand meets: walls, solids, transfer functions; contacts and springs that are not linear."""

from importlib import import_module
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
    from zwidth.environment.hunt_crossley import HuntCrossley
    from zwidth.environment.nonlinear_spring import NonlinearSpring
    from zwidth.environment.virtual_body import VirtualBody

__all__ = [
    "BackwardDifference",
    "ContinuousTransferFunction",
    "Environment",
    "GeneralizedMaxwell",
    "HuntCrossley",
    "Maxwell",
    "NonlinearSpring",
    "OnePole",
    "PulseTransferFunction",
    "RationalFunction",
    "StandardLinearSolid",
    "VelocityFilter",
    "VirtualBody",
    "Wall",
    "Window",
    "as_environment",
]


_RARE = {
    "HuntCrossley": "hunt_crossley",
    "NonlinearSpring": "nonlinear_spring",
    "VirtualBody": "virtual_body",
}
"""Few loops have one: where they are, until they are first used."""


def __getattr__(name: str) -> Any:
    if name not in _RARE:
        raise AttributeError(f"module 'zwidth.environment' has no attribute {name!r}")
    return getattr(import_module(f"zwidth.environment.{_RARE[name]}"), name)
