"""Where in its workspace an arm renders a wall passively: the map, the verdict and its certificate."""

from zwidth.passivity.workspace.null_space import NullSpace, null_space
from zwidth.passivity.workspace.postures import PostureMap, stiffness_over_postures
from zwidth.passivity.workspace.region import workspace
from zwidth.passivity.workspace.verdict import Workspace

__all__ = ["NullSpace", "PostureMap", "Workspace", "null_space", "stiffness_over_postures", "workspace"]
