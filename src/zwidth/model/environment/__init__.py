"""What the hand meets: walls, solids, transfer functions; contacts and springs that are not linear."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from zwidth.model.environment.environment import Environment, RationalFunction
from zwidth.model.environment.transfer_function import (
    ContinuousTransferFunction,
    PulseTransferFunction,
    as_environment,
)
from zwidth.model.environment.velocity import BackwardDifference, OnePole, VelocityFilter, Window
from zwidth.model.environment.viscoelastic import GeneralizedMaxwell, Maxwell, StandardLinearSolid
from zwidth.model.environment.wall import Wall

if TYPE_CHECKING:
    from zwidth.model.environment.hunt_crossley import HuntCrossley
    from zwidth.model.environment.nonlinear_spring import NonlinearSpring
    from zwidth.model.environment.virtual_body import VirtualBody

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
        raise AttributeError(f"module 'zwidth.model.environment' has no attribute {name!r}")
    return getattr(import_module(f"zwidth.model.environment.{_RARE[name]}"), name)
