"""One paragraph on which a person can act, computed from the scores."""

from __future__ import annotations

from typing import TYPE_CHECKING

from zwidth.model.device.device import Device
from zwidth.model.environment.wall import Wall
from zwidth.passivity.check import check_by_closed_forms
from zwidth.quantity.text import at_most, told

if TYPE_CHECKING:
    import xarray as xr

QUIET = 0.02
"""Force above 30 Hz below which a wall is called quiet, as part of the largest force."""


def advice(scores: xr.Dataset, device: Device, wall: Wall) -> str:
    """`answer`, and which promises do not hold; the same parameters."""
    return " ".join([answer(scores, device, wall), *_promises(scores)])


def answer(scores: xr.Dataset, device: Device, wall: Wall) -> str:
    """What the wall needs, which law is safest and which feels stiffest.

    Parameters
    ----------
    scores
        Of the laws, those of a `LawComparison`.
    device
        What they were simulated on.
    wall
        What was to be rendered, of one stiffness; its damping is left out.
    """
    wanted = float(wall.stiffness)  # type: ignore[arg-type]
    alone = check_by_closed_forms(device, Wall(wall.stiffness))
    limit, unit = alone.max_stiffness, device.unit("stiffness")
    words = [
        f"Alone, a wall of {told(wanted, unit)} is passive on this device and needs no law."
        if alone.outcome == "passive"
        else f"The device alone renders {told(at_most(limit, unit, 4) or 0, unit, 4)} passively, so that "
        f"{told(wanted, unit)} needs a law or other hardware."
        if limit
        else "The device alone renders no wall passively."
    ]
    words += _proved(scores)
    best = _quiet(scores, wanted)
    if best is not None:
        felt = float(scores["static_stiffness"].sel(law=best))
        status = str(scores["status"].sel(law=best).item())
        words.append(
            f"Quiet under a fast finger and closest to what is wanted is {best!r} with {told(felt, unit, 4)}"
            + (
                ""
                if status == "passive"
                else "; for every hand it is proved on paper, without a certificate"
                if status == "theorem"
                else f"; it is {status}: a skilled hand takes energy out, an ordinary one did not"
                if status == "active"
                else "; for every hand it is undecided"
            )
            + "."
        )
    else:
        words.append("All of them chatter under a fast finger.")
    return " ".join(words)


def told_of(scores: xr.Dataset, wall: Wall) -> list[str]:
    """The laws that the answer names: the stiffest of each kind of proof, and the quiet one."""
    proved = (scores.where(scores["status"] == status, drop=True) for status in ("passive", "theorem"))
    quiet = _quiet(scores, float(wall.stiffness))  # type: ignore[arg-type]
    return [*(_stiffest(some) for some in proved if some.sizes["law"]), *([] if quiet is None else [quiet])]


def _quiet(scores: xr.Dataset, wanted: float) -> str | None:
    """The law that is felt closest to what is wanted, of those that do not chatter under a fast finger."""
    quiet = scores.where(scores["tap_chatter"] <= QUIET * scores["peak_force"], drop=True)
    return min(
        map(str, quiet["law"].values),
        key=lambda name: abs(float(quiet["static_stiffness"].sel(law=name)) - wanted),
        default=None,
    )


def _promises(scores: xr.Dataset) -> list[str]:
    """Which passivity controllers a motion takes energy out of."""
    broken = [
        str(name)
        for name in scores["law"].values
        if "controller" in str(name) and str(scores["status"].sel(law=name).item()) == "active"
    ]
    if not broken:
        return []
    return [f"The promise of {_listed(broken)} does not hold: a motion takes energy out."]


def _proved(scores: xr.Dataset) -> list[str]:
    """The stiffest law with a certificate, and a stiffer one that is proved on paper alone."""
    words, most = [], 0.0
    for status, how in (("passive", "Proved"), ("theorem", "Proved on paper, without a certificate,")):
        some = scores.where(scores["status"] == status, drop=True)
        if not some.sizes["law"]:
            continue
        best = _stiffest(some)
        felt = float(some["static_stiffness"].sel(law=best))
        if felt > most:
            feels = told(felt, some["static_stiffness"].attrs["units"], 4)
            words.append(f"{how} for every hand, the stiffest here is {best!r}: {feels} are felt.")
            most = felt
    return words or ["None of these laws is proved for every hand."]


def _stiffest(scores: xr.Dataset) -> str:
    return str(scores["law"].values[int(scores["static_stiffness"].values.argmax())])


def _listed(names: list[str]) -> str:
    quoted = [repr(name) for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"
