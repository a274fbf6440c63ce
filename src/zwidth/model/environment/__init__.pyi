from zwidth.model.environment.bodies import VirtualBody as VirtualBody
from zwidth.model.environment.environment import Environment as Environment
from zwidth.model.environment.environment import RationalFunction as RationalFunction
from zwidth.model.environment.nonlinear import HuntCrossley as HuntCrossley
from zwidth.model.environment.nonlinear import NonlinearSpring as NonlinearSpring
from zwidth.model.environment.transfer_function import (
    ContinuousTransferFunction as ContinuousTransferFunction,
)
from zwidth.model.environment.transfer_function import PulseTransferFunction as PulseTransferFunction
from zwidth.model.environment.transfer_function import as_environment as as_environment
from zwidth.model.environment.velocity import BackwardDifference as BackwardDifference
from zwidth.model.environment.velocity import OnePole as OnePole
from zwidth.model.environment.velocity import VelocityFilter as VelocityFilter
from zwidth.model.environment.velocity import Window as Window
from zwidth.model.environment.viscoelastic import GeneralizedMaxwell as GeneralizedMaxwell
from zwidth.model.environment.viscoelastic import Maxwell as Maxwell
from zwidth.model.environment.viscoelastic import StandardLinearSolid as StandardLinearSolid
from zwidth.model.environment.wall import Wall as Wall
