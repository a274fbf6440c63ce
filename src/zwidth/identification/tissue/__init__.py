"""Soft tissue from measurements: how it relaxes and creeps, fits, tracking, and a wall that follows it."""

from zwidth.environment.creeping import creep, position_response
from zwidth.environment.relaxing import force_response, relaxation
from zwidth.identification.tissue.adaptive import AdaptiveSolid, Rendered, required_damping
from zwidth.identification.tissue.comparison import TissueComparison
from zwidth.identification.tissue.experiment.fit import fit_test, read_test
from zwidth.identification.tissue.experiment.result import TissueTest
from zwidth.identification.tissue.first_order import (
    Solid,
    coefficients,
    five_parameters,
    solid_of,
    solid_of_five,
)
from zwidth.identification.tissue.fit import compare_tissues, fit_tissue
from zwidth.identification.tissue.published import track_five_parameters
from zwidth.identification.tissue.recursive import RecursiveSolid, Track, Tracker
from zwidth.identification.tissue.result import TissueFit

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
