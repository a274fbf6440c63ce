"""What an emulated device moves: a mass that a hand holds as a spring with some damping."""

from dataclasses import dataclass


@dataclass
class Handle:
    """``m a = f + k (h − x) − b v``, one semi-implicit step of Euler for each command; all in SI units.

    The same numbers serve a handle that turns: kg m², N·m/rad, N·m·s/rad, rad.
    """

    mass: float = 0.1
    hand: float = 0.02
    stiffness: float = 80.0
    damping: float = 0.6
    step_length: float = 1e-3
    position: float = 0.0137
    speed: float = 0.0

    def step(self, force: float) -> None:
        """Go on for one step under a force."""
        pull = self.stiffness * (self.hand - self.position) - self.damping * self.speed
        self.speed += self.step_length * (force + pull) / self.mass
        self.position += self.step_length * self.speed
