"""Small gain files with the numbers that people have, for tests."""

from __future__ import annotations

from pathlib import Path

STIFFNESS = [240, 240, 240, 240, 24, 31, 25, 16]
DAMPING = [3, 3, 3, 3, 0.2, 0.2, 0.2, 0.2]
COULOMB = [0.306, 0.306, 0.40, 0.166, 0.050, 0.083, 0.172, 0.0512]
STEEPNESS = [28.417, 28.417, 29.065, 130.038, 151.771, 242.287, 7.888, 4.0]
VISCOUS = [0.063, 0.063, 0.604, 0.813, 0.029, 0.072, 0.084, 0.084]
OFFSET = [0.088, 0.088, 0.008, -0.058, 0.005, 0.009, -0.059, -0.050]


def openarm(side: str = "Leader", **changed: list[float]) -> str:
    """The lists of one side; None leaves one out."""
    lists = {"Kp": STIFFNESS, "Kd": DAMPING, "Fc": COULOMB, "k": STEEPNESS, "Fv": VISCOUS, "Fo": OFFSET}
    lines = [f"  {key}: {values}" for key, values in {**lists, **changed}.items() if values is not None]
    return "\n".join([f"{side}ArmParam:", *lines, ""])


YAM = """
motor_list:
  - [0x01, "DM4340"]
  - [0x02, "DM4340"]
  - [0x03, "DM4340"]
  - [0x04, "DM4310"]
  - [0x05, "DM4310"]
  - [0x06, "DM4310"]
kp: [80.0, 80.0, 80.0, 10.0, 10.0, 10.0]
kd: [5.0, 5.0, 5.0, 1.5, 1.5, 1.5]
grav_comp_kd: [0.1, 0.1, 0.1, 0.3, 0.05, 0.05]
coulomb_friction: [0.3, 0.3, 0.3, 0.06, 0.06, 0.06]
"""
GRIPPER = 'motor_type: "DM4310"\nmotor_kp: 20.0\nmotor_kd: 0.5\n'
SERVOS = (
    """{"robot": {"type": "so101_follower", "position_p_coefficient": 32, "position_d_coefficient": 32}}"""
)
DAMIAO = """
robot:
  type: openarm_follower
  position_kp: [240, 240, 240, 240, 24, 31, 25, 25]
  position_kd: [5, 5, 3, 5, 0.3, 0.3, 0.3, 0.3]
"""
PIPER = "[piper]\nkp = [10, 10, 10, 10, 10, 10]\nkd = [0.8, 0.8, 0.8, 0.8, 0.8, 0.8]\n"


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path
