"""The operator: the hand that moves the device."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from zwidth.model.operator.constant_force import ConstantForce
from zwidth.model.operator.cycle import Cycle
from zwidth.model.operator.dowel import Dowel
from zwidth.model.operator.finger import Finger
from zwidth.model.operator.guide import Guide
from zwidth.model.operator.on_a_knob import FingersOn
from zwidth.model.operator.on_a_wheel import HandsOff, HandsOn
from zwidth.model.operator.operator import LinearHand, Operator, Signals
from zwidth.model.operator.parameter import ParametricOperator
from zwidth.model.operator.prescribed_motion import PrescribedMotion
from zwidth.model.operator.recorded_force import RecordedForce
from zwidth.model.operator.soft_touch import SoftTouch
from zwidth.model.operator.touches import MaliciousTouch, TypicalTouch
from zwidth.model.operator.tracking import Tracking
from zwidth.model.operator.usual import usual_hand
from zwidth.model.operator.witness_motion import WitnessMotion

OPERATORS: Mapping[str, type[ParametricOperator]] = MappingProxyType(
    {
        "constant-force": ConstantForce,
        "cycle": Cycle,
        "dowel": Dowel,
        "finger": Finger,
        "fingers-on": FingersOn,
        "guide": Guide,
        "hands-off": HandsOff,
        "hands-on": HandsOn,
        "malicious": MaliciousTouch,
        "soft": SoftTouch,
        "typical": TypicalTouch,
    }
)
"""The operators that are a few numbers, by the name under which a command line knows them."""

__all__ = [
    "OPERATORS",
    "ConstantForce",
    "Cycle",
    "Dowel",
    "Finger",
    "FingersOn",
    "Guide",
    "HandsOff",
    "HandsOn",
    "LinearHand",
    "MaliciousTouch",
    "Operator",
    "ParametricOperator",
    "PrescribedMotion",
    "RecordedForce",
    "Signals",
    "SoftTouch",
    "Tracking",
    "TypicalTouch",
    "WitnessMotion",
    "usual_hand",
]
