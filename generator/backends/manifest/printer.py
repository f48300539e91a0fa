"""Print the description of a model as one JSON file, which `kintrafo.equations.Equations` reads."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import sympy as sp

from ....equations.directions import ADJOINTS, TANGENTS
from ...declare.ranges import described as parameters_of
from ..counting import OPERATIONS, operations_of
from ..text import formula
from ..words import ELEMENTARY, FORMULA, GENERATOR_VERSION, iteration_note, mechanism_hash
from .drawing import drawing

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...declare.inputs import Input
    from ...declare.mechanism import Mechanism
    from ...declare.parameters import Parameter
    from ...declare.shown import Level, Shown
    from ...declare.states import DeclaredStates, Entry
    from ...equations.outputs import Derivation
    from ...loops.planner import Transformer
    from ...program.function import Function, Stage

WIDTH = 100


def manifest(derivation: Derivation) -> str:
    """Return the text of the file."""
    return f"{_text(_facts(derivation), 0)}\n"


def _facts(derivation: Derivation) -> dict[str, Any]:
    topology = derivation.plan.topology
    name = derivation.formulation.name
    parts = dict.fromkeys(f.part for f in derivation.emitted.values())
    return {
        "name": name,
        "title": derivation.formulation.title,
        "written_by": f"kintrafo {GENERATOR_VERSION}; do not edit: `make generate` overwrites it",
        "mechanism": mechanism_hash(derivation),
        "note": iteration_note(derivation),
        "sources": [
            ELEMENTARY,
            f"{name}.h",
            *(f"{'_'.join(filter(None, (name, p)))}.c" for p in parts),
        ],
        "parameters": parameters_of(derivation.formulation.mechanism),
        "state": _described(derivation.state),
        "layout": _layout(derivation.states),
        "inputs": _inputs(derivation.inputs),
        "relative_coordinates": _described(derivation.relative),
        "signals": {
            s.name: _signal(derivation.formulation.mechanism, s) for s in derivation.signals
        },
        "bodies": derivation.moving_bodies,
        "massive_bodies": derivation.massive_bodies,
        "constants": derivation.prepare.labels,
        "guards": [
            {"name": g.name, "unit": g.unit, "meaning": g.meaning} for g in derivation.guards
        ],
        "assumptions": _assumptions(derivation),
        "held_variants": derivation.held_inputs,
        "prepare": {"operations": _counts(derivation.prepare)},
        "stages": {
            stage.name: {"doc": stage.doc, "size": stage.size, "operations": _counts(stage)}
            for stage in derivation.emitted.values()
            if stage.name not in derivation.functions
        },
        "functions": _functions(derivation),
        "mobility": topology.mobility,
        "numbers": topology.mechanism.numbers,
        "joints": [
            {
                "name": joint.name,
                "type": joint.kind,
                "bodies": joint.bodies,
                "freedoms": joint.freedoms,
                "common": joint.shared,
            }
            for joint in topology.mechanism.joints
        ],
        "drawing": drawing(topology.mechanism),
        "paths": topology.path_table(),
        "candidates": {
            "pairs": topology.pair_count,
            "closing": topology.closing_pairs,
            "cycles": len(topology.horton_candidates()),
        },
        "cycles": [
            {"bodies": cycle.bodies, "length": cycle.length} for cycle in topology.candidate_cycles
        ],
        "transformers": [_transformer(t) for t in derivation.plan.transformers],
    }


def _described(entries: Iterable[Entry]) -> dict[str, dict[str, str]]:
    return {e.name: {"unit": e.unit, "meaning": e.meaning} for e in entries}


def _layout(states: DeclaredStates) -> dict[str, Any]:
    """Return the sizes of the state, and the index of the speed that changes each position.

    It is null for the scalar part of a quaternion, and where constraints give the speed.
    """
    return {
        "positions": len(states.positions),
        "speeds": len(states.speeds),
        "speed_of": states.partners,
        "free": [states.positions.index(part.positions[0]) for part in states.free],
    }


def _signal(mechanism: Mechanism, shown: Shown) -> dict[str, Any]:
    """Return unit and meaning of a signal, its ranges and its events."""
    described: dict[str, Any] = {"unit": shown.unit, "meaning": shown.meaning}

    def level(of: Parameter | None) -> float | str | None:
        return _level(mechanism, of and of.symbol)

    if shown.ranges:
        described["ranges"] = [
            _given(
                least=_level(mechanism, limits.least),
                most=_level(mechanism, limits.most),
                below=limits.below,
                above=limits.above,
                possible=limits.possible,
                unless=level(limits.unless),
            )
            for limits in shown.ranges
        ]
    if shown.events:
        described["events"] = {
            event.name: _given(
                level=_level(mechanism, event.level),
                rising=event.rising,
                meaning=event.meaning,
                terminal=event.terminal,
                needs=level(event.needs),
            )
            for event in shown.events
        }
    return described


def _given(**facts: Any) -> dict[str, Any]:
    """Return the facts that have a value."""
    return {
        name: fact for name, fact in facts.items() if fact not in (None, "") and fact is not False
    }


def _level(mechanism: Mechanism, level: Level | None) -> float | str | None:
    """Return a number unchanged, and a parameter as its name, with a minus for a negative one.

    The parameters of a copy are those of its original.
    """
    if level is None or isinstance(level, float):
        return level
    sign, symbol = level.as_coeff_Mul()
    factor, root = sp.sympify(mechanism.derived.get(symbol.name, symbol)).as_coeff_Mul()
    assert sign * factor in (1, -1), level  # mirrors only turn round
    assert root.is_Symbol, level
    return f"{'-' if sign * factor < 0 else ''}{root.name}"


def _inputs(entries: Iterable[Input]) -> dict[str, dict[str, str | None]]:
    return {
        e.name: {
            "unit": e.unit,
            "meaning": e.meaning,
            "derivative_of": e.derivative_of and e.derivative_of.name,
        }
        for e in entries
    }


def _assumptions(derivation: Derivation) -> list[dict[str, str]]:
    """Return the checks of a parameter set, in their order."""
    zero = [
        {"quantity": str(a.quantity), "unit": a.unit, "meaning": a.meaning, "remedy": a.remedy}
        for a in derivation.assumptions
    ]
    not_zero = [
        {
            "quantity": str(c.quantity),
            "least": formula(c.least, FORMULA),
            "unit": c.unit,
            "meaning": c.meaning,
            "remedy": c.remedy,
        }
        for c in derivation.conditions
    ]
    return zero + not_zero


def _functions(derivation: Derivation) -> dict[str, dict[str, Any]]:
    """Return the description of every array, and of its function."""
    found = {}
    for emitted in derivation.emitted.values():
        start = 0
        for function in emitted.members:
            own: dict[str, Any] = {"operations": _counts(function)}
            if emitted.name != function.name:
                own = {"stage": emitted.name, "start": start}
            found[function.name] = _function(derivation, function) | own
            start += function.size
    return {name: found[name] for name in derivation.functions}


def _function(derivation: Derivation, function: Function) -> dict[str, Any]:
    places = {guard.name: place for place, guard in enumerate(derivation.guards)}
    rows, columns = _split(function.labels)
    described: dict[str, Any] = {"doc": function.doc, "shape": function.shape, "labels": rows}
    described |= {"by": columns} if columns else {}
    described |= {"part": function.part} if function.part in (TANGENTS, ADJOINTS) else {}
    described |= {"iterates": [b.name for b in function.blocks]} if function.blocks else {}
    return described | {"guards": sorted(places[guard.name] for guard in function.guards)}


def _split(labels: tuple[str, ...]) -> tuple[list[str], list[str]]:
    """Return the rows and the columns of a matrix of derivatives; for others, the labels alone."""
    pairs = [label.partition(" by ") for label in labels]
    rows = list(dict.fromkeys(row for row, _, _ in pairs))
    columns = list(dict.fromkeys(column for _, by, column in pairs if by))
    if [f"{row} by {column}" for row in rows for column in columns] == list(labels):
        return rows, columns
    return list(labels), []


def _counts(function: Function | Stage) -> dict[str, int]:
    counts = operations_of(function)
    return {"total": counts.total()} | {name: counts[name] for name in OPERATIONS}


def _transformer(transformer: Transformer) -> dict[str, Any]:
    closure, solution = transformer.step.words(transformer.closing)
    return {
        "bodies": transformer.cycle.bodies,
        "length": transformer.cycle.length,
        "inputs": transformer.inputs,
        "outputs": transformer.outputs,
        "equation": closure,
        "solution": solution,
        "pairs": [
            {
                "joints": [joint.name for joint in pair.joints],
                "eliminated": pair.eliminated,
                "equations": pair.equations,
                "chosen": pair == transformer.pair,
            }
            for pair in transformer.candidates
        ],
    }


def _text(value: Any, indent: int) -> str:
    """Return JSON text: a value that fits into a line is in one."""
    line = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, dict | list | tuple) or indent + len(line) <= WIDTH:
        return line
    pad = " " * (indent + 1)
    if isinstance(value, dict):
        items = [f"{pad}{json.dumps(k)}: {_text(v, indent + 1)}" for k, v in value.items()]
        return "{\n" + ",\n".join(items) + f"\n{' ' * indent}}}"
    lines = [""]
    for item in (_text(element, indent + 1) for element in value):
        alone = "\n" in item or "{" in item
        if lines[-1] and (alone or len(pad) + len(lines[-1]) + len(item) + 2 > WIDTH):
            lines.append("")
        lines[-1] += f" {item}," if lines[-1] else f"{item},"
    body = f"\n{pad}".join(lines).rstrip(",")
    return f"[\n{pad}{body}\n{' ' * indent}]"
