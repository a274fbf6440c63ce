"""Gain files of arms that people have: what their numbers mean, the pairs they make, which are passive."""

from zwidth.data.gains.arms import ArmGains
from zwidth.data.gains.controllers import Controllers, JointLaw, read_controllers
from zwidth.data.gains.held_joints import HeldJoints, check_controllers
from zwidth.data.gains.impedance import BorneImpedance, borne_impedance
from zwidth.data.gains.joint import Gains, JointGains
from zwidth.data.gains.passive import PassiveGains, passive_gains
from zwidth.data.gains.read import read_gains
from zwidth.data.gains.verdict import GainsVerdict, JointVerdict, check_gains

__all__ = [
    "ArmGains",
    "BorneImpedance",
    "Controllers",
    "Gains",
    "GainsVerdict",
    "HeldJoints",
    "JointGains",
    "JointLaw",
    "JointVerdict",
    "PassiveGains",
    "borne_impedance",
    "check_controllers",
    "check_gains",
    "passive_gains",
    "read_controllers",
    "read_gains",
]
