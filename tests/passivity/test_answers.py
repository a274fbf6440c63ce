"""An answer is neither true nor false; passive means the same of all; each describes itself once."""

from __future__ import annotations

import copy
import json
import pickle
from collections.abc import Callable, Iterator
from functools import cache, reduce
from html import escape
from math import inf, isfinite
from pathlib import Path
from typing import Any

import control
import pandas as pd
import pytest
import xarray as xr

import zwidth as zw
from zwidth.data.gains.held_joints import HeldJoint, HeldJoints
from zwidth.data.gains.verdict import GainsVerdict, JointVerdict
from zwidth.data.identification.device.estimate import Estimate
from zwidth.links.verdict import PortVerdict
from zwidth.passivity.bounding import Bounding
from zwidth.passivity.bracket.bracket import Bracket
from zwidth.passivity.certificate import read_document, verify_document
from zwidth.passivity.coupling.coupling import CouplingCondition
from zwidth.passivity.coupling.loop_condition import TransformedCondition
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.outcome_evidence import Found
from zwidth.passivity.pairs import PairVerdict
from zwidth.passivity.pairs.held import HeldVerdict
from zwidth.passivity.ports.index import PortAnswer
from zwidth.passivity.ports.indices import PassivityIndices
from zwidth.passivity.ports.scattering import ScatteringPassivity
from zwidth.passivity.result import Answer, PassivityAnswer
from zwidth.passivity.stability.known_hand import Stability
from zwidth.passivity.storage.solution import AvailableStorage
from zwidth.passivity.transmission import TransmissionVerdict
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.workspace.null_space import NullSpace
from zwidth.passivity.workspace.postures import PostureMap
from zwidth.passivity.workspace.verdict import Workspace
from zwidth.showing import Html, Shown

PADDLE = zw.catalogue.device("haptic-paddle")
HEAVY = PADDLE.replace(mass=0.04)
HAND = zw.stability.HandImpedance(mass=0.1, stiffness=100, damping=1)
BOUNDED = zw.render(zw.Wall(2000), zw.rendering.ForceBounding())
ARM = zw.arms.built_in("two-link", damping=(1.0, 1.0))
SLOPES = zw.coupling.SlopeBounds(0, 100, bounded_below=True)
s = control.tf("s")


ASKED: dict[str, Callable[[], Answer]] = {
    "passive": lambda: zw.check(PADDLE, zw.Wall(250)),
    "active": lambda: zw.check(PADDLE, zw.Wall(770)),
    "spring": lambda: zw.check(PADDLE, zw.NonlinearSpring([0, 0.001, 0.002], [0, 0.1, 0.35])),
    "bounding": lambda: zw.formulas.check_bounding(PADDLE, BOUNDED),
    "worst hand": lambda: zw.available_storage(PADDLE, zw.Wall(250), penetration=0.001, speed=0.1),
    "arm": lambda: zw.workspace(ARM, zw.Wall(1), rate=1000),
    "port": lambda: zw.ports.passivity_indices((s + 2) / (s + 1)),
    "active port": lambda: zw.ports.passivity_indices((s - 2) / (s * s + s + 1)),
    "stable": lambda: zw.stability.coupled_stability(HEAVY, zw.Wall(500), HAND),
    "unstable": lambda: zw.stability.coupled_stability(HEAVY, zw.Wall(50_000, -1), HAND),
    "coupling": lambda: zw.coupling.coupling_condition(PADDLE, 100, 0.02),
    "poor coupling": lambda: zw.coupling.coupling_condition(PADDLE, 1000, 0.2),
    "springs": lambda: zw.coupling.transformed_condition(PADDLE, SLOPES),
}
OF_STABILITY = {"stable", "unstable", "coupling", "poor coupling", "springs"}
YES = {"passive", "spring", "bounding", "worst hand", "arm", "port", "stable", "coupling", "springs"}


@cache
def answered(name: str) -> Answer:
    return ASKED[name]()


@cache
def page(name: str) -> Html:
    return answered(name)._repr_html_()


def _kinds(kind: type) -> Iterator[type]:
    for one in kind.__subclasses__():
        yield one
        yield from _kinds(one)


LOADED = "gains.check_gains gains.check_controllers links.check ports.scattering_passivity"
"""Beside what is asked above: their classes are loaded with them."""


