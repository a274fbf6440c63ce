"""One glossary of quantities: symbol, name, unit, meaning.

Axis labels, option help, report rows, JSON keys and docs tables read it, so
that the same name has the same unit everywhere.  A rotary device carries
torque and angle in the place of force and position: its units stand beside.
"""

from __future__ import annotations

from typing import NamedTuple


class Quantity(NamedTuple):
    """A physical quantity as people meet it."""

    name: str
    symbol: str
    unit: str
    rotary_unit: str
    meaning: str

    def unit_for(self, motion: str) -> str:
        """The SI unit for a "linear" or a "rotary" device."""
        return self.rotary_unit if motion == "rotary" else self.unit

    def key_for(self, motion: str) -> str:
        """Its key in a file, unit included: "damping_N_s_per_m"."""
        return f"{self.name}_{unit_suffix(self.unit_for(motion))}"


def unit_suffix(unit: str) -> str:
    """A unit as part of a key: "N*s/m" becomes "N_s_per_m"."""
    return unit.replace("/", "_per_").replace("*", "_").replace("^", "")


def _q(name: str, symbol: str, unit: str, rotary_unit: str, meaning: str) -> tuple[str, Quantity]:
    return name, Quantity(name, symbol, unit, rotary_unit, meaning)


GLOSSARY: dict[str, Quantity] = dict(
    [
        _q("mass", "m", "kg", "kg*m^2", "inertia felt at the handle; no criterion here depends on it"),
        _q("damping", "b", "N*s/m", "N*m*s/rad", "viscous friction of the device itself"),
        _q("coulomb_friction", "f_c", "N", "N*m", "dry friction of the device itself"),
        _q("stiction", "f_s", "N", "N*m", "largest friction at rest; no criterion here depends on it"),
        _q("friction_speed", "v_f", "m/s", "rad/s", "speed up to which the friction was measured"),
        _q("resolution", "Δ", "m", "rad", "one encoder count at the handle; 0 means ideal"),
        _q("sample_period", "T", "s", "s", "time between two samples"),
        _q("rate", "1/T", "Hz", "Hz", "samples per second"),
        _q("delay", "τ", "s", "s", "from taking a sample to applying its force"),
        _q("force_limit", "F_max", "N", "N*m", "largest force of the actuator"),
        _q("force_resolution", "ΔF", "N", "N*m", "one step of the digital-to-analogue converter"),
        _q("motor_inductance", "L", "H", "H", "inductance of the motor winding"),
        _q("supply_voltage", "U", "V", "V", "largest voltage of the amplifier"),
        _q("current_limit", "I_max", "A", "A", "largest current command"),
        _q("stiffness", "K", "N/m", "N*m/rad", "virtual stiffness"),
        _q("virtual_damping", "B", "N*s/m", "N*m*s/rad", "virtual damping"),
        _q("virtual_mass", "M", "kg", "kg*m^2", "inertia of a simulated body"),
        _q("body_damping", "B_y", "N*s/m", "N*m*s/rad", "damper from a simulated body to the ground"),
        _q("body_stiffness", "K_y", "N/m", "N*m/rad", "spring from a simulated body to the ground"),
        _q("wave_impedance", "R", "N*s/m", "N*m*s/rad", "impedance of a line between two processes"),
        _q("exponent", "n", "1", "1", "of the depth in a Hunt–Crossley contact"),
        _q("dissipation", "λ", "s/m", "s/rad", "damping of a Hunt–Crossley contact, f = K uⁿ (1 + λ v)"),
        _q("local_damping", "D", "N*s/m", "N*m*s/rad", "virtual damping of an arm's own speed"),
        _q("compensated_coulomb_friction", "F", "N", "N*m", "Coulomb friction that is compensated"),
        _q("compensated_damping", "C", "N*s/m", "N*m*s/rad", "viscous friction that is compensated"),
        _q(
            "compensation_speed",
            "v_s",
            "m/s",
            "rad/s",
            "at which compensation of Coulomb friction has come to three quarters; 0: at any speed",
        ),
        _q("reflection", "r", "1", "1", "how many times an arm adds the coupling force of the other"),
        _q("compensation", "", "1", "1", "of friction, as a share of what it is"),
        _q("link_delay", "τ_link", "s", "s", "from one arm's reading to the other's controller"),
        _q(
            "wave_impedance",
            "w",
            "N*s/m",
            "N*m*s/rad",
            "of the waves over a link: force over speed in a wave",
        ),
        _q("branch_stiffness", "μ1", "N/m", "N*m/rad", "spring in series with a dashpot"),
        _q("branch_damping", "η1", "N*s/m", "N*m*s/rad", "dashpot in series with a spring"),
        _q("time_constant", "τ_v", "s", "s", "time constant of a velocity filter"),
        _q("speed", "v", "m/s", "rad/s", "of the handle"),
        _q("position", "x", "m", "rad", "positive into the wall"),
        _q("velocity", "v", "m/s", "rad/s", "positive into the wall"),
        _q("force", "f", "N", "N*m", "actuator force, positive out of the wall"),
        _q("energy", "W", "J", "J", "energy through the port"),
        _q("frequency", "ω/2π", "Hz", "Hz", "frequency of the hand's motion"),
    ]
)
