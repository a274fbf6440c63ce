"""The commands `simulate` and `traces`: a touch, simulated, saved, drawn, heard and compared."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.decision import of_one_value
from zwidth.cli.options import IN_FULL, LAW, PARAMETERS, given, output, overrides
from zwidth.cli.output import PICTURES, print_json, say_written, target
from zwidth.cli.simulate.tables import follower_parameters, operator_parameters, simulation_parameters
from zwidth.errors import InputError
from zwidth.model.environment import Environment, NonlinearSpring
from zwidth.model.operator.named import usual_kind
from zwidth.model.operator.operator import ParametricOperator
from zwidth.model.pairs import Pair
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.load import option_keys, pair_of
from zwidth.model.specification.read import PAIR_TABLES, TABLES, read_tables, specified
from zwidth.model.specification.table import Table
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.loop.trace import AnyTrace, Trace
    from zwidth.model.device import Device
    from zwidth.model.operator import Operator


SAVED = (".nc", ".parquet", ".csv")
SOUNDS = (".wav",)
INTERRUPTED = 130

ANGLES = "angles_in"
"""The attribute of a saved trace that says in which unit angles are told."""


USAGE = (
    "[SOURCE ...] --operator TYPE --duration TIME [--law NAMES] [--PARAMETER VALUE ...] "
    "[--all] [--json] [--plot FILE] [--sound FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {
        "sources=SOURCE*": "device of the catalogue, or TOML file with tables [device], [environment], "
        "[[law]], [operator], [simulation]; or one with [leader], [follower], [coupling], [operator], "
        "[follower_operator], [simulation]",
        **LAW,
    },
    "output",
    {
        **output("the summary", "the plot", "the trace: .nc, .parquet, .csv"),
        **IN_FULL,
        "--sound FILE": "save the actuator force as sound: .wav",
    },
    "hand: a key of the hand is written --operator.force, …",
    operator_parameters,
    "what holds the follower of a pair",
    follower_parameters,
    "simulation",
    simulation_parameters,
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth simulate`: 0, or 130 after Ctrl-C."""
    from zwidth.cli.simulate.tables import FOLLOWER

    plot, sound, save = _targets(arguments)
    tables = read_tables(arguments.sources, (*TABLES, *PAIR_TABLES, FOLLOWER))
    pair = any(name in tables for name in PAIR_TABLES)
    trace, missed, hand, everywhere = (
        (simulated_pair(arguments, tables), "", "", False) if pair else _simulated(arguments, tables)
    )
    if sound is not None:
        from zwidth.loop.traces.files import save_sound

        save_sound(trace.sel(arm="leader") if pair else trace, sound, force=True)
    if save is not None or plot is not None:
        from zwidth.loop.traces.accessor import TraceAccessor  # xarray takes its time

        data = trace.dataset()
        if save is not None:
            TraceAccessor(data.assign_attrs(_angles())).save(save, force=True)
        if plot is not None:
            TraceAccessor(data).plot(plot)
    if arguments.json:
        print_json(json.dumps(summary(trace), indent=2, ensure_ascii=False))
    else:
        from zwidth.cli.simulate.trace_report import print_pair_trace, print_trace

        if pair:
            print_pair_trace(trace, arguments.in_full)
        else:
            print_trace(trace, arguments.in_full, missed, hand, everywhere)
        say_written(save, plot, sound)
    return INTERRUPTED if "interrupted_at_s" in trace.attrs else 0


def _simulated(arguments: argparse.Namespace, tables: Mapping[str, Table]) -> tuple[Trace, str, str, bool]:
    """The touch, what to say where it met nothing, and of the hand; and whether the law acts everywhere."""
    from zwidth.cli.simulate.tables import (
        FOLLOWER,
        build_touch,
        follower_parameters,
        operator_parameters,
        simulation_parameters,
    )
    from zwidth.loop.simulate import simulated
    from zwidth.progress import with_bar

    if FOLLOWER in tables or given(arguments, [p.key for p in follower_parameters()]):
        raise InputError(
            "the loop of one device has no follower: give a file with [leader], [follower] and [coupling], "
            "or leave out what holds the follower"
        )
    loop = of_one_value(specified(tables, overrides(arguments)))
    environment = with_laws(loop.environment, tables.get("law"), arguments.law, loop.device.motion)
    keys = [p.key for p in (*operator_parameters(), *simulation_parameters())]
    words = given(arguments, keys)
    touch = build_touch(tables.get("operator"), tables.get("simulation"), words, loop.device)
    duration, remarks = touch.duration, [made_for_a_handle(touch.operator, loop.device)]
    if duration is None:
        duration = own_duration(touch.operator, float(loop.device.exact("sample_period")))
    if duration is None:
        duration = _USUAL
        remarks.append(f"{shown(_USUAL, 's')} of it, since no --duration is given.")
    trace = with_bar(simulated, "samples")(
        loop.device, environment, touch.operator, duration, **touch.options
    )
    return (
        trace,
        never_reached(trace, environment.met, loop.device.motion),
        " ".join(filter(None, remarks)),
        _surface(environment.met) is None,
    )


