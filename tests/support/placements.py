"""Only the positions of the bodies of a model: over NumPy arrays, and quickly derived."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from kintrafo.equations.following import follow_turns
from kintrafo.generator import Formulation
from kintrafo.generator.backends import arrays
from kintrafo.generator.backends.numpy.dialect import NUMPY
from kintrafo.generator.backends.words import blocks_of
from kintrafo.generator.equations.in_motion import InMotion
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.generator.program import ConstantStage, Program
from kintrafo.generator.program.vectors import UNIT_X, UNIT_Y, UNIT_Z, from_axes, to_axes


@dataclass(frozen=True)
class Placements:
    """The positions of a model's moving bodies, as its emitted code computes them.

    Attributes
    ----------
    names
        Symbols of the driven coordinates, in the order of the independent and prescribed joints.
    """

    model: Formulation
    names: tuple[str, ...]
    _prepare: Any
    _places: Any
    _constants: tuple[str, ...]

    @classmethod
    def of(cls, model):
        """Derive them; those of a name once."""
        if model.name not in _DERIVED:
            _DERIVED[model.name] = cls._derived(model)
        return _DERIVED[model.name]

    @classmethod
    def _derived(cls, model):
        plan = CataloguePlan.of(model)
        symbols = tuple(sp.Symbol(p.name) for p in model.mechanism.parameters)
        constants = ConstantStage(symbols)
        program = Program(constants)
        kin = InMotion.of(program, plan)
        places = {}
        for body in model.mechanism.bodies[1:]:
            placed = kin.placed[body.name]
            part = kin.part_of[body.name]
            at = part.to_ground(part.position(placed, body.center)) + part.work_origin
            places |= {f"{body.name} {i}": value for i, value in enumerate(at)}
            for j, e in enumerate((UNIT_X, UNIT_Y, UNIT_Z)):
                carried = from_axes(placed.axes, to_axes(placed.design_axes, part.to_work(e)))
                places |= {
                    f"{body.name} {i}{j}": value for i, value in enumerate(part.to_ground(carried))
                }
        guards = {guard.name: guard.margin for guard in program.guards.values()}
        function = program.function("places", "", places | guards)
        prepare = constants.function([function])
        names = tuple(str(kin.coordinates.symbols[kin.coordinates.of(j)]) for j in model.driven)
        source = _printed(function, prepare, [str(s) for s in symbols], list(names))
        found = {"follow_turns": follow_turns}
        exec(source, found)
        return cls(model, names, found["prepare"], found["places"], prepare.labels)

    def at(self, parameters, coordinates):
        """Return whether positions are answered, and places and orientations of all bodies.

        Parameters
        ----------
        coordinates
            A row for each position.
        """
        given = np.array([parameters[p.name] for p in self.model.mechanism.parameters])
        with np.errstate(all="ignore"):
            constants, _ = self._prepare(given)
            if not np.isfinite(constants).all():
                message = "no constants"
                raise ArithmeticError(message)
            results, _ = self._places(np.array(constants), coordinates)
        count, bodies = len(coordinates), len(self.model.mechanism.bodies) - 1
        values = np.array([np.broadcast_to(value, count) for value in results]).T
        poses, margins = np.split(values, [12 * bodies], axis=1)
        poses = poses.reshape(count, bodies, 12)
        rotations = poses[..., 3:].reshape(count, bodies, 3, 3).swapaxes(-1, -2)
        answered = np.isfinite(values).all(axis=1) & (margins > 0.0).all(axis=1)
        return answered, poses[..., :3], rotations


_DERIVED = {}


def _printed(function, prepare, parameters, names):
    """Return the text of both functions and of the iterations that they call."""
    read = {s.name for s in function.free_symbols}
    loads = [f"{n} = constants[{i}]" for i, n in enumerate(prepare.labels) if n in read]
    loads += [f"{n} = coordinates[:, {i}]" for i, n in enumerate(names) if n in read]
    texts = [
        "import numpy as np",
        "from kintrafo.equations.following import follow_turns",
        *arrays.printed_blocks(blocks_of([function]), NUMPY),
        arrays.definition(
            prepare, "parameters", arrays.loaded("parameters", parameters, prepare, NUMPY), NUMPY
        ),
        arrays.definition(function, "constants, coordinates", loads, NUMPY),
    ]
    return "\n\n\n".join(texts)
