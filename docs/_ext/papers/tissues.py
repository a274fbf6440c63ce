"""The soft-tissue paper: its criterion, its figures and its tables."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import zwidth as zw
from papers.row import Row, close, drawn, row
from zwidth.passivity.formulas.colgate_schenkel import kelvin_voigt_damping
from zwidth.passivity.formulas.standard_linear_solid import standard_linear_solid_damping

TITLE = "A passivity criterion for real-time haptic simulation of viscoelastic soft tissues"

SOURCE = """m0, m1, h1 and v stand for μ0, μ1, η1 and ω. Slips: the second denominator of (11) is T/(η1(1 −
e^{−jωT})); the imaginary part of (13) lacks 2μ1η1(cos ωT − 1); in (15) the second term is subtracted, as in
(16); 2m1 of (21) is 2η1; the denominator of a1 in appendix 2 is μ1T + 2η1; the first exponent of (36) is
−jωT; the last bracket of (37) is (2η1 − μ1T); the sine in (38) is squared; the first entry of (42) is μ0T/2
− η1; damping is in N·s/m, and sufficiency of (1) needs a stable H."""

PHANTOM = zw.catalogue.device("phantom")
T, B = 1e-3, 0.27


def rows() -> list[Row]:
    """The models, the criterion, its two simulations, the experiment, the estimation."""
    return [*_models(), *_criterion(), *_simulations(), *_experiment(), *_estimation()]


def _solid(
    stiffness: object, damping: object, rule: str = "backward", branch: object = 10
) -> zw.StandardLinearSolid:
    return zw.StandardLinearSolid(stiffness, branch, damping, discretization=rule)


def _models() -> list[Row]:
    solid, time = zw.StandardLinearSolid(300, 200, 40), np.array([0.0, 1e3])
    force = zw.tissue.relaxation(solid, time)
    back = float(zw.tissue.creep(solid, np.array([50.0]))[0] - zw.tissue.creep(solid, np.array([49.0]))[0])
    t = np.linspace(0, 1, 2001)
    x = 1e-3 * (1 - np.cos(6 * t))
    f = zw.tissue.force_response(solid, t, x)
    v, df = (np.gradient(values, t) for values in (x, f))
    off = float(np.abs(f + 40 / 200 * df - 300 * (x + 40 / 300 * (1 + 300 / 200) * v))[5:-5].max() / f.max())
    return [
        row("Fig. 1, (3), appendix 1", "the standard linear solid: F + (η1/μ1)Ḟ = μ0[u + (η1/μ0)(1 + "
        "μ0/μ1)u̇]",
            f"a computed motion keeps to it within {off:.1g} of its largest force", off < 1e-4),
        row("Fig. 2", "it relaxes to a force that is not 0, and creep comes back to 0",
            f"1 m into 300 N/m beside 200: {force[0]:g} N, then {force[1]:g} N; {1e3 * back:.1g} mm stay "
            "49 s after "
            f"1 N ({drawn('creep_relaxation')})", close(force[1], 300, 1e-6) and abs(back) < 1e-6),
    ]  # fmt: skip


def _criterion() -> list[Row]:
    rng = np.random.default_rng(0)
    cases = [[round(float(v), 3) for v in np.exp(rng.uniform(0, 6, 3))] for _ in range(40)]
    off = {}
    for rule in ("backward", "tustin"):
        off[rule] = max(
            abs(float(zw.check(PHANTOM, _solid(k, eta, rule, mu)).required_damping)
                / float(standard_linear_solid_damping(k, mu, eta, T, rule)) - 1)
            for k, mu, eta in cases
        )  # fmt: skip
    nyquist = all(
        zw.check(PHANTOM, _solid(k, eta, branch=mu)).critical_frequency == 500 for k, mu, eta in cases
    )
    kelvin = abs(float(zw.check(PHANTOM, zw.Wall(100, "0.1")).required_damping)
                 - float(kelvin_voigt_damping(100, "0.1", T)))  # fmt: skip
    harder = all(
        standard_linear_solid_damping(k, mu, eta, T) <= standard_linear_solid_damping(k, mu, eta, T, "tustin")
        for k, mu, eta in cases
    )
    negative = zw.check(PHANTOM, _solid(100, -3)).outcome
    return [
        row("Fig. 3, (1), (2)", "the sampled loop; of a Kelvin–Voigt wall b > KT/2 + B",
            f"100 N/m and 0.1 N·s/m: {kelvin:.1g} N·s/m beside it", kelvin < 1e-12),
        row("Theorem 1, (9), (19)", "backward Euler: b > μ0T/2 + μ1η1T/(2η1 + μ1T), largest at ω = π/T",
            f"{len(cases)} random solids: within {off['backward']:.1g}; tightest at 500 Hz "
            f"{'each time' if nyquist else 'not always'}", off["backward"] < 1e-9 and nyquist,
            "the paper compares three frequencies; it is so at all"),
        row("(22), (43), appendix 3", "Tustin: b > (μ0 + μ1)T/2, which asks for more",
            f"the same solids: within {off['tustin']:.1g}, never less than backward Euler",
            off["tustin"] < 1e-9 and harder),
        row("(41), (42)", "for η1 < 0 the largest of two terms is enough", f"η1 = −3 N·s/m: {negative}",
            False, "H is then unstable, and the criterion says nothing"),
    ]  # fmt: skip


def _most(wall: object, period: float = T) -> float | None:
    found = zw.check(PHANTOM.replace(sample_period=period), wall).max_stiffness
    return None if found is None else float(found)


def _simulations() -> list[Row]:
    dampings = (0.01, 0.1, 0.2, 0.26)
    solids = [_most(_solid(100, eta)) for eta in dampings]
    walls = [_most(zw.Wall(100, eta)) for eta in dampings]
    slow = [_most(_solid(100, 0.5), period) for period in (0.0005, 0.001, 0.005)]
    kelvin = _most(zw.Wall(100, 0.5))
    return [
        row("Fig. 4(a)", "at 1 ms, over the damping of the tissue, a much stiffer solid than Kelvin–Voigt "
        "wall is passive",
            f"0.01 to 0.26 N·s/m: {_many(solids)} against {_many(walls)} N/m ({drawn('soft_tissue')})",
            all(s > w for s, w in zip(solids, walls, strict=True)) and solids[-1] > 10 * walls[-1]),
        row("Fig. 4(b)", "at 0.5 N·s/m, of both models less stiffness is passive as the sample period grows",
            f"0.5, 1, 5 ms: the solid {_many(slow)} N/m; of the Kelvin–Voigt wall "
            f"{'none' if not kelvin else f'{kelvin:g} N/m'} at any ({drawn('soft_tissue')})",
            bool(kelvin), "the solid so; but 0.27 N·s/m of the device is less than B alone, and no such "
            "curve can be"),
    ]  # fmt: skip


def _many(values: list[float | None]) -> str:
    return ", ".join(f"{v:.4g}" for v in values if v is not None)


def _experiment() -> list[Row]:
    two, three = _published()
    solid, kelvin = (
        [_most(wall(b)) or 0.0 for b in two[0]] for wall in (lambda b: _solid(1, b), lambda b: zw.Wall(1, b))
    )
    shared = (two[1][list(two[0]).index(0.5)], three[1][list(three[0]).index(1.0)])
    falls = bool(np.all(np.diff(three[1]) < 0) and np.all(np.diff(three[2]) < 0))
    slow = [_most(_solid(1, 0.5), t / 1000) or 0.0 for t in three[0]]
    drop = 1 - three[1][-1] / three[1][1], 1 - slow[-1] / slow[1]
    gains = 100 * (three[1] / three[2] - 1)
    most = float(gains.max()), float(three[0][int(gains.argmax())])
    guide = drawn("motorized_guide", "the experiment simulated")
    return [
        row("Fig. 5, Table 1", "a motorized guide pushes a PHANToM into the wall; damping 0 to 14 N·s/m, "
        "0.5 to 5 ms",
            f"{guide}, with the mass and the stiffness that come nearest to both tables", None,
            "mass and stiffness of the guide are not printed"),
        row("Fig. 6(a), Table 2", "the largest stiffness of the solid hardly depends on damping, that of "
        "the Kelvin–Voigt "
            "wall falls to 0 at 14 N·s/m", f"largest passive: {min(solid):.0f} to {max(solid):.0f} N/m of "
            "the solid; "
            f"{kelvin[0]:.0f} falling to {kelvin[-1]:.0f} N/m of the wall ({guide})",
            max(solid) < 1.1 * min(solid) and kelvin[-1] == 0,
            f"in shape; what was measured is {two[1][0] / solid[0]:.1f} times what is passive: a guide is "
            "one hand"),
        row("Fig. 6(b), Table 3", "of both the largest stiffness falls as the sample period grows",
            f"measured it {'falls' if falls else 'does not fall'}, by {drop[0]:.0%} from 1 to 5 ms; what "
            "is passive of "
            f"the solid by {drop[1]:.0%}", falls,
            f"the tables disagree where they meet, {shared[0]:.0f} and {shared[1]:.0f} N/m"),
        row("conclusions, Table 3", "with the sample period the largest gain of the new criterion is 3.96 "
        "%, at 0.5 ms",
            f"of the published numbers {most[0]:.2f} %, at {most[1]:g} ms",
            abs(most[0] - 3.96) < 0.01 and most[1] == 0.5),
        row("conclusions, Table 2", "the new criterion is less conservative, most with much damping",
            f"{100 * (two[1][-1] - two[2][-1]) / two[1][-1]:.0f} % of Table 2's last row; passive: "
            f"{solid[-1]:.0f} N/m against {kelvin[-1]:.0f}", solid[-1] > kelvin[-1],
            '"criterion based on the linear solid model" means Kelvin–Voigt there'),
    ]  # fmt: skip


def _published() -> tuple[np.ndarray, np.ndarray]:
    """Tables 2 and 3 as the gallery's page has them: what is varied, solid, Kelvin–Voigt."""
    source = (Path(__file__).parents[3] / "examples" / "plot_motorized_guide.py").read_text(encoding="utf-8")
    texts = [source.split(f"{name} = ")[1] for name in ("TABLE_2", "TABLE_3")]
    tables = [text.split('"""')[1] if text.startswith('"""') else text.split('"')[1] for text in texts]
    first, second = (np.array([row.split() for row in t.split(";")], dtype=float).T for t in tables)
    return first, second


