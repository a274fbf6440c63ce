"""The laws between the hand and what it meets: virtual coupling, and laws in a chain behind an environment.

`LAWS` is the registry: a new law is one line, its name that of the class in small letters.  It feeds the
names of this package, the reader of specifications, the options of the command line, and the docs.
"""

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from zwidth.model.environment.velocity import BackwardDifference as BackwardDifference
from zwidth.model.environment.velocity import OnePole as OnePole
from zwidth.model.environment.velocity import VelocityFilter as VelocityFilter
from zwidth.model.environment.velocity import Window as Window
from zwidth.model.kind import Kind
from zwidth.model.rendering.virtual_coupling import VirtualCoupling as VirtualCoupling

if TYPE_CHECKING:
    from zwidth.model.rendering.energy.dual_rate import DualRate as DualRate
    from zwidth.model.rendering.energy.energy_bounding import EnergyBounding as EnergyBounding
    from zwidth.model.rendering.energy.energy_tank import EnergyTank as EnergyTank
    from zwidth.model.rendering.energy.force_bounding import ForceBounding as ForceBounding
    from zwidth.model.rendering.energy.held import Held as Held
    from zwidth.model.rendering.energy.parallel_controller import ParallelController as ParallelController
    from zwidth.model.rendering.energy.passive_leap import PassiveLeap as PassiveLeap
    from zwidth.model.rendering.energy.passivity_controller import PassivityController as PassivityController
    from zwidth.model.rendering.energy.windowed_controller import WindowedController as WindowedController
    from zwidth.model.rendering.force.braking_pulse import BrakingPulse as BrakingPulse
    from zwidth.model.rendering.force.damper import Damper as Damper
    from zwidth.model.rendering.force.dither import Dither as Dither
    from zwidth.model.rendering.force.event_transient import EventTransient as EventTransient
    from zwidth.model.rendering.force.friction_compensation import (
        FrictionCompensation as FrictionCompensation,
    )
    from zwidth.model.rendering.force.hysteresis import Hysteresis as Hysteresis
    from zwidth.model.rendering.force.rate_term import RateTerm as RateTerm
    from zwidth.model.rendering.force.saturation import Saturation as Saturation
    from zwidth.model.rendering.force.slew_limit import SlewLimit as SlewLimit
    from zwidth.model.rendering.prediction.crossing import CrossingCorrection as CrossingCorrection
    from zwidth.model.rendering.prediction.extrapolation import Extrapolation as Extrapolation
    from zwidth.model.rendering.prediction.half_sample import HalfSamplePrediction as HalfSamplePrediction
    from zwidth.model.rendering.prediction.pole_matched import PoleMatched as PoleMatched
    from zwidth.model.rendering.rendered import Rendered as Rendered
    from zwidth.model.rendering.rendered import render as render
    from zwidth.model.rendering.rendering_law import RenderingLaw as RenderingLaw
    from zwidth.model.rendering.velocity.adaptive_window import AdaptiveWindow as AdaptiveWindow
    from zwidth.model.rendering.velocity.estimator import Estimator as Estimator
    from zwidth.model.rendering.velocity.kalman import Kalman as Kalman
    from zwidth.model.rendering.velocity.tick_time import TickTime as TickTime

