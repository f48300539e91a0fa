"""Equilibria of wheels on bushes under loads of a rig, of any size."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
import xarray as xr

from ....core.memory import positions_given
from ....core.named_types import Array, ArrayLike
from ....core.quantities import attributes
from ....core.validator import Validator
from ...assembly.assembly import HeldAssembly
from ...assembly.of import given_assembly
from ...assembly.part_poses import CENTER
from ...corner.corner import RoadWheel
from ...models.reach import PositionError
from .connections import CompliantJoints
from .equilibrium import ElasticEquilibrium, ElasticState
from .flexibility import HELD, WheelSupport, refuse_without_rate
from .on_bushes import HARDPOINTS, Hardpoints, at_height, on_joints, softs_of
from .rig_loads import BY_NAME, RigLoad, give_of_tyre, load_at_contact, loadings

LOAD = "load"
"""Dimension of the amounts of the load."""

WHEELS = {
    "parallel": "both wheels, in one direction",
    "opposed": "both wheels, oppositely",
    "left": "the left wheel",
    "right": "the right wheel",
}
"""Loaded wheels of an axle."""

_PARALLEL = "parallel"
_GREATEST = 1e6
# A tyre slides before it deflects this far [m].
_FARTHEST_TYRE = 0.2
# The smallest step of a load, as a part of it.
_LEAST_STEP = 1e-3


@dataclass(frozen=True)
class WheelsUnderLoad:
    """An assembly on bushes with a load on its wheels."""

    assembly: HeldAssembly
    under: str  # name of the load, see `rig_loads.BY_NAME`
    amounts: Array  # of the load, (m,) [N or N m]
    wheels: str | Sequence[float] | None  # the loaded wheels of an axle, see `nonlinear`
    rack_position: float  # [m]
    held: WheelSupport  # support of each wheel, see `linear`
    hardpoints: Hardpoints  # see `elastokinematics`
    parts: tuple[float, ...]  # factors of the load on the wheels
    softs: Mapping[str, CompliantJoints]  # by the suffixes of their parts

    @classmethod
    def given(
        cls,
        given: Validator,
        subject: Any,
        bushings: Mapping[str, Any] | None,
        under: str,
        amounts: ArrayLike,
        *,
        wheels: str | Sequence[float] | None,
        rack_position: float,
        held: WheelSupport,
        hardpoints: Hardpoints,
    ) -> Self:
        """Return an assembly with its load, or add errors."""
        assembly = given_assembly(given, subject)
        given.among("under", under, BY_NAME)
        given.among("held", held, HELD)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        rack_position = given.number("rack_position", rack_position, "m")
        wanted = positions_given(given, "amounts", amounts, "N or N m")
        if not (np.abs(wanted) <= _GREATEST).all():
            given.fail(f"amounts: numbers of {_GREATEST:g} N or N m or less are needed.")
        parts: tuple[float, ...] = ()
        if not given.failed:
            assembly.refuse_holding(given, assembly.usual_motion, 0.0, rack_position)
            parts = _parts_of(given, assembly, under, wheels)
        softs = softs_of(given, assembly, bushings, hardpoints)
        if not given.failed:
            refuse_without_rate(given, held, *assembly.tyres)
        return cls(assembly, under, wanted, wheels, rack_position, held, hardpoints, parts, softs)

    @cached_property
    def load(self) -> RigLoad:
        """The load, with words that name the loaded wheels."""
        words = _words_of(self.under, self.wheels, self.parts)
        return replace(BY_NAME[self.under], words=words)

    @property
    def described(self) -> dict[str, str]:
        """The support of the wheels and the meaning of the hardpoints, as attributes of results."""
        return {"held": HELD[self.held], "hardpoints": HARDPOINTS[self.hardpoints]}

    def equilibria(
        self, travels: Array
    ) -> tuple[ElasticEquilibrium, ElasticState, list[ElasticState]]:
        """Return the equations of equilibrium, the state without the load, and those under it.

        Travels, (n,), are those of wheel centres with rigid joints [m]; each amount of the load
        has a state in n positions.
        """
        poses = self.assembly.poses(self.assembly.at_travel(travels, self.rack_position))
        suspension = on_joints(self.assembly, poses, self.softs)
        base = at_height(suspension, travels)
        of_each = zip(self.parts, suspension.wheels, strict=True)
        unit = np.stack([part * unit_load(self.load, wheel) for part, wheel in of_each], axis=1)
        return suspension, base, self._under_amounts(suspension, base, unit)

    def _under_amounts(
        self, suspension: ElasticEquilibrium, base: ElasticState, unit: Array
    ) -> list[ElasticState]:
        """Return the equilibria under the amounts of the load, each found from a smaller one."""
        wanted = self.amounts
        _refuse_on_tyres(suspension, self.load, wanted)
        found: dict[float, ElasticState] = {}
        for sense in (1.0, -1.0):
            state, at = base, 0.0
            for amount in sorted({a for a in wanted.tolist() if sense * a >= 0.0}, key=abs):
                state = self._towards(suspension, base, state, (at, amount), unit)
                at, found[amount] = amount, state
        states = [found[amount] for amount in wanted.tolist()]
        _refuse_beyond(suspension, states, self.load, wanted)
        return states

    def _towards(
        self,
        suspension: ElasticEquilibrium,
        base: ElasticState,
        state: ElasticState,
        amounts: tuple[float, float],
        unit: Array,
    ) -> ElasticState:
        """Return the equilibrium under one amount of the load from that under another, in steps."""
        at, end = amounts
        step = end - at
        while at != end:
            to = end if abs(step) >= abs(end - at) else at + step
            there = suspension.under(to * unit, self.held, state, base)
            if there.found.all():
                state, at, step = there, to, 2.0 * step
                continue
            step *= 0.5
            if abs(step) <= _LEAST_STEP * abs(end):
                raise PositionError(
                    f"no stable equilibrium was found under {self.load.words} of more than "
                    f"{at:.4g} {self.load.unit}: the bushes do not hold the linkage. Use smaller "
                    "loads or stiffer bushes."
                )
        return state


def load_coordinate(load: RigLoad, amounts: Array) -> xr.Variable:
    """Return the coordinate of results over a load."""
    words = load.words.partition(" ")[2]
    shown = {"display_units": "kN", "display_factor": 1e-3} if load.unit == "N" else {}
    return xr.Variable(LOAD, amounts, attributes(words, load.unit) | shown)


def _parts_of(
    given: Validator, assembly: HeldAssembly, under: str, wheels: Any
) -> tuple[float, ...]:
    """Return the factors of a load on the wheels."""
    factors = {how.name: how.parts for how in loadings(BY_NAME[under], assembly.wheels)}
    if len(assembly.wheels) == 1:
        if wheels is not None:
            given.fail("wheels: a corner has one wheel. Leave it out, or give an axle.")
        return factors[""]
    if wheels is None or isinstance(wheels, str):
        for which, wheel in enumerate(assembly.wheels):
            factors[wheel] = tuple(np.eye(len(assembly.wheels))[which].tolist())
        given.among("wheels", wheels or _PARALLEL, WHEELS)
        return factors.get(wheels or _PARALLEL, ())
    both = given.array("wheels", wheels, "1", dimensions=[1])
    if both.shape != (len(assembly.wheels),) or not (np.abs(both) <= 1.0).all():
        given.fail("wheels: two numbers from -1 to 1 are needed, of the left and right wheel.")
    return tuple(both.tolist())


def _words_of(under: str, wheels: str | Sequence[float] | None, parts: Sequence[float]) -> str:
    """Return a load on some wheels in words."""
    load = BY_NAME[under]
    for how in loadings(load, parts):
        if how.name == (wheels or _PARALLEL) or not how.name:
            return how.title(load)
    if isinstance(wheels, str):
        return f"{load.words} of {WHEELS[wheels]}"
    left, right = parts
    return f"{how.title(load).rpartition(', ')[0]}, {left:g} of it left and {right:g} right"


def unit_load(load: RigLoad, on_road: RoadWheel) -> Array:
    """Return a load of 1 N or 1 N m for `ElasticEquilibrium.under`, (n, 9)."""
    at_contact = load_at_contact(load, on_road)
    force, still = at_contact[:, :3], np.zeros((len(at_contact), 3))
    if load.at == CENTER:
        return np.concatenate([still, still, force], axis=1)
    return np.concatenate([at_contact, still], axis=1)


def _refuse_on_tyres(suspension: ElasticEquilibrium, load: RigLoad, wanted: Array) -> None:
    """Raise an error for loads with an impossible deflection of the stationary tyre."""
    soft = max(float(give_of_tyre(load, wheel) or 0.0) for wheel in suspension.wheels)
    worst = float(wanted[np.abs(wanted).argmax()]) if wanted.size else 0.0
    if abs(worst) * soft > _FARTHEST_TYRE:
        raise PositionError(
            f"under {load.words} of {worst:.4g} {load.unit} the stationary tyre deflects by "
            f"{1e3 * abs(worst) * soft:.4g} mm, more than any tyre can: "
            f"{1e3 * _FARTHEST_TYRE:g} mm: it slides before. Leave greater loads out, or correct "
            "its rates in [tyre]."
        )


def _refuse_beyond(
    suspension: ElasticEquilibrium, states: list[ElasticState], load: RigLoad, wanted: Array
) -> None:
    """Raise an error for loads with an impossible deflection of a bush, or damper or strut."""
    for which in np.argsort(np.abs(wanted), kind="stable"):
        if strained := suspension.overstretched(states[which]):
            raise PositionError(
                f"under {load.words} of {wanted[which]:.4g} {load.unit} {strained}. Leave greater "
                "loads out, or make it stiffer."
            )
        if words := suspension.beyond(states[which]):
            raise PositionError(
                f"under {load.words} of {wanted[which]:.4g} {load.unit} {words[0]}. Leave greater "
                "ones out, or give the file stops that hold it before."
            )