def _with_an_outcome() -> dict[type, set[str]]:
    for name in [*LOADED.split(), "workspace", "null_space", "maps.stiffness_over_postures"]:
        assert reduce(getattr, name.split("."), zw)
    named = {kind: {*dir(kind), *getattr(kind, "__dataclass_fields__", ())} for kind in _kinds(Shown)}
    return {k: names for k, names in named.items() if "outcome" in names and k not in (Found, PortAnswer)}


def test_every_class_with_an_outcome_has_claim_and_margin() -> None:
    """And shows itself in a notebook."""
    found = _with_an_outcome()
    assert len(found) >= 15
    for kind, names in found.items():
        assert {"claim", "margin", "_repr_html_"} <= names, kind


SPRING = zw.Transmission(stiffness="28658.9", handle_damping="0.09", encoder="motor")
CABLE = zw.Device(mass="0.03", damping="0.06", rate=1000, transmission=SPRING)
ARMS = zw.Pair(PADDLE.replace(damping="0.5"), PADDLE.replace(damping="0.5"), stiffness=300, delay="1 ms")
FINGER = zw.arms.PlanarChain(
    links=(0.1, 0.08, 0.06), damping=(0.05,) * 3, coulomb_friction=(0.01,) * 3,
    joint_range=((-2, 2), (0, 2.6), (-2, 2.6)),
)  # fmt: skip
NULL = {"rate": 1000, "stiffness": 0.5, "rest": (0.2, 1.0, 0.6)}


def _pair(share: float, **hands: Any) -> PairVerdict:
    most = cache(zw.check)(ARMS, **hands).largest_stiffness
    return zw.check(ARMS.replace(stiffness=most * share), **hands)


def _joint(share: float) -> JointVerdict:
    return JointVerdict(None, None, _pair(share))


def _null_space(share: float) -> NullSpace:
    most = zw.null_space(FINGER, zw.Wall(200), **NULL).covered
    return zw.null_space(FINGER, zw.Wall(200), within=most * share, **NULL)


def _of_factor(found: Callable[[zw.Wall], Any], share: float) -> Any:
    """Of an answer that says how many times as stiff the wall may be."""
    return found(zw.Wall(500 * found(zw.Wall(500)).stiffness_factor * share))


def _workspace(wall: zw.Wall) -> Workspace:
    return zw.workspace(ARM, wall, rate=1000)


def _postures(wall: zw.Wall) -> PostureMap:
    arm = zw.arms.read_arm(zw.samples.path("arm.urdf"), whole=True)
    return zw.stiffness_over_postures(arm, wall, rate=1000, postures=200)


def _held(share: float) -> Stability:
    most = cache(zw.stability.coupled_stability)(HEAVY, zw.Wall(500), HAND).max_stiffness
    return zw.stability.coupled_stability(HEAVY, zw.Wall(most * share), HAND)


ASKS: dict[type, Callable[[float], Any]] = {
    LinearVerdict: lambda share: zw.check(PADDLE, zw.Wall(300 * share)),
    Verdict: lambda share: zw.check(
        PADDLE.replace(coulomb_friction=0.00336),  # half a count of 300 N/m, and nothing left over
        zw.NonlinearSpring([0, 0.001], [0, 0.3 * share]),
    ),
    TransmissionVerdict: lambda share: zw.check(
        CABLE, zw.Wall(zw.check(CABLE, zw.Wall(100)).max_stiffness * share)
    ),
    PairVerdict: _pair,
    HeldVerdict: lambda share: _pair(share, follower=HAND),
    JointVerdict: _joint,
    GainsVerdict: lambda share: GainsVerdict(None, (_joint(share), _joint(0.5)), ()),
    HeldJoints: lambda share: HeldJoints((HeldJoint(None, ASKS[LinearVerdict](share)),), ()),
    Workspace: lambda share: _of_factor(_workspace, share),
    PostureMap: lambda share: _of_factor(_postures, share),
    NullSpace: _null_space,
    Stability: _held,
    ScatteringPassivity: lambda share: zw.ports.scattering_passivity(control.tf([share], [1, 1])),
    CouplingCondition: lambda share: zw.coupling.coupling_condition(PADDLE, 300 * share),
    TransformedCondition: lambda share: zw.coupling.transformed_condition(
        PADDLE, zw.coupling.SlopeBounds(0, 300 * share, bounded_below=True)
    ),
}
"""By class, with how much of what it may ask; each in units of the limit."""
NO_SHARE = {Bounding, AvailableStorage, PassivityIndices, PortVerdict, Bracket}
NEVER_PROVED = {PostureMap, NullSpace}
"""Below its limit: of postures no region is, and beyond a region that is proved as asked nothing is known."""