LAWS: Mapping[str, Kind] = MappingProxyType(
    {
        "extrapolation": Kind(
            "rendering.prediction.extrapolation",
            "Extrapolation",
            "the environment meets the hand n samples ahead",
        ),
        "half-sample-prediction": Kind(
            "rendering.prediction.half_sample",
            "HalfSamplePrediction",
            "half a sample ahead, by a model of device and finger",
        ),
        "crossing-correction": Kind(
            "rendering.prediction.crossing",
            "CrossingCorrection",
            "two forces that repair what sampling did where the surface is crossed",
        ),
        "pole-matched": Kind(
            "rendering.prediction.pole_matched",
            "PoleMatched",
            "gains that give the held loop the poles of the continuous one",
        ),
        "damper": Kind("rendering.force.damper", "Damper", "a damper on an estimated velocity"),
        "hysteresis": Kind(
            "rendering.force.hysteresis",
            "Hysteresis",
            "a spring that slips: friction inside the wall",
        ),
        "passivity-controller": Kind(
            "rendering.energy.passivity_controller",
            "PassivityController",
            "damping where the energy that was counted is lacking",
        ),
        "windowed-controller": Kind(
            "rendering.energy.windowed_controller",
            "WindowedController",
            "the same with a window that forgets, a floor under the speed and a clamp",
        ),
        "rate-term": Kind("rendering.force.rate_term", "RateTerm", "a force that leads by τ: f + τ df/dt"),
        "force-bounding": Kind(
            "rendering.energy.force_bounding",
            "ForceBounding",
            "no more force than what the hand has put in can pay for",
        ),
        "energy-bounding": Kind(
            "rendering.energy.energy_bounding",
            "EnergyBounding",
            "a force that changes with no more than 2b/T per move",
        ),
        "energy-tank": Kind(
            "rendering.energy.energy_tank",
            "EnergyTank",
            "the wall pushes with what is in a tank, which a damper fills",
        ),
        "passive-leap": Kind(
            "rendering.energy.passive_leap",
            "PassiveLeap",
            "the wall's spring holds just the energy that came in",
        ),
        "dual-rate": Kind("rendering.energy.dual_rate", "DualRate", "a local spring between slow updates"),
        "held": Kind("rendering.energy.held", "Held", "the force of every N-th sample, held"),
        "braking-pulse": Kind(
            "rendering.force.braking_pulse",
            "BrakingPulse",
            "one sample of force that stops the mass at entry",
        ),
        "event-transient": Kind(
            "rendering.force.event_transient",
            "EventTransient",
            "what a tap on something hard adds, in open loop",
        ),
        "slew-limit": Kind(
            "rendering.force.slew_limit",
            "SlewLimit",
            "a force that changes no faster than a motor's current can",
        ),
        "dither": Kind(
            "rendering.force.dither",
            "Dither",
            "a small force that carries the command over the converter's steps",
        ),
        "friction-compensation": Kind(
            "rendering.force.friction_compensation",
            "FrictionCompensation",
            "a force in the direction of motion that makes the device light to move",
        ),
        "saturation": Kind("rendering.force.saturation", "Saturation", "a force no larger than a limit"),
    }
)
"""Every law in a chain, by name."""

ESTIMATORS: Mapping[str, Kind] = MappingProxyType(
    {
        "adaptive-window": Kind(
            "rendering.velocity.adaptive_window",
            "AdaptiveWindow",
            "slope of the longest line that fits the readings",
        ),
        "tick-time": Kind(
            "rendering.velocity.tick_time",
            "TickTime",
            "counts over the time between two of them",
        ),
        "kalman": Kind("rendering.velocity.kalman", "Kalman", "the settled filter of position and velocity"),
    }
)
"""The velocities of laws, by name."""

_LATER = {kind.class_name: kind.module for kind in (*LAWS.values(), *ESTIMATORS.values())} | {
    "Estimator": "rendering.velocity.estimator",
    "ParallelController": "rendering.energy.parallel_controller",
    "Rendered": "rendering.rendered",
    "RenderingLaw": "rendering.rendering_law",
    "render": "rendering.rendered",
}
"""Where they are, until they are first used: numpy, which their steps need, takes its time to load."""

__all__ = sorted((*_LATER, "BackwardDifference", "OnePole", "VelocityFilter", "VirtualCoupling", "Window"))  # noqa: PLE0605  # what the type checker needs stands above


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'zwidth.rendering' has no attribute {name!r}")
    return getattr(import_module(f"zwidth.model.{_LATER[name]}"), name)
