"""The registry of the laws in a chain: a new law is one line here, and one in the stub of the package.

It feeds the reader of specifications, the options of the command line, and the docs.
"""

from __future__ import annotations

from zwidth.model.kind import kinds

LAWS = kinds(
    "rendering",
    {
        "Extrapolation": "the environment meets the hand n samples ahead",
        "HalfSamplePrediction": "half a sample ahead, by a model of device and finger",
        "CrossingCorrection": "two forces that repair what sampling did where the surface is crossed",
        "PoleMatched": "gains that give the held loop the poles of the continuous one",
        "Damper": "a damper on an estimated velocity",
        "Hysteresis": "a spring that slips: friction inside the wall",
        "PassivityController": "damping where the energy that was counted is lacking",
        "WindowedController": "the same with a window that forgets, a floor under the speed and a clamp",
        "RateTerm": "a force that leads by τ: f + τ df/dt",
        "ForceBounding": "no more force than what the hand has put in can pay for",
        "EnergyBounding": "a force that changes with no more than 2b/T per move",
        "EnergyTank": "the wall pushes with what is in a tank, which a damper fills",
        "PassiveLeap": "the wall's spring holds just the energy that came in",
        "DualRate": "a local spring between slow updates",
        "Held": "the force of every N-th sample, held",
        "BrakingPulse": "one sample of force that stops the mass at entry",
        "EventTransient": "what a tap on something hard adds, in open loop",
        "SlewLimit": "a force that changes no faster than a motor's current can",
        "Dither": "a small force that carries the command over the converter's steps",
        "FrictionCompensation": "a force in the direction of motion that makes the device light to move",
        "Saturation": "a force no larger than a limit",
    },
)
"""Every law in a chain, by name."""

ESTIMATORS = kinds(
    "rendering",
    {
        "AdaptiveWindow": "slope of the longest line that fits the readings",
        "TickTime": "counts over the time between two of them",
        "Kalman": "the settled filter of position and velocity",
    },
)
"""The velocities of laws, by name."""
