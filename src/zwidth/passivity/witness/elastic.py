"""A violation of the criterion of motor, transmission and hand: by itself a proof that a loop is active."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.linear.criterion import frequency
from zwidth.passivity.linear.transmission import Elastic, ElasticRefutation
from zwidth.passivity.result import Evidence
from zwidth.passivity.scope import Contact, unit_key
from zwidth.passivity.witness.violation import FORMAT
from zwidth.passivity.witness.witness import Setting
from zwidth.quantity.text import exact_text, shown

if TYPE_CHECKING:
    from zwidth.passivity.witness.replayed import ReplayedMotion


@dataclass(frozen=True, repr=False)
class ElasticViolation(Evidence):
    """A proof that a hand can take any amount of energy out of a loop with a transmission."""

    elastic: Elastic
    setting: Setting
    refutation: ElasticRefutation
    device: Device
    environment: Environment

    @cached_property
    def witness(self) -> ReplayedMotion | None:
        """A motion that takes energy out where the simulator replays it; None where none was found."""
        from zwidth.passivity.witness.replayed import replayed_motion  # numpy and the loop take their time

        return replayed_motion(self.device, self.environment, self.elastic, self.refutation.cosine)

    @property
    def frequency(self) -> float | None:
        """A frequency at which the criterion is violated [Hz]; None where something else is."""
        cosine = self.refutation.cosine
        return None if cosine is None else frequency(cosine, self.elastic.loop.period)

    @property
    def contact(self) -> Contact:
        """A hand that stays inside finds it; or there is no surface."""
        return "kept" if self.setting.unilateral else "both sides"

    def to_dict(self) -> dict[str, Any]:
        """The violation as plain data."""
        cosine = self.refutation.cosine
        where = {} if cosine is None else {"cosine": exact_text(cosine)}
        return {
            "format": FORMAT,
            "kind": "transmission violation",
            **elastic_document(self.elastic, self.setting),
            "proof": {"kind": self.refutation.reason, **where},
        }

    def describe(self) -> str:
        """What is violated, in words."""
        if self.frequency is not None:
            return f"a motion at {shown(self.frequency, 'Hz')} gains"
        if self.refutation.reason == "unstable":
            return "while the hand holds still, the motor swings more and more on its transmission"
        return "pressed slowly, the law pulls the hand in"


def elastic_document(elastic: Elastic, setting: Setting) -> dict[str, Any]:
    """The loop and the transmission, exact."""
    numbers = {
        "mass": elastic.mass,
        "stiffness": elastic.stiffness,
        "damping": elastic.damping,
        "handle_damping": elastic.handle_damping,
    }
    unit = {name: unit_key(name.removeprefix("handle_"), setting.motion) for name in numbers}
    keys = {name: f"handle_{unit[name]}" if name.startswith("handle_") else unit[name] for name in numbers}
    given = {keys[name]: exact_text(value) for name, value in numbers.items()}
    encoder = "handle" if elastic.at_handle else "motor"
    return {"loop": setting.loop_document(), "transmission": {**given, "encoder": encoder}}
