"""Gain files of arms that people have: what their numbers mean, the pairs they make, which are passive."""

from zwidth.gains.arms import ArmGains
from zwidth.gains.joint import Gains, JointGains
from zwidth.gains.read import read_gains
from zwidth.gains.verdict import GainsVerdict, JointVerdict, check_gains

__all__ = ["ArmGains", "Gains", "GainsVerdict", "JointGains", "JointVerdict", "check_gains", "read_gains"]
