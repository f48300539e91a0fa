"""A rigid axle on its bushes, as a caller describes them, held by the road."""

from typing import Any

import numpy as np
import xarray as xr

from ...assembly.anti_roll_bar import RollBar
from ...assembly.beam import SIDES
from ...assembly.parts import Parts
from ...core.arguments import Arguments
from ...core.quantities import variable
from ...suspension.bushes import described_bushings
from ...suspension.corner import Array
from ...suspension.rigid.axle import RigidAxle
from ...suspension.rigid.model import RigidAxleModel
from ...suspension.rigid.structure import BEAM
from ..loads.elastic.connections import Soft
from ..loads.elastic.equilibrium import Equilibrium, State
from ..loads.elastic.held import Hardpoints, carried_at

RIGID = Soft({}, 0.0, {})


def soft_of(given: Arguments, axle: RigidAxle, bushings: Any, hardpoints: Hardpoints) -> Soft:
    """Read what gives way, and what it carries at the hardpoints."""
    if given.refused:
        return RIGID
    bushes = axle.bushes(given, described_bushings(given, bushings, axle.bushings))
    if not bushes and not given.refused:
        given.refuse("bushings: one or more are needed.")
    if axle.tyre_radius() is None:
        given.refuse("[tyre] radius_mm is needed: where the road touches the wheels.")
    carried = {}
    if hardpoints == "loaded" and not given.refused:
        # the bar is free of torque there
        at_design = parts_at(guided(axle), np.zeros(1), np.zeros(1))
        carried = dict(carried_at(at_design, bushes=bushes))
    return Soft({bush.point: bush for bush in bushes}, 0.0, carried)


def guided(axle: RigidAxle) -> RigidAxleModel:
    """Return the equations from which an equilibrium on bushes begins."""
    return RigidAxleModel(axle, guided=axle.overheld)


def parts_at(model: RigidAxleModel, left: Array, right: Array) -> Parts:
    """Return the parts with rigid joints, the wheels at some travels [m]."""
    return Parts.of(model, model.states_at(left, right))


def axle_on(parts: Parts, soft: Soft) -> Equilibrium:
    """Return an axle on its bushes where it is with rigid joints."""
    bar = None
    if parts.axle.anti_roll_bar is not None:
        bar = RollBar(BEAM, parts.model.parameters["bar_rate"])
    return Equilibrium([(parts, soft)], bar)


def torque_of_bar(
    suspensions: list[Equilibrium], states: list[State], dims: str | tuple[str, ...]
) -> xr.Variable:
    """Return the torque of the anti-roll bar in some equilibria."""
    torque = [one.torque_of_bar(state) for one, state in zip(suspensions, states, strict=True)]
    values = np.concatenate(torque) if isinstance(dims, str) else np.stack(torque)
    words = "torque of the anti-roll bar, positive with the left wheel up"
    return variable(dims, values, words, "N m")


def place_of(suspension: Equilibrium, state: State) -> dict[str, Array]:
    """Return where the line through the wheel centres is: its steer angle and middle, (n,)."""
    left, right = (suspension.center(state.places, which) for which in range(len(SIDES)))
    line, middle = left - right, 0.5 * (left + right)
    start = np.mean([wheel.design_center for wheel in suspension.wheels], axis=0)
    return {
        "axle_steer": np.arctan2(-line[:, 0], line[:, 1]),
        "axle_lateral": middle[:, 1] - start[1],
        "axle_longitudinal": middle[:, 0] - start[0],
    }