@pytest.mark.parametrize("kind", ASKS, ids=lambda kind: kind.__name__)
def test_a_margin_is_the_share_that_is_left(kind: type) -> None:
    """0 at the limit, a tenth below it, minus a tenth beyond: of stiffness, damping, gain or distance."""
    below, beyond = ASKS[kind](0.9), ASKS[kind](1.1)
    assert type(below) is kind
    assert below.margin == (None if kind in NEVER_PROVED else pytest.approx(0.1, abs=1e-6))
    assert beyond.outcome in ("active", "unstable", "undecided")
    assert beyond.margin == pytest.approx(-0.1, abs=1e-6)
    if kind not in {Workspace, *NEVER_PROVED}:  # cells are proved with some room
        assert ASKS[kind](1.0).margin == pytest.approx(0, abs=1e-12)


def test_every_class_is_among_those_or_has_no_share() -> None:
    assert _with_an_outcome().keys() - NO_SHARE == ASKS.keys()
    device = zw.Device(damping="0.3", sample_period="0.001")
    for asked, margin in ((0, 1), (150, 0.75), (600, 0), (1200, -1), (zw.Interval(0, 150), 0.75)):
        assert zw.check(device, zw.Wall(asked)).margin == margin
    assert zw.check(device.replace(damping=0), zw.Wall(100)).margin == -inf


@pytest.mark.parametrize("name", ASKED)
def test_no_answer_is_true_or_false(name: str) -> None:
    """`if verdict:` would take every answer for a proof; the message says what to ask, and that is a bool.

    The margin is on the side of the outcome: positive for yes, negative for no; some have none.
    """
    answer = answered(name)
    with pytest.raises(zw.InputError, match=rf"neither true nor false: ask \.{answer._YES}, which"):
        bool(answer)
    assert getattr(answer, answer._YES) is (name in YES)
    assert isinstance(answer, PassivityAnswer) is (name not in OF_STABILITY)
    if isinstance(answer, PassivityAnswer):
        assert answer.passive is (answer.outcome == "passive")
    assert (answer.margin is None) is (type(answer) in NO_SHARE)
    assert answer.margin is None or isfinite(answer.margin)
    assert answer.margin is None or (answer.margin > 0) is (name in YES)


@pytest.mark.parametrize("name", ASKED)
def test_an_answer_says_the_same_everywhere(name: str, tmp_path: Path) -> None:
    """In a line, in a notebook, as plain data, and in a file, whose evidence the checker accepts."""
    answer = answered(name)
    told = json.loads(answer.to_json())
    assert isinstance(page(name), Html)
    assert answer.outcome in page(name)
    assert escape(answer.claim) in page(name)
    assert type(answer).__name__.removeprefix("Linear") in repr(answer)
    assert told["format"].startswith("zwidth ")
    assert told["scope"]["contact"] == answer.scope.contact
    assert (told["outcome"], told["claim"]) == (answer.outcome, answer.claim)
    assert (answer.certificate is None) or (answer.witness is None)
    assert told["assumptions"][: len(answer.assumptions)] == list(answer.assumptions)
    answer.save(tmp_path / "answer.json")
    if name == "springs":
        assert answer.outcome == "theorem"
    else:
        assert verify_document(read_document(tmp_path / "answer.json")).valid


@pytest.mark.parametrize("name", ["active", "worst hand", "arm", "port"])
def test_an_answer_is_drawn(name: str, tmp_path: Path) -> None:
    """Into a file, and in a notebook: small, within the page, and said in words; in a line there is none."""
    answer = answered(name)
    path = tmp_path / "picture.png"
    assert answer.plot(path).axes
    assert path.stat().st_size > 1000
    assert page(name).count('<img src="data:image/png;base64,') == 1
    assert escape(answer.describe()) in page(name)
    assert len(page(name)) < 200_000
    assert "<img" not in repr(answer)


@pytest.mark.parametrize("name", ["spring", "bounding", "coupling"])
def test_where_there_is_nothing_to_draw_a_notebook_shows_the_claim(name: str) -> None:
    assert "<img" not in page(name)
    assert escape(answered(name).claim) in page(name)
    with pytest.raises(zw.InputError, match="no picture of this Bounding"):
        answered("bounding").plot()


