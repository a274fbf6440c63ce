"""Loop transformations: what hold and delay cost, what the environment may lack, Lemma 2."""

from zwidth.passivity.coupling.loop_transformation.blocks import delay_sum, transformed_blocks
from zwidth.passivity.coupling.loop_transformation.condition import (
    TransformedCondition,
    transformed_condition,
)
from zwidth.passivity.coupling.loop_transformation.environment_class import PassivityExcess, SlopeBounds
from zwidth.passivity.coupling.loop_transformation.slopes import required_damping_by_slopes
from zwidth.passivity.coupling.loop_transformation.storage import loop_storage

__all__ = [
    "PassivityExcess",
    "SlopeBounds",
    "TransformedCondition",
    "delay_sum",
    "loop_storage",
    "required_damping_by_slopes",
    "transformed_blocks",
    "transformed_condition",
]
