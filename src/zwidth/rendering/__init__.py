"""The laws between the hand and what it meets: virtual coupling, and laws in a row behind an environment."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from zwidth.rendering.virtual_coupling import VirtualCoupling

if TYPE_CHECKING:
    from zwidth.rendering.crossing import CrossingCorrection
    from zwidth.rendering.extrapolation import Extrapolation
    from zwidth.rendering.half_sample import HalfSamplePrediction
    from zwidth.rendering.passivity_controller import PassivityController
    from zwidth.rendering.pole_matched import PoleMatched
    from zwidth.rendering.rendered import Rendered, render
    from zwidth.rendering.stage import Stage

__all__ = [
    "CrossingCorrection",
    "Extrapolation",
    "HalfSamplePrediction",
    "PassivityController",
    "PoleMatched",
    "Rendered",
    "Stage",
    "VirtualCoupling",
    "render",
]

_LATER = {
    "CrossingCorrection": "crossing",
    "Extrapolation": "extrapolation",
    "HalfSamplePrediction": "half_sample",
    "PassivityController": "passivity_controller",
    "PoleMatched": "pole_matched",
    "Rendered": "rendered",
    "Stage": "stage",
    "render": "rendered",
}
"""Where they are, until they are first used: the compiler of their steps takes its time to load."""


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'zwidth.rendering' has no attribute {name!r}")
    return getattr(import_module(f"zwidth.rendering.{_LATER[name]}"), name)
