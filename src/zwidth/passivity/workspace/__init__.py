"""Where in its workspace an arm renders a wall passively: the map, the verdict and its certificate."""

from zwidth.passivity.workspace.region import workspace
from zwidth.passivity.workspace.verdict import Workspace

__all__ = ["Workspace", "workspace"]