def _angles() -> dict[str, str]:
    """In which unit angles were asked for, for whoever reads the trace: its numbers are SI."""
    unit = spoken("rad")[1]
    return {} if unit == "rad" else {ANGLES: unit}


def made_for_a_handle(operator: Operator, device: Device) -> str:
    """That a hand has the mass of one on a handle that slides, in kg·m², and which to take; "" of others."""
    if device.motion == "linear" or not isinstance(operator, ParametricOperator) or operator.motion:
        return ""
    usual = [field.default for field in fields(operator) if field.name == "mass"]
    if not usual or operator.mass != usual[0]:  # type: ignore[attr-defined]
        return ""
    return (
        "These numbers are of a handle that slides, read in N·m and rad: give those of a hand on this "
        f"device, or take --operator {usual_kind(device)}."
    )


def never_reached(trace: AnyTrace, met: Environment, motion: str) -> str:
    """That the hand stayed where the law gives no force, and how to start nearer; "" where it did not."""
    begins = _surface(met)
    deepest = float(trace["position"].values.max())
    if begins is None or deepest > begins:
        return ""
    unit = GLOSSARY["position"].unit_for(motion)
    starts = shown(begins, unit)
    nearer = f', or start there: --initial-position "{starts}"' if begins else ""
    return (
        f"This hand never reached the wall: it begins at {starts}, and the hand came to "
        f"{shown(deepest, unit)}. Let it push harder or longer{nearer}."
    )


def _surface(met: Environment) -> float | None:
    """Where a law begins to give a force [m; rad]; None where it acts everywhere."""
    if isinstance(met, NonlinearSpring) and met.positions[0] > 0 == met.forces[0]:
        return float(met.positions[0])
    return 0.0 if met.unilateral and not isinstance(met, NonlinearSpring) else None


_USUAL = 2.0
"""How long a hand is simulated that has no time of its own [s]."""


def own_duration(operator: Any, period: float) -> float | None:
    """How long a record or a witness lasts [s]; None of other hands."""
    if hasattr(operator, "newtons"):
        return len(operator.newtons) * period
    if hasattr(operator, "intervals"):
        return (operator.intervals + 1) * period  # type: ignore[no-any-return]  # and comes to rest
    return None


def summary(trace: AnyTrace) -> dict[str, Any]:
    """What the command prints as JSON: the trace's attributes, its measures and its energies."""
    about = {key: value for key, value in trace.attrs.items() if key != "format"}
    if "arm" in trace.dims:
        return {"format": "zwidth pair simulation 1", **about, **pair_measures(trace)}
    from zwidth.loop.energy import ledger
    from zwidth.loop.traces.measures import keyed, measure

    measures = keyed(measure(trace), str(trace.attrs["motion"]))
    return {"format": "zwidth simulation 1", **about, **measures, "energy": ledger(trace).to_dict()}


def _targets(arguments: argparse.Namespace) -> tuple[Path | None, Path | None, Path | None]:
    """The files to write, checked before anything is computed."""
    plot = target("--plot", arguments.plot, PICTURES, arguments.force)
    sound = target("--sound", arguments.sound, SOUNDS, arguments.force)
    save = target("--save", arguments.save, SAVED, arguments.force)
    return plot, sound, save