def test_what_is_no_answer_shows_itself_too() -> None:
    """What a terminal prints: the protocol of a plan, the numbers of a fit, those of a finger."""
    plan = zw.plan(PADDLE, force_noise="10 mN")
    fit = zw.identification.PublishedFit(
        mass=0.04, damping=0.1, coulomb_friction=None, explained=0.9, passes=2, samples=9
    )
    finger = zw.identification.IdentifiedFinger(
        estimates={"stiffness": Estimate(500.0, 20.0, 5.0, 30, "N/m")}, instrument="position", findings=(),
        explained=0.9, pulse_length=0.05, pieces=3, pulses=7, motion="linear", source="press.csv",
    )  # fmt: skip
    for shown, says in ((plan, "Motor off"), (fit, "damping 0.1"), (finger, "press.csv")):
        assert says in repr(shown)
        assert escape(says) in shown._repr_html_()
        assert isinstance(shown._repr_html_(), Html)


def test_a_notebook_shows_what_to_change() -> None:
    shown, folded = page("active").split("<details>", 1)
    for text in ("what to change, any one of:", "raise the rate from"):
        assert text in shown
        assert text not in folded


@pytest.mark.parametrize("name", ASKED)
def test_an_answer_is_a_row_of_a_table(name: str) -> None:
    """Outcome, claim, scope and numbers in pandas and in xarray, by the names of the plain data."""
    answer = answered(name)
    row, data, stated = answer.to_pandas(), answer.to_xarray(), answer.stated()
    assert row["outcome"] == data["outcome"].item() == stated["outcome"]
    assert row["scope.contact"] == stated["scope"]["contact"]
    assert set(row.index) == set(data.data_vars)
    assert data.attrs["assumptions"].splitlines() == stated["assumptions"]
    for key, value in stated.items():
        if isinstance(value, float):
            assert row[key] == value
            assert data[key].item() == value


def test_rows_make_a_table_with_units() -> None:
    """Three walls beside each other: in pandas by a list of rows, in xarray along an axis."""
    walls = [200, 250, 770]
    verdicts = [zw.check(PADDLE, zw.Wall(k)) for k in walls]
    table = pd.DataFrame([verdict.to_pandas() for verdict in verdicts], index=walls)
    assert list(table["outcome"]) == ["passive", "passive", "active"]
    assert table.loc[770, "margins.damping_N_s_per_m"] == verdicts[2].margins["damping"]
    data = xr.concat([verdict.to_xarray() for verdict in verdicts], xr.DataArray(walls, dims="stiffness"))
    assert data["margins.damping_N_s_per_m"].attrs == {"units": "N*s/m"}
    assert (data["margins.damping_N_s_per_m"].values > 0).tolist() == [True, True, False]


IDEAL = zw.Device(damping="0.3", sample_period="0.001")
FILTER = zw.PulseTransferFunction([1000, -990], [1, "-0.5"])
LOOPS = {
    "passive": (PADDLE, zw.Wall(300)),
    "active": (PADDLE, zw.Wall(770)),
    "filter": (IDEAL.replace(damping=9), FILTER),
    "active filter": (IDEAL.replace(damping="0.1"), FILTER),
    "touched": (IDEAL.replace(damping="0.025"), zw.Wall(10, "0.3", zw.rendering.OnePole("0.01"))),
    "part of a sample": (IDEAL.replace(delay="0.0004"), zw.Wall(100)),
    "interval": (PADDLE, zw.Wall(zw.Interval(200, 400))),
    "row": (PADDLE, zw.render(zw.Wall(770), zw.rendering.ForceBounding())),
    "spring of any form": (PADDLE, zw.NonlinearSpring([0, "0.001"], [0, "0.1"])),
}


@pytest.mark.parametrize("name", LOOPS)
def test_a_verdict_goes_to_another_process_and_comes_back(name: str) -> None:
    """Outcome, scope and evidence are the same; the witness can still be made."""
    verdict = zw.check(*LOOPS[name])
    for again in (pickle.loads(pickle.dumps(verdict)), copy.deepcopy(verdict)):
        assert again.to_dict() == verdict.to_dict()
        assert (again.outcome, again.scope) == (verdict.outcome, verdict.scope)
        assert (again.witness is None) is (verdict.witness is None)