def _estimation() -> list[Row]:
    time = T * np.arange(20_000)
    x = 0.006 + 1e-3 * (3 * np.sin(4.4 * time) + np.sin(19.5 * time) + 0.5 * np.sin(71 * time))
    tissue = zw.StandardLinearSolid(300, 150, 15)
    force = zw.tissue.force_response(tissue, time, x) + np.random.default_rng(1).normal(0, 0.01, time.size)
    five = zw.tissue.track_five_parameters(x, force, T, forgetting=0.9995)["stiffness"][-5000:]
    three = zw.tissue.RecursiveSolid(T, (200, 200, 20), method="instrumental", forgetting=0.9995, noise=0.01)
    mean = float(three.track(x, force).stiffness[-5000:].mean())
    return [
        row("appendix 2, algorithm 1", "recursive least squares on five numbers finds μ0, μ1 and η1 while "
        "the tissue is "
            "touched", f"of μ0 = 300 N/m it finds {float(np.median(five)):.0f} N/m; on three numbers, with "
            "instruments, "
            f"{mean:.0f} N/m ({drawn('tracking_tissue')})", bool(abs(np.median(five) / 300 - 1) < 0.1),
            "(1 + z⁻¹) cancels, so five numbers are not to be told apart"),
    ]  # fmt: skip