def simulated_pair(arguments: argparse.Namespace, tables: Mapping[str, Table]) -> Trace:
    """The trace of the pair, and of what holds it, that tables and command line describe."""
    from zwidth.cli.simulate.tables import (
        FOLLOWER,
        build_follower,
        build_touch,
        follower_parameters,
        operator_parameters,
        simulation_parameters,
    )
    from zwidth.loop.simulate import simulated
    from zwidth.progress import with_bar

    pair = pair_with_options(arguments, tables)
    typed = given(arguments, [p.key for p in (*operator_parameters(), *simulation_parameters())])
    touch = build_touch(tables.get("operator"), tables.get("simulation"), typed, pair.leader)
    of_follower = given(arguments, [p.key for p in follower_parameters()])
    follower = build_follower(tables.get(FOLLOWER), of_follower, pair.follower)
    if touch.duration is None:
        raise InputError('no duration is given: set --duration, for example --duration "2 s"')
    return with_bar(simulated, "samples")(pair, touch.operator, follower, touch.duration, **touch.options)


def pair_with_options(arguments: argparse.Namespace, tables: Mapping[str, Table]) -> Pair:
    """The pair of the tables, with what the command line says of its coupling."""
    for name in ("environment", "law"):
        if name in tables or (name == "law" and arguments.law):
            raise InputError(
                f"two arms meet each other, not a virtual wall: leave out the {name}; what the follower "
                "really meets is for zwidth simulate, --follower-operator wall"
            )
    coupling, words = option_keys(), overrides(arguments)
    foreign = sorted(set(words) - set(coupling))
    if foreign:
        raise InputError(
            f"--{foreign[0].replace('_', '-')} does not say of which arm: write it in [leader] or [follower]"
        )
    arms = {name: tables[name] for name in ("device", *PAIR_TABLES) if name in tables}
    return pair_of(arms, words)


BESIDES = (
    ("device, environment, operator, amplifier, timing, motion", "what was simulated, in words"),
    (
        "sample_period_s, delay_s, resolution_m, encoder_phase_counts, mass_kg, damping_N_s_per_m, "
        "coulomb_friction_N, stiction_N, force_limit_N",
        "the device",
    ),
    (
        "transmission_stiffness_N_per_m, transmission_damping_N_s_per_m, transmission_handle_mass_kg,"
        " transmission_handle_damping_N_s_per_m, transmission_handle_coulomb_friction_N, encoder",
        "of a device with a transmission",
    ),
    ("hand_mass_kg, hand_stiffness_N_per_m, hand_damping_N_s_per_m", "the hand"),
    (
        "deepest_position_m, peak_actuator_force_N, peak_hand_force_N, chatter_N, energy_extracted_J,"
        " contacts, stops, last_swing_m",
        "what the touch was like",
    ),
    (
        "stored_at_start_J",
        "the most that the loop had stored at the start; or `stored_at_start_unknown`, why no bound is known",
    ),
    (
        "energy",
        "change of each over the touch (`hand_work_J`, `actuator_work_J`, `kinetic_energy_J`, "
        "`viscous_loss_J`, `coulomb_loss_J`; of the hand `hand_source_work_J`, `hand_kinetic_energy_J`, "
        "`hand_spring_energy_J`, `hand_damper_loss_J`), "
        "`energy_got_out_J`, `held_at_start_J` and what is beyond it, `energy_extracted_J` (both null where "
        "no bound is known), `energy_moved_J`, and by how much the two balances do not add up:"
        " `largest_residual_J`, `largest_hand_residual_J`",
    ),
    ("interrupted_at_s", "only after Ctrl-C"),
    ("diverged_at_s", "only if the motion grew beyond 10¹²⁰: the trace ends there"),
    ("zwidth_version", "that simulated"),
)
"""What stands in the summary of a touch, by key: the documentation's table."""


def pair_measures(trace: AnyTrace) -> dict[str, Any]:
    """What a trace of a pair is measured by, a unit in every key."""
    from zwidth.loop.energy import PairLedger
    from zwidth.loop.traces.measures import static_stiffness, tracking_error

    motion = str(trace.attrs["motion"])
    felt, apart = static_stiffness(trace.sel(arm="leader")), tracking_error(trace)
    return {
        GLOSSARY["stiffness"].key_for(motion).replace("stiffness", "felt_stiffness"): felt,
        GLOSSARY["position"].key_for(motion).replace("position", "tracking_error"): apart,
        "energy": PairLedger(trace).to_dict(),
    }
