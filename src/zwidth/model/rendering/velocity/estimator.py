"""A velocity made of encoder readings by a law that is not linear, or that knows the encoder.

The linear ones, which have a transfer function and so certificates, are in
`environment.velocity`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from zwidth.model.rendering.rendering_law import LoopContext
from zwidth.quantity.parameter import Parametric


@dataclass(frozen=True, kw_only=True)
class Estimator(Parametric, ABC):
    """A law v̂(x_k, x_{k−1}, …) for the laws that need a velocity."""

    kind: ClassVar[float]
    """Which step `estimate.estimate` takes; its own for each estimator."""

    @property
    @abstractmethod
    def state_size(self) -> int:
        """Numbers that it remembers."""

    @abstractmethod
    def numbers(self, at: LoopContext) -> list[float]:
        """The parameters of the step, defaults filled in from the device."""

    @abstractmethod
    def initial_state(self, reading: float) -> list[float]:
        """What it remembers after the hand has been at a reading for ever."""

    @abstractmethod
    def describe(self, motion: str = "linear") -> str:
        """In a few words."""
