from zwidth.model.environment.bodies import CoupledBody as CoupledBody
from zwidth.passivity.coupling import two_port as two_port
from zwidth.passivity.coupling.coupling import CouplingCondition as CouplingCondition
from zwidth.passivity.coupling.coupling import coupling_condition as coupling_condition
from zwidth.passivity.coupling.coupling_design import CouplingDesign as CouplingDesign
from zwidth.passivity.coupling.coupling_design import design_coupling as design_coupling
from zwidth.passivity.coupling.heavy_body import heavy_body_damping as heavy_body_damping
from zwidth.passivity.coupling.loop_transformation import PassivityExcess as PassivityExcess
from zwidth.passivity.coupling.loop_transformation import SlopeBounds as SlopeBounds
from zwidth.passivity.coupling.loop_transformation import TransformedCondition as TransformedCondition
from zwidth.passivity.coupling.loop_transformation import delay_sum as delay_sum
from zwidth.passivity.coupling.loop_transformation import loop_storage as loop_storage
from zwidth.passivity.coupling.loop_transformation import (
    required_damping_by_slopes as required_damping_by_slopes,
)
from zwidth.passivity.coupling.loop_transformation import transformed_blocks as transformed_blocks
from zwidth.passivity.coupling.loop_transformation import transformed_condition as transformed_condition
from zwidth.passivity.coupling.range_of_masses import MassLimit as MassLimit
from zwidth.passivity.coupling.range_of_masses import PassiveMasses as PassiveMasses
from zwidth.passivity.coupling.range_of_masses import passive_masses as passive_masses
