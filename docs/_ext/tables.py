"""Tables of the documentation, written from the registries that the code itself reads."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path

import cables
import chips
import papers
import trust

from zwidth import catalogue
from zwidth.checker.document.fields import Either, Field, List, OneOf, Record
from zwidth.checker.kinds import KINDS, fields_of
from zwidth.cli.commands import COMMANDS, configure
from zwidth.cli.options import (
    CONTACT,
    FORCE,
    IN_FULL,
    LAW,
    coupling_parameters,
    device_parameters,
    environment_parameters,
)
from zwidth.cli.parsing import Helping, Parameter
from zwidth.data.gains.plant import plants as published_plants
from zwidth.model.kind import Kind
from zwidth.model.operator import OPERATORS
from zwidth.model.rendering import ESTIMATORS, LAWS
from zwidth.model.specification import load as pairs
from zwidth.model.specification.environments import TYPES, all_keys
from zwidth.quantity.answered import declared
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.study.bench.bench import SCORES

GENERATED = Path(__file__).parent.parent / "_generated"


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def glossary() -> str:
    """Every quantity: symbol, name, unit, meaning."""
    return markdown(
        ("name", "symbol", "unit", "unit if rotary", "meaning"),
        [
            (f"`{q.name}`", q.symbol, _unit(q.unit), _unit(q.rotary_unit), q.meaning)
            for q in GLOSSARY.values()
        ],
    )


def device_options() -> str:
    """The parameters of a device, as options of the command line."""
    return _options(device_parameters())


def environment_options() -> str:
    """The parameters of all environments, as options of the command line."""
    return _options(environment_parameters())


def operator_options() -> str:
    """The hands and their numbers, as options of the command line."""
    from zwidth.cli.simulate.tables import operator_parameters

    return _options(operator_parameters())


def follower_options() -> str:
    """What holds the follower of a pair, as options of the command line."""
    from zwidth.cli.simulate.tables import follower_parameters

    return _options(follower_parameters())


def connection_options() -> str:
    """How a device is reached, as options of the command line."""
    from zwidth.cli.machine.serve_tables import connection_parameters

    return _options(connection_parameters())


SHARED = {
    words.partition(" > ")[0].removesuffix("..."): meaning
    for words, meaning in {**LAW, **CONTACT, **IN_FULL, **FORCE}.items()
}
"""Options of several commands, told once."""


def shared_options() -> str:
    """What several commands take in the same words."""
    takes = {name: [own for action in _actions(name) if (own := _shared(action))] for name in COMMANDS}
    rows = []
    for words, meaning in SHARED.items():
        option = words.split()[0]
        commands = ", ".join(f"`{name}`" for name, options in takes.items() if option in options)
        rows.append((f"`{words}`", _in_a_row(meaning), "all that write" if option == "--force" else commands))
    return markdown(("option", "meaning", "commands"), rows)


def options_of(command: str) -> str:
    """What a command takes besides the parameters and options that others have too, as its parser has it."""
    elsewhere = {(one.option, one.help) for table in _parameter_tables(command) for one in table()}
    rows = [
        (_typed(action), _in_a_row(action.help or ""))
        for action in _actions(command)
        if not _shared(action)
        if not any((option, action.help) in elsewhere for option in action.option_strings)
    ]
    return markdown(("option", "meaning"), rows)


def _actions(command: str) -> list[argparse.Action]:
    parser = argparse.ArgumentParser(add_help=False)
    configure(command, parser)
    seen = [a for a in parser._actions if a.help != argparse.SUPPRESS and not isinstance(a, Helping)]
    for action in seen:
        action.help = (action.help or "").replace("%%", "%")
    return seen


def _shared(action: argparse.Action) -> str:
    """The name of an option that means the same in several commands, else none."""
    for words, meaning in SHARED.items():
        option = words.split()[0]
        if option in action.option_strings and (option == "--force" or meaning == action.help):
            return option
    return ""


def _typed(action: argparse.Action) -> str:
    if not action.option_strings:
        return f"`{action.metavar}`"
    value = f" {action.metavar}" if action.metavar else ""
    return ", ".join(f"`{option}{value}`" for option in sorted(action.option_strings, reverse=True))


def _in_a_row(text: str) -> str:
    """A help text with the options in it as code."""
    return re.sub(r"(?<![\w-])--?[a-z][\w.-]*", r"`\g<0>`", _pretty(text).replace("|", "\\|"))


def _parameter_tables(command: str) -> list[Callable[[], Iterable[Parameter]]]:
    """What those tables of parameters are made of that stand in the section of a command, or before all."""
    from zwidth.cli.machine.serve_tables import connection_parameters, safety_parameters
    from zwidth.cli.pair.links import link_parameters
    from zwidth.cli.simulate.tables import follower_parameters, operator_parameters, simulation_parameters

    of_a_touch = [operator_parameters, follower_parameters, simulation_parameters]
    own = {
        "pair": [coupling_parameters],
        "links": [link_parameters],
        "simulate": of_a_touch,
        "serve": [*of_a_touch, connection_parameters, safety_parameters],
        "sweep": [*of_a_touch, coupling_parameters],
    }
    return [device_parameters, environment_parameters, *own.get(command, [])]


def connection_keys() -> str:
    """Every connection, with the keys of its table."""
    from zwidth.machine.servo.devices.registry import CONNECTIONS

    rows = []
    for name, way in CONNECTIONS.items():
        optional = ", ".join(f"`{key}`" for key in way.keys if key not in way.needed)
        rows.append((f"`{name}`", way.meaning, ", ".join(f"`{key}`" for key in way.needed), optional))
    return markdown(("type", "what it reaches", "needs", "may have"), rows)


def settings(name: str) -> str:
    """What can change sign, size or end of a connection's force, and what is done about it."""
    from zwidth.machine.servo.devices.registry import CONNECTIONS

    made = CONNECTIONS[name].made
    rows = [
        (
            f"`{name}`" + (f": {delivered} as delivered" if delivered else ""),
            f"{effect} ({place})" if place else effect,
            done,
        )
        for name, delivered, effect, done, place in (
            (cell.replace("|", "\\|") for cell in row) for row in made.settings
        )
    ]
    head = ("setting", "what it does to the force", "what is done")
    return f"By {made.maker}.\n\n{markdown(head, rows)}"


