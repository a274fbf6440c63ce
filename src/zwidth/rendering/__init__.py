"""The laws between the hand and what it meets: virtual coupling, and laws in a row behind an environment."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from zwidth.rendering.virtual_coupling import VirtualCoupling

if TYPE_CHECKING:
    from zwidth.rendering.dual_rate import DualRate
    from zwidth.rendering.energy_bounding import EnergyBounding
    from zwidth.rendering.energy_tank import EnergyTank
    from zwidth.rendering.force_bounding import ForceBounding
    from zwidth.rendering.held import Held
    from zwidth.rendering.passive_leap import PassiveLeap
    from zwidth.rendering.passivity_controller import PassivityController
    from zwidth.rendering.rendered import Rendered, render
    from zwidth.rendering.stage import Stage

__all__ = [
    "DualRate",
    "EnergyBounding",
    "EnergyTank",
    "ForceBounding",
    "Held",
    "PassiveLeap",
    "PassivityController",
    "Rendered",
    "Stage",
    "VirtualCoupling",
    "render",
]

_LATER = {
    "DualRate": "dual_rate",
    "EnergyBounding": "energy_bounding",
    "EnergyTank": "energy_tank",
    "ForceBounding": "force_bounding",
    "Held": "held",
    "PassiveLeap": "passive_leap",
    "PassivityController": "passivity_controller",
    "Rendered": "rendered",
    "Stage": "stage",
    "render": "rendered",
}
"""Where they are, until they are first used: the compiler of their steps takes its time to load."""


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'zwidth.rendering' has no attribute {name!r}")
    return getattr(import_module(f"zwidth.rendering.{_LATER[name]}"), name)
