from zwidth import links as links
from zwidth.checker import verify as verify
from zwidth.data import gains as gains
from zwidth.data import identification as identification
from zwidth.data import tissue as tissue
from zwidth.data.diagnosis import diagnose as diagnose
from zwidth.data.diagnosis import diagnose_pair as diagnose_pair
from zwidth.data.identification.device.plan import plan_identification
from zwidth.data.logs import read_log as read_log
from zwidth.errors import InputError as InputError
from zwidth.loop import traces as traces
from zwidth.machine import firmware as firmware
from zwidth.machine import network as network
from zwidth.machine import servo as servo
from zwidth.machine.firmware.emit import emit as emit
from zwidth.machine.servo.serving import serve as serve
from zwidth.model import arms as arms
from zwidth.model import operator
from zwidth.model import rendering as rendering
from zwidth.model import samples as samples
from zwidth.model import scene as scene
from zwidth.model.device import Device as Device
from zwidth.model.device import FrictionCurve as FrictionCurve
from zwidth.model.device import catalogue as catalogue
from zwidth.model.device.rotary import rotary as rotary
from zwidth.model.environment import ContinuousTransferFunction as ContinuousTransferFunction
from zwidth.model.environment import GeneralizedMaxwell as GeneralizedMaxwell
from zwidth.model.environment import HuntCrossley as HuntCrossley
from zwidth.model.environment import Maxwell as Maxwell
from zwidth.model.environment import NonlinearSpring as NonlinearSpring
from zwidth.model.environment import PulseTransferFunction as PulseTransferFunction
from zwidth.model.environment import StandardLinearSolid as StandardLinearSolid
from zwidth.model.environment import Wall as Wall
from zwidth.model.pairs import Pair as Pair
from zwidth.model.rendering import VirtualCoupling as VirtualCoupling
from zwidth.model.rendering import render as render
from zwidth.model.scene import Scene as Scene
from zwidth.model.specification.load import load as load
from zwidth.passivity import coupling as coupling
from zwidth.passivity import formulas as formulas
from zwidth.passivity import ports as ports
from zwidth.passivity import stability as stability
from zwidth.passivity.check import check as check
from zwidth.passivity.finite_stiffness import replay as replay
from zwidth.passivity.verdict import Verdict as Verdict
from zwidth.passivity.workspace import null_space as null_space
from zwidth.passivity.workspace import workspace as workspace
from zwidth.quantity import Interval as Interval
from zwidth.show import plots as plots
from zwidth.show import report as report
from zwidth.show import simulation as simulation
from zwidth.show.explorer.notebook import explore as explore
from zwidth.show.with_bar import available_storage as available_storage
from zwidth.show.with_bar import compare as compare
from zwidth.show.with_bar import identify as identify
from zwidth.show.with_bar import passive_limit
from zwidth.show.with_bar import simulate as simulate
from zwidth.study import maps as maps
from zwidth.study.maps import z_width as z_width
from zwidth.study.sweeps.run import sweep as sweep

__version__: str

plan = plan_identification
operators = operator
limit = passive_limit

if True:  # found as ever; offered where they belong, such as gains.read_gains
    from zwidth.data.gains import check_gains as check_gains
    from zwidth.data.gains import read_gains as read_gains
    from zwidth.data.logs import Log as Log
    from zwidth.model.device import Transmission as Transmission
    from zwidth.model.device import amplifier
    from zwidth.model.rendering import FrictionCompensation as FrictionCompensation
    from zwidth.passivity.certificate import Certificate as Certificate
    from zwidth.passivity.witness.witness import Witness as Witness
    from zwidth.passivity.workspace import stiffness_over_postures as stiffness_over_postures
    from zwidth.quantity import Exact as Exact
    from zwidth.study.sweeps.files import load_sweep as load_sweep

    amplifiers = amplifier
