"""Soft tissue from measurements: how it relaxes and creeps, fits, tracking, and a wall that follows it."""

from zwidth.data.tissue.adaptive import AdaptiveSolid, Rendered, required_damping
from zwidth.data.tissue.experiment.fit import fit_test, read_test
from zwidth.data.tissue.experiment.result import TissueTest
from zwidth.data.tissue.first_order import Solid, coefficients, five_parameters, solid_of, solid_of_five
from zwidth.data.tissue.fit import TissueComparison, compare_tissues, fit_tissue
from zwidth.data.tissue.recursive import RecursiveSolid, Track, Tracker, track_five_parameters
from zwidth.data.tissue.result import TissueFit
from zwidth.model.environment.relaxing import creep, force_response, position_response, relaxation

__all__ = [
    "AdaptiveSolid",
    "RecursiveSolid",
    "Rendered",
    "Solid",
    "TissueComparison",
    "TissueFit",
    "TissueTest",
    "Track",
    "Tracker",
    "coefficients",
    "compare_tissues",
    "creep",
    "fit_test",
    "fit_tissue",
    "five_parameters",
    "force_response",
    "position_response",
    "read_test",
    "relaxation",
    "required_damping",
    "solid_of",
    "solid_of_five",
    "track_five_parameters",
]
