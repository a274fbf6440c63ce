"""The laws between the hand and what it meets: virtual coupling, and laws in a row behind an environment."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from zwidth.rendering.virtual_coupling import VirtualCoupling

if TYPE_CHECKING:
    from zwidth.rendering.energy.dual_rate import DualRate
    from zwidth.rendering.energy.energy_bounding import EnergyBounding
    from zwidth.rendering.energy.energy_tank import EnergyTank
    from zwidth.rendering.energy.force_bounding import ForceBounding
    from zwidth.rendering.energy.held import Held
    from zwidth.rendering.energy.parallel_controller import ParallelController
    from zwidth.rendering.energy.passive_leap import PassiveLeap
    from zwidth.rendering.energy.passivity_controller import PassivityController
    from zwidth.rendering.energy.windowed_controller import WindowedController
    from zwidth.rendering.force.braking_pulse import BrakingPulse
    from zwidth.rendering.force.damper import Damper
    from zwidth.rendering.force.dither import Dither
    from zwidth.rendering.force.event_transient import EventTransient
    from zwidth.rendering.force.hysteresis import Hysteresis
    from zwidth.rendering.force.rate_term import RateTerm
    from zwidth.rendering.force.saturation import Saturation
    from zwidth.rendering.force.slew_limit import SlewLimit
    from zwidth.rendering.prediction.crossing import CrossingCorrection
    from zwidth.rendering.prediction.extrapolation import Extrapolation
    from zwidth.rendering.prediction.half_sample import HalfSamplePrediction
    from zwidth.rendering.prediction.pole_matched import PoleMatched
    from zwidth.rendering.rendered import Rendered, render
    from zwidth.rendering.stage import Stage
    from zwidth.rendering.velocity.adaptive_window import AdaptiveWindow
    from zwidth.rendering.velocity.estimator import Estimator
    from zwidth.rendering.velocity.kalman import Kalman
    from zwidth.rendering.velocity.tick_time import TickTime

__all__ = [
    "AdaptiveWindow",
    "BrakingPulse",
    "CrossingCorrection",
    "Damper",
    "Dither",
    "DualRate",
    "EnergyBounding",
    "EnergyTank",
    "Estimator",
    "EventTransient",
    "Extrapolation",
    "ForceBounding",
    "HalfSamplePrediction",
    "Held",
    "Hysteresis",
    "Kalman",
    "ParallelController",
    "PassiveLeap",
    "PassivityController",
    "PoleMatched",
    "RateTerm",
    "Rendered",
    "Saturation",
    "SlewLimit",
    "Stage",
    "TickTime",
    "VirtualCoupling",
    "WindowedController",
    "render",
]

_LATER = {
    "AdaptiveWindow": "velocity.adaptive_window",
    "BrakingPulse": "force.braking_pulse",
    "CrossingCorrection": "prediction.crossing",
    "Damper": "force.damper",
    "Dither": "force.dither",
    "DualRate": "energy.dual_rate",
    "EnergyBounding": "energy.energy_bounding",
    "EnergyTank": "energy.energy_tank",
    "Estimator": "velocity.estimator",
    "EventTransient": "force.event_transient",
    "Extrapolation": "prediction.extrapolation",
    "ForceBounding": "energy.force_bounding",
    "HalfSamplePrediction": "prediction.half_sample",
    "Held": "energy.held",
    "Hysteresis": "force.hysteresis",
    "Kalman": "velocity.kalman",
    "ParallelController": "energy.parallel_controller",
    "PassiveLeap": "energy.passive_leap",
    "PassivityController": "energy.passivity_controller",
    "PoleMatched": "prediction.pole_matched",
    "RateTerm": "force.rate_term",
    "Rendered": "rendered",
    "Saturation": "force.saturation",
    "SlewLimit": "force.slew_limit",
    "Stage": "stage",
    "TickTime": "velocity.tick_time",
    "WindowedController": "energy.windowed_controller",
    "render": "rendered",
}
"""Where they are, until they are first used: the compiler of their steps takes its time to load."""


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'zwidth.rendering' has no attribute {name!r}")
    return getattr(import_module(f"zwidth.rendering.{_LATER[name]}"), name)