def safety_options() -> str:
    """The limits of what a hand is given, as options of the command line."""
    from zwidth.cli.machine.serve_tables import safety_parameters

    return _options(safety_parameters())


def simulation_options() -> str:
    """How a simulation is run, as options of the command line."""
    from zwidth.cli.simulate.tables import simulation_parameters

    return _options(simulation_parameters())


def device_keys() -> str:
    """Every key that a device table may have."""
    rows = [(f"`{p.key}`", _pretty(p.help)) for p in device_parameters()]
    return markdown(("key", "meaning"), rows)


def coupling_keys() -> str:
    """Every key that a coupling table may have, with its unit."""
    rows = [(f"`{name}`", _unit(key.unit_for("linear")), key.meaning) for name, key in pairs.KEYS.items()]
    return markdown(("key", "unit", "meaning"), rows)


def coupling_options() -> str:
    """What joins two arms, as options of the command line."""
    rows = [(f"`{p.option}`", p.metavar, _pretty(p.help)) for p in coupling_parameters()]
    return markdown(("option", "symbol", "meaning"), rows)


def link_options() -> str:
    """What a link does to packets, as options of the command line."""
    from zwidth.cli.pair.links import link_parameters

    rows = [(f"`{p.option}`", _pretty(p.help)) for p in link_parameters()]
    return markdown(("option", "meaning"), rows)


def environment_types() -> str:
    """Every type of environment with its keys in a specification."""
    rows = []
    for name, kind in TYPES.items():
        needed = ", ".join(f"`{k}`" for k, v in kind.keys.items() if v.required)
        optional = ", ".join(f"`{k}`" for k, v in kind.keys.items() if not v.required)
        rows.append((f"`{name}`", f"{{class}}`zwidth.{kind.class_name}`", kind.meaning, needed, optional))
    table = markdown(("type", "class", "what it is", "needs", "may have"), rows)
    return table.replace("{class}", "{py:class}")


