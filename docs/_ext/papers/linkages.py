"""Miller, Colgate & Freeman 2004."""

from __future__ import annotations

import numpy as np

import zwidth as zw
from papers.row import Row, close, drawn, row

TITLE = "On the role of dissipation in haptic systems (Miller, Colgate & Freeman 2004)"

SOURCE = (
    "Slips: the mapping that is output strictly passive is τ → q̇, not q̇ → τ; Ṁ − 2C = 0 holds only as "
    "q̇ᵀ(Ṁ − 2C)q̇ = 0; the Jacobian depends on position only; J† = Jᵀ(JJᵀ)⁻¹."
)


def rows() -> list[Row]:
    """Figure by figure, the lemma and the theorem with theirs."""
    return [*_system(), *_lemma(), *_joints(), *_rule()]


def _system() -> list[Row]:
    device = zw.catalogue.device("haptic-paddle", resolution=0, coulomb_friction=0)
    T, k = 1e-3, 500.0
    needs = []
    for samples in range(3):
        late = device.replace(delay=f"0.00{samples}")
        needs.append(float(zw.check(late, zw.Wall(500)).required_damping))
    rule = [(2 * d + 1) * k * T / 2 for d in range(3)]
    body = [float(zw.coupling.coupling_condition(device, 200, b).required_damping) for b in ("0.05", "0.1")]
    return [
        row("Fig. 1", "device and simulation are joined by a virtual coupling, to be chosen with the "
        "damping of "
            "the device", f"200 N/m with 0.05 or 0.1 N·s/m ask for {body[0]:.4g} or {body[1]:.4g} N·s/m of "
            "any "
            f"device, before every passive simulation ({drawn('coupling')})",
            close(body[0], 0.15) and close(body[1], 0.2)),
        row("Fig. 2, (3)", "the loop transformation with A(z) = (T/2α)(1 + z⁻¹ + … + z⁻ᵈ) makes up for d "
        "samples "
            "of delay", f"a spring of 500 N/m, d = 0, 1, 2: {_many(needs)} N·s/m are asked for; the "
            f"transformed loop gives (2d + 1)KT/2, {_many(rule)} ({drawn('delay')})",
            np.allclose(needs, rule, rtol=1e-9), "exact for a spring, and not only sufficient"),
    ]  # fmt: skip


def _many(values: list[float]) -> str:
    return ", ".join(f"{v:.4g}" for v in values)


def _lemma() -> list[Row]:
    T, m, b, late, samples = 1e-3, 0.05, 0.3, 2, 400
    forces = np.random.default_rng(3).normal(0, 1, samples)
    x, v = np.zeros(samples + 1), np.zeros(samples + 1)
    fade = np.exp(-b * T / m)
    for k in range(samples):
        held = forces[k - late - 1] if k > late else 0.0
        v[k + 1] = fade * v[k] + (1 - fade) * held / b
        x[k + 1] = x[k] + held / b * T + (v[k] - held / b) * m / b * (1 - fade)
    stored = zw.coupling.loop_storage(forces[:, None], x[:, None], m * v**2 / 2, b, T, late * T)
    scale = float(np.abs(stored["supply"]).max())
    kept = int((stored["slack"].values > -1e-12 * scale).sum())
    return [
        row("Fig. 3, Lemma 2, (4) to (7)", "device, hold and d samples of delay are output strictly "
        "passive in "
            "discrete time, with storage W", f"random forces on a mass and damper, d = {late}: W grows by "
            "no more "
            f"than yᵀu − αyᵀy in {kept} of {samples} samples ({drawn('storage_of_an_arm')})",
            kept == samples, "the equations that are missing in print were derived anew"),
    ]  # fmt: skip


def _joints() -> list[Row]:
    lengths, q = np.array([0.2, 0.15, 0.1]), np.array([0.4, 0.7, -0.5])
    angles = np.cumsum(q)
    tips = lengths * np.array([-np.sin(angles), np.cos(angles)])
    full = np.cumsum(tips[:, ::-1], axis=1)[:, ::-1]
    joints = np.diag([0.03, 0.02, 0.01])
    answers = []
    for jacobian, damping in ((_two(lengths, q), joints[:2, :2]), (full, joints)):
        printed = zw.arms.end_effector_damping(jacobian, damping, as_published=True)
        felt = zw.arms.end_effector_damping(jacobian, damping)
        answers.append(float(np.linalg.eigvalsh(printed)[-1] / np.linalg.eigvalsh(felt)[-1]))
    return [
        row("(24)", "joint damping is felt at the end effector as (Jᵀ)†δ_m J†",
            f"two joints: {answers[0]:.6f} of what a hand feels; three joints in a plane: {answers[1]:.3f} "
            "of it",
            close(answers[0], 1, 1e-9) and close(answers[1], 1, 1e-9),
            "of a redundant arm it promises too much: "
            "[(Jδ_m⁻¹Jᵀ)⁻¹](theory/arms.md#from-the-joints-to-the-hand) is felt"),
    ]  # fmt: skip


def _two(lengths: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The Jacobian of the first two links."""
    angles = np.cumsum(q[:2])
    tips = lengths[:2] * np.array([-np.sin(angles), np.cos(angles)])
    return np.cumsum(tips[:, ::-1], axis=1)[:, ::-1]


def _rule() -> list[Row]:
    place = ((0.7, 0.7002), (1.2, 1.2002))  # so small that it has one limit
    joints, T = np.array([[0.02, 0.005], [0.005, 0.01]]), 1e-3
    arm = zw.arms.PlanarChain(links=(0.1, 0.08), damping=joints, joint_range=place)
    jacobian = _two(np.array([0.1, 0.08]), np.array([0.7001, 1.2001]))
    inverse = np.linalg.inv(jacobian)
    most = 2 / T * float(np.linalg.eigvalsh(inverse.T @ joints @ inverse)[0])
    outcomes = [
        zw.workspace(arm, zw.Wall(round(part * most, 6)), rate=1000).outcome for part in (0.996, 1.004)
    ]
    return [
        row("Fig. 4, Theorem 3, (25)", "to show a class of environments that need δ the joints must have "
            "δ_m ⪰ JᵀδJ", f"two links whose joints share friction: by the rule {most:.4g} N/m; 0.4 % "
            "softer is "
            f"{outcomes[0]}, 0.4 % stiffer {outcomes[1]} ({drawn('workspace')})",
            outcomes == ["passive", "active"]),
    ]  # fmt: skip
