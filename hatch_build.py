"""Builds the library of step functions into the wheel, and into the folder of an editable install."""

import sys
import sysconfig
import warnings
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

sys.path.insert(0, str(Path(__file__).parent / "src"))

from zwidth.native.build import BUILT, build, compiler


class StepFunctions(BuildHookInterface[Any]):
    """One library for every version of Python; where it cannot be built the package is plain Python."""

    def dependencies(self) -> list[str]:
        """A C compiler as a package, asked for only where the system has none."""
        return [] if compiler() else ["ziglang>=0.13"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        try:
            build()
        except OSError as fault:
            warnings.warn(f"the step functions will run as plain Python: {fault}", stacklevel=1)
            return
        if version != "editable":
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
            build_data["artifacts"].append(f"/{BUILT.relative_to(Path(self.root)).as_posix()}")