def environment_keys() -> str:
    """Every key that an environment table may have, with its unit."""
    rows = [(f"`{name}`", _unit(key.unit_for("linear")), key.meaning) for name, key in all_keys().items()]
    return markdown(("key", "unit", "meaning"), rows)


def law_types() -> str:
    """Every law in a chain, and what it does."""
    rows = [
        (f"`{name}`", f"{{class}}`zwidth.rendering.{law.class_name}`", law.meaning)
        for name, law in LAWS.items()
    ]
    return markdown(("name", "class", "what it is"), rows).replace("{class}", "{py:class}")


def law_keys() -> str:
    """Every key of every law, with its unit."""
    return _law_keys("law", LAWS)


def velocity_keys() -> str:
    """Every key of the velocities of laws."""
    return _law_keys("velocity", ESTIMATORS)


def _law_keys(what: str, laws: Mapping[str, Kind]) -> str:
    rows = []
    for name, law in laws.items():
        for key, kind in law.keys.items():
            needed = "; needed" if kind.required else ""
            rows.append((f"`{name}`", f"`{key}`", _unit(kind.unit_for("linear")), kind.meaning + needed))
        if not law.keys:
            rows.append((f"`{name}`", "", "", "no keys"))
    return markdown((what, "key", "unit", "meaning"), rows)


def devices() -> str:
    """The catalogue: every device, every value, every source."""
    return "\n".join(_device(name) for name in catalogue.names())


def _device(name: str) -> str:
    entry = catalogue.entry(name)
    rows = [
        (
            f"`{key}`",
            "unknown" if datum.value is None else f"{float(datum.value):.6g}",
            "" if datum.value is None else _unit(datum.unit),
            datum.source.removeprefix("unknown: "),
        )
        for key, datum in entry.values.items()
    ]
    note = f"{entry.note}\n\n" if entry.note else ""
    table = markdown(("value", "", "unit", "source"), rows)
    return f"## `{name}`: {entry.title}\n\n{note}{table}{_ranges(entry)}"


def _ranges(entry: catalogue.Entry) -> str:
    """What is stated in the place of unknown values."""
    rows = [
        (f"`{key}`", f"{float(own.low):.4g} … {float(own.high):.4g}", _unit(own.unit), own.why)
        for key, own in entry.ranges.items()
    ]
    return f"\nStated, not measured:\n\n{markdown(('range', '', 'unit', 'why'), rows)}" if rows else ""


def plants() -> str:
    """Published damping and friction of arms whose gain files are read."""
    rows = []
    for name, plant in published_plants().items():
        numbers = [(f"joint {n + 1}", *values) for n, values in enumerate(plant.joints)]
        numbers += [(motor, *values) for motor, values in plant.motors.items()]
        for place, damping, friction in numbers:
            rows.append((f"`{name}`", place, f"{float(damping):.4g}", f"{float(friction):.4g}"))
    sources = "\n".join(f"- `{name}`: {plant.source}" for name, plant in published_plants().items())
    table = markdown(("plant", "of", "damping [N·m·s/rad]", "Coulomb friction [N·m]"), rows)
    return f"{table}\n{sources}\n"


