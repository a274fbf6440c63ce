"""Which virtual walls a haptic device can render without generating energy, proved."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from zwidth.checker import Verified, verify
from zwidth.device import Device, FrictionCurve, FrictionModel, catalogue
from zwidth.device.rotary import rotary
from zwidth.environment import (
    BackwardDifference,
    ContinuousTransferFunction,
    GeneralizedMaxwell,
    Maxwell,
    OnePole,
    PulseTransferFunction,
    StandardLinearSolid,
    VelocityFilter,
    Wall,
    Window,
)
from zwidth.errors import InputError
from zwidth.passivity import Certificate, Verdict, Violation, Witness, check
from zwidth.passivity.formulas import closed_forms, quantization
from zwidth.quantity import Exact, Interval
from zwidth.rendering import VirtualCoupling

if TYPE_CHECKING:
    from zwidth import arms
    from zwidth import operator as operators
    from zwidth.arms.matrix_wall import MatrixWall
    from zwidth.bench import LawComparison
    from zwidth.coupled_stability.absolute import AbsoluteStability, absolute_stability
    from zwidth.coupled_stability.active_hand import ToleratedActivity, tolerated_activity
    from zwidth.coupled_stability.known_hand import PassiveHand, Stability, stability
    from zwidth.coupled_stability.virtual_mass import stable_virtual_masses
    from zwidth.device import amplifier as amplifiers
    from zwidth.environment import HuntCrossley, NonlinearSpring, VirtualBody
    from zwidth.identification import tissue
    from zwidth.identification.device.identified import Identified
    from zwidth.identification.device.plan import MeasurementPlan, plan_identification
    from zwidth.identification.device.published import PublishedFit, identify_published
    from zwidth.identification.finger import IdentifiedFinger, identify_finger
    from zwidth.identification.logs import Log, read_log
    from zwidth.identification.tissue import TissueFit, compare_tissues, fit_tissue
    from zwidth.loop.admittance import simulate_admittance
    from zwidth.loop.timing import Timing
    from zwidth.maps import robust_boundary, stability_boundary, z_width, z_width_certificate, z_width_factors
    from zwidth.passivity.bounding import Bounding, check_bounding
    from zwidth.passivity.bracket import Bracket
    from zwidth.passivity.coupling import two_port
    from zwidth.passivity.coupling.coupling import CouplingCondition, coupling_condition
    from zwidth.passivity.coupling.coupling_design import CouplingDesign, design_coupling
    from zwidth.passivity.coupling.loop_transformation import (
        PassivityExcess,
        SlopeBounds,
        TransformedCondition,
        delay_sum,
        loop_storage,
        required_damping_by_slopes,
        transformed_blocks,
        transformed_condition,
    )
    from zwidth.passivity.ports.extracting_input import ExtractingInput
    from zwidth.passivity.ports.index import PassivityIndex
    from zwidth.passivity.ports.indices import PassivityIndices, passivity_indices
    from zwidth.passivity.real_hand import RealHand, replay
    from zwidth.passivity.storage import AvailableStorage as WorstHand
    from zwidth.passivity.workspace import Workspace, workspace
    from zwidth.rendering.rendered import render
    from zwidth.traces import available_storage as worst_hand
    from zwidth.traces import (
        compare_traces,
        identify,
        load_trace,
        passive_limit,
        simulate,
        simulate_batch,
    )

__all__ = [
    "AbsoluteStability",
    "BackwardDifference",
    "Bounding",
    "Bracket",
    "Certificate",
    "ContinuousTransferFunction",
    "CouplingCondition",
    "CouplingDesign",
    "Device",
    "Exact",
    "ExtractingInput",
    "FrictionCurve",
    "FrictionModel",
    "GeneralizedMaxwell",
    "HuntCrossley",
    "Identified",
    "IdentifiedFinger",
    "InputError",
    "Interval",
    "LawComparison",
    "Log",
    "MatrixWall",
    "Maxwell",
    "MeasurementPlan",
    "NonlinearSpring",
    "OnePole",
    "PassiveHand",
    "PassivityExcess",
    "PassivityIndex",
    "PassivityIndices",
    "PublishedFit",
    "PulseTransferFunction",
    "RealHand",
    "SlopeBounds",
    "Stability",
    "StandardLinearSolid",
    "Timing",
    "TissueFit",
    "ToleratedActivity",
    "TransformedCondition",
    "VelocityFilter",
    "Verdict",
    "Verified",
    "Violation",
    "VirtualBody",
    "VirtualCoupling",
    "Wall",
    "Window",
    "Witness",
    "Workspace",
    "WorstHand",
    "absolute_stability",
    "amplifiers",
    "arms",
    "catalogue",
    "check",
    "check_bounding",
    "closed_forms",
    "compare",
    "compare_tissues",
    "compare_traces",
    "coupling_condition",
    "delay_sum",
    "design_coupling",
    "fit_tissue",
    "identify",
    "identify_finger",
    "identify_published",
    "load_trace",
    "loop_storage",
    "operators",
    "passive_limit",
    "passivity_indices",
    "plan_identification",
    "quantization",
    "read_log",
    "render",
    "rendering",
    "replay",
    "required_damping_by_slopes",
    "robust_boundary",
    "rotary",
    "simulate",
    "simulate_admittance",
    "simulate_batch",
    "stability",
    "stability_boundary",
    "stable_virtual_masses",
    "tissue",
    "tolerated_activity",
    "transformed_blocks",
    "transformed_condition",
    "two_port",
    "verify",
    "workspace",
    "worst_hand",
    "z_width",
    "z_width_certificate",
    "z_width_factors",
]

_LATER = {
    "AbsoluteStability": "zwidth.coupled_stability.absolute",
    "absolute_stability": "zwidth.coupled_stability.absolute",
    "Bounding": "zwidth.passivity.bounding",
    "check_bounding": "zwidth.passivity.bounding",
    "Bracket": "zwidth.passivity.bracket",
    "CouplingCondition": "zwidth.passivity.coupling.coupling",
    "CouplingDesign": "zwidth.passivity.coupling.coupling_design",
    "LawComparison": "zwidth.bench",
    "Log": "zwidth.identification.logs",
    "compare": "zwidth.traces",
    "HuntCrossley": "zwidth.environment",
    "IdentifiedFinger": "zwidth.identification.finger",
    "NonlinearSpring": "zwidth.environment",
    "MeasurementPlan": "zwidth.identification.device.plan",
    "PublishedFit": "zwidth.identification.device.published",
    "Timing": "zwidth.loop.timing",
    "VirtualBody": "zwidth.environment",
    "TissueFit": "zwidth.identification.tissue",
    "MatrixWall": "zwidth.arms.matrix_wall",
    "Workspace": "zwidth.passivity.workspace",
    "amplifiers": "zwidth.device.amplifier",
    "PassivityExcess": "zwidth.passivity.coupling.loop_transformation",
    "SlopeBounds": "zwidth.passivity.coupling.loop_transformation",
    "TransformedCondition": "zwidth.passivity.coupling.loop_transformation",
    "delay_sum": "zwidth.passivity.coupling.loop_transformation",
    "loop_storage": "zwidth.passivity.coupling.loop_transformation",
    "required_damping_by_slopes": "zwidth.passivity.coupling.loop_transformation",
    "transformed_blocks": "zwidth.passivity.coupling.loop_transformation",
    "transformed_condition": "zwidth.passivity.coupling.loop_transformation",
    "ExtractingInput": "zwidth.passivity.ports.extracting_input",
    "PassivityIndex": "zwidth.passivity.ports.index",
    "PassivityIndices": "zwidth.passivity.ports.indices",
    "passivity_indices": "zwidth.passivity.ports.indices",
    "arms": "zwidth.arms",
    "PassiveHand": "zwidth.coupled_stability.known_hand",
    "RealHand": "zwidth.passivity.real_hand",
    "Stability": "zwidth.coupled_stability.known_hand",
    "stability": "zwidth.coupled_stability.known_hand",
    "robust_boundary": "zwidth.maps",
    "stability_boundary": "zwidth.maps",
    "z_width": "zwidth.maps",
    "z_width_certificate": "zwidth.maps",
    "z_width_factors": "zwidth.maps",
    "WorstHand": "zwidth.passivity.storage",
    "operators": "zwidth.operator",
    "read_log": "zwidth.identification.logs",
    "render": "zwidth.rendering.rendered",
    "rendering": "zwidth.rendering",
    "replay": "zwidth.passivity.real_hand",
    "compare_tissues": "zwidth.identification.tissue",
    "compare_traces": "zwidth.traces",
    "coupling_condition": "zwidth.passivity.coupling.coupling",
    "design_coupling": "zwidth.passivity.coupling.coupling_design",
    "fit_tissue": "zwidth.identification.tissue",
    "identify_finger": "zwidth.identification.finger",
    "identify_published": "zwidth.identification.device.published",
    "Identified": "zwidth.identification.device.identified",
    "identify": "zwidth.traces",
    "load_trace": "zwidth.traces",
    "passive_limit": "zwidth.traces",
    "plan_identification": "zwidth.identification.device.plan",
    "simulate": "zwidth.traces",
    "simulate_admittance": "zwidth.loop.admittance",
    "simulate_batch": "zwidth.traces",
    "stable_virtual_masses": "zwidth.coupled_stability.virtual_mass",
    "tissue": "zwidth.identification.tissue",
    "ToleratedActivity": "zwidth.coupled_stability.active_hand",
    "tolerated_activity": "zwidth.coupled_stability.active_hand",
    "two_port": "zwidth.passivity.coupling.two_port",
    "workspace": "zwidth.passivity.workspace",
    "worst_hand": "zwidth.traces",
}
"""Where a name is found when it is first used: the simulator's libraries take their time to load."""

_INSIDE = {"WorstHand": "AvailableStorage", "worst_hand": "available_storage"}
"""What it is called there, where that is something else."""


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'zwidth' has no attribute {name!r}")
    module = import_module(_LATER[name])
    thing = getattr(module, _INSIDE.get(name, name), module)
    globals()[name] = thing
    return thing


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
