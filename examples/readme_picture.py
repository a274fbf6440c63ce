"""The pictures of the README: a spring that is too stiff for the paddle, and a dowel that shows it.

Run it as `python examples/readme_picture.py docs/_static/check.png docs/_static/touch.png`.
"""

from __future__ import annotations

import sys

import zwidth as zw
from zwidth import plots

if __name__ == "__main__":
    paddle = zw.catalogue.device("haptic-paddle")
    verdict = zw.check(paddle, zw.Wall(stiffness=770))
    plots.check_figure(verdict).savefig(sys.argv[1], dpi=100)
    trace = zw.simulate(paddle, zw.Wall(stiffness=770), zw.operators.Dowel(), 2.0)
    trace.zwidth.plot().savefig(sys.argv[2], dpi=100)