ANSWERS = {
    "activity": "passivity.stability.active_hand:ToleratedActivity",
    "change": "data.diagnosis.change:Lowered",
    "checkup": "machine.servo.checkup:Checkup",
    "diagnosis": "data.diagnosis.result:Diagnosis",
    "finding": "machine.servo.checkup:Finding",
    "emitted": "machine.firmware.emit:Emitted",
    "gains": "data.gains.verdict:GainsVerdict",
    "held_joints": "data.gains.held_joints:HeldJoints",
    "held_pair": "passivity.pairs.held.verdict:HeldVerdict",
    "identified": "data.identification.device.numbers:IdentifiedNumbers",
    "joint_gains": "data.gains.joint:JointGains",
    "joint_verdict": "data.gains.verdict:JointVerdict",
    "lateness": "machine.servo.lateness:Lateness",
    "laws": "study.bench.comparison:LawComparison",
    "limit": "passivity.bracket.bracket:Bracket",
    "link": "machine.network.peer:LinkReport",
    "links": "links.comparison:LinkComparison",
    "measured": "machine.servo.proving:Measured",
    "null_space": "passivity.workspace.null_space:NullSpace",
    "pair": "passivity.pairs.verdict:PairVerdict",
    "peer": "machine.network.peer:PeerReport",
    "postures": "passivity.workspace.postures:PostureMap",
    "ranges": "passivity.interval_devices:OverRanges",
    "real_hand": "passivity.finite_stiffness:FiniteStiffnessReplay",
    "recorded": "machine.servo.recording.recorder:Recorded",
    "recording": "machine.servo.recording.recording:Recording",
    "scope": "passivity.scope:Scope",
    "served": "machine.servo.report:ServoReport",
    "served_pair": "machine.servo.report:PairServoReport",
    "served_port": "machine.servo.report:PortReport",
    "shaking_hand": "passivity.stability.shaking_hand:ShakingHand",
    "simulated": "cli.simulate.simulate:BESIDES",
    "stability": "passivity.stability.known_hand:Stability",
    "stiffness_at": "passivity.pairs.limits:StiffnessAt",
    "stiffness_cost": "machine.servo.lateness:StiffnessCost",
    "tissue": "data.tissue.result:TissueFit",
    "tissue_test": "data.tissue.experiment.result:TissueTest",
    "verdict": "passivity.linear_verdict:LinearVerdict",
    "workspace": "passivity.workspace.verdict:Workspace",
}
"""Results whose keys a page lists: where each is declared."""


def answer(where: str) -> str:
    """Every key of a result's plain data, and what it is; units are those of a linear device."""
    module, _, name = where.partition(":")
    kind = getattr(import_module(f"zwidth.{module}"), name)
    rows = [("`format`", f'`"{kind._FORMAT}"`')] if getattr(kind, "_FORMAT", "") else []
    for name, one in ({} if isinstance(kind, tuple) else declared(kind)).items():
        if not one.only_shown:
            keys = one.stands_as or [one.key_for(name, "linear")]
            parts = f": {', '.join(f'`{part}`' for part in one.names)}" if one.names else ""
            rows.append((", ".join(f"`{key}`" for key in keys), _in_a_cell(one.meaning) + parts))
    besides = kind if isinstance(kind, tuple) else getattr(kind, "_BESIDES", ())
    rows += [(f"`{keys.replace(', ', '`, `')}`", meaning.replace("|", "\\|")) for keys, meaning in besides]
    return markdown(("key", "value"), rows)


def evidence_keys() -> str:
    """Every object in a document that the checker reads: its entries, and the kinds that have it."""
    names: dict[str, list[str]] = {}
    kinds: dict[str, list[str]] = {}
    for kind in KINDS:
        for name, entries in _objects(fields_of(kind), "the document"):
            names.setdefault(entries, []).append(name)
            kinds.setdefault(entries, []).append(kind)
    order = list(dict.fromkeys(own[0] for own in names.values()))
    rows = [
        (", ".join(dict.fromkeys(own)), entries, ", ".join(dict.fromkeys(kinds[entries])))
        for entries, own in sorted(names.items(), key=lambda one: order.index(one[1][0]))
    ]
    return markdown(("object", "entries", "of kind"), rows)


def _objects(field: Field, name: str) -> Iterator[tuple[str, str]]:
    """Each object with entries besides its kind, by the name it stands under; the optional in brackets."""
    if isinstance(field, Record):
        own = {key: one for key, one in field.fields.items() if key not in ("format", "kind")}
        told = {key: f"`{one.key(key, 'linear')}`" for key, one in own.items()}
        if told:
            yield name, ", ".join(told[key] if one.required else f"[{told[key]}]" for key, one in own.items())
        for key, one in own.items():
            if key != "reduced":  # a document itself
                yield from _objects(one, f"`{key}`")
    inside = {List: ["of"], Either: ["first", "second"]}.get(type(field), [])
    cases = list(field.cases.values()) if isinstance(field, OneOf) else []
    for part in [*(getattr(field, one) for one in inside), *cases]:
        yield from _objects(part, name)


