"""How far the stiffness that is felt is from the one that was wanted, in steps that a person can just tell.

    n = ln(K_felt / K_wanted) / ln(1 + w)

w is Weber's fraction: two stiffnesses are just told apart where they differ by this part.  Between −1 and 1
a person would hardly know; a wall of n = −3 is softer by three such steps.
"""

from __future__ import annotations

from math import isfinite, log, nan

from zwidth.errors import InputError

WEBER, SOURCE = 0.23, "Jones & Hunter 1990"
"""Of stiffness, by matching one forearm against the other: 23 %.

L. A. Jones, I. W. Hunter, A perceptual analysis of stiffness, Experimental Brain Research 79 (1990) 150–156.
By pinching, 22 % with the end force of no use as a cue: Tan, Durlach, Beauregard & Srinivasan, Perception &
Psychophysics 57 (1995) 495–510.  Where force and travel are told exactly, less: force by itself is told to
some 7 % (Pang, Tan & Durlach, Perception & Psychophysics 49, 1991, 531–540).
"""


def noticeable_differences(felt: float, wanted: float, weber: float = WEBER) -> float:
    """n, how many just-noticeable differences lie between two stiffnesses; negative: felt softer.

    Parameters
    ----------
    felt
        K_felt [N/m; N·m/rad]; nan comes out where it is not > 0, as of a wall that was not touched.
    wanted
        K_wanted > 0, in the same unit.
    weber
        w > 0, the smallest part by which two stiffnesses are told apart.
    """
    for name, value in (("wanted", wanted), ("weber", weber)):
        if not (isfinite(value) and value > 0):
            raise InputError(
                f"{name} must be finite and > 0, got {value!r}: what is felt is compared by ratios; "
                f"{'give the stiffness that was asked for' if name == 'wanted' else f'published: {WEBER}'}"
            )
    return log(felt / wanted) / log(1 + weber) if 0 < felt < float("inf") else nan