def bench_scores() -> str:
    """What each law is given for on the bench."""
    rows = [(f"`{_key(name, own.unit)}`", f"{own.meaning} ({own.touch})") for name, own in SCORES.items()]
    return markdown(("key", "meaning"), rows)


def _key(name: str, unit: str) -> str:
    return name if unit == "1" else f"{name}_{unit_suffix(unit)}"


def _in_a_cell(meaning: str) -> str:
    """In the words of a file: what a docstring says too."""
    text = re.sub(r" \[[^]]*\](?!\()", "", meaning)
    for python, name in (("None", "null"), ("True", "true"), ("False", "false")):
        text = re.sub(rf"\b{python}\b", name, text)
    return text.replace("|", "\\|")


def _options(parameters: Iterable[Parameter]) -> str:
    rows = [(f"`{p.option}`", f"`{p.key}`", _pretty(p.help)) for p in parameters]
    return markdown(("option", "key in a file", "meaning"), rows)


def _unit(unit: str) -> str:
    return "" if unit == "1" else _pretty(unit)


def _pretty(text: str) -> str:
    return text.replace("*", "·").replace("^2", "²")


def hand_numbers() -> str:
    """What every hand that has a name does, and its numbers."""
    rows = []
    for name, kind in OPERATORS.items():
        hand = kind()
        numbers = [
            f"`{key}` {getattr(hand, key):.6g} {_pretty(q.unit_for(kind.motion))}"
            for key, q in kind.parameters().items()
        ]
        does = (kind.__doc__ or "").partition("\n")[0]
        rows.append((f"`{name}`", does, "; ".join(numbers) or "none"))
    return markdown(("hand", "what it does", "numbers"), rows)


def lines_to_trust() -> str:
    """How many lines of the checker stand behind each kind of document."""
    head = ("kind of document", "files", "lines", "needs")
    return markdown(head, [*trust.rows(), ("all of them", "", str(trust.total()), "")])


def chip_costs() -> str:
    """What a step of an emitted law costs on small chips."""
    return chips.costs(markdown)


def cable_limits() -> str:
    """The stiffest wall against the stiffness of a cable."""
    return cables.table(markdown)


def papers_by_figure() -> str:
    """Every figure and table of the founding papers, beside what is computed now."""
    return papers.page(markdown)


TABLES: dict[str, Callable[[], str]] = {
    "bench_scores": bench_scores,
    "cable_limits": cable_limits,
    "chip_costs": chip_costs,
    "connection_keys": connection_keys,
    "connection_options": connection_options,
    "safety_options": safety_options,
    "coupling_keys": coupling_keys,
    "coupling_options": coupling_options,
    "device_keys": device_keys,
    "device_options": device_options,
    "devices": devices,
    "environment_keys": environment_keys,
    "environment_options": environment_options,
    "law_keys": law_keys,
    "law_types": law_types,
    "lines_to_trust": lines_to_trust,
    "link_options": link_options,
    "operator_options": operator_options,
    "papers_by_figure": papers_by_figure,
    "plants": plants,
    "follower_options": follower_options,
    "shared_options": shared_options,
    "simulation_options": simulation_options,
    "environment_types": environment_types,
    "evidence_keys": evidence_keys,
    "glossary": glossary,
    "hand_numbers": hand_numbers,
    "velocity_keys": velocity_keys,
}


def generated() -> dict[str, Callable[[], str]]:
    """Every table, by the name of its file."""
    from zwidth.machine.servo.devices.registry import CONNECTIONS

    return (
        TABLES
        | {f"settings_{name}": partial(settings, name) for name in CONNECTIONS}
        | {f"options_{name}": partial(options_of, name) for name in COMMANDS}
        | {f"answer_{name}": partial(answer, where) for name, where in ANSWERS.items()}
    )


def write() -> None:
    """Write every table where the pages include it; leave an unchanged one alone."""
    GENERATED.mkdir(exist_ok=True)
    for name, table in generated().items():
        path, text = GENERATED / f"{name}.md", table()
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
