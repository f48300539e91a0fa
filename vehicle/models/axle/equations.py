"""The equations of motion of an axle, derived and compiled at first use."""

from collections.abc import Callable
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

from ....core.validator import Validator
from ....systems.allowed import LengthLimit
from ....systems.compile.build import compile_mechanism, require_generator
from ....systems.system import System
from ..model import Model
from ..sides import LEFT, RIGHT
from .axle import Axle

if TYPE_CHECKING:
    from ....generator import Formulation


class AxleModel(System):
    """The compiled equations of an axle: both suspensions, the rack and the anti-roll bar.

    They are derived and compiled at first use, as by `kintrafo.compile`, and cached.

    Parameters
    ----------
    axle : Axle
    progress : callable, optional
        Called with a short description of the present step.
    wheel_loads : bool, optional
        Whether loads on the wheels are inputs, as in `Model`, with the prefix of the side.

    Attributes
    ----------
    axle : Axle
        The data of the files.
    parameters, constants, design_state
        Numbers, constants and state at design of the equations. Names of states, inputs and signals
        are those of the suspension, with the prefix ``right_`` or ``left_``; the bar has
        ``bar_angle`` and ``bar_spring_moment``.
    """

    def __init__(
        self,
        axle: Axle,
        *,
        progress: Callable[[str], None] | None = None,
        wheel_loads: bool = False,
    ) -> None:
        with Validator("AxleModel") as given:
            given.instance("axle", axle, Axle, Axle.NEEDED)
            given.function("progress", progress)
            wheel_loads = given.flag("wheel_loads", wheel_loads)
        equations = compile_mechanism(declared(axle, wheel_loads=wheel_loads), progress=progress)
        values = _parameters(axle, wheel_loads=wheel_loads)
        known = {name: values[name] for name in values if name in equations.PARAMETERS}
        super().__init__(equations, known)
        self.axle, self.wheel_loads = axle, wheel_loads

    @cached_property
    def corners(self) -> dict[str, Model]:
        """The equations of each side alone, with the same loads on its wheel."""
        if not self.wheel_loads:
            return self.axle.models
        return {side: Model(own, wheel_loads=True) for side, own in self.axle.sides.items()}

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        return self.axle.allowed_lengths()

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(AxleModel, wheel_loads=self.wheel_loads), (self.axle,)

    def __repr__(self) -> str:
        return f"<AxleModel {self.equations.NAME}>"


def declared(axle: Axle, *, wheel_loads: bool = False) -> "Formulation":
    """Return the declaration of an axle, without values."""
    require_generator()
    from ....generator.mechanisms import axle as page  # noqa: PLC0415 (an extra)
    from ....generator.mechanisms import model_named  # noqa: PLC0415
    from ....generator.mechanisms.suspension import with_wheel_loads  # noqa: PLC0415

    corner = model_named(axle.equations_name)
    if wheel_loads:
        corner = with_wheel_loads(corner)
    pulls = axle.link_part
    parts = (corner.name, axle.end, "axle", pulls, "" if axle.symmetric else "two_sides")
    mechanism = page.mechanism(
        "_".join(part for part in parts if part),
        axle.heading()[:1].upper() + axle.heading()[1:],
        corner,
        pulls=pulls,
        own=not axle.symmetric,
        end=axle.end,
    )
    return page.model(corner, mechanism)


def _parameters(axle: Axle, *, wheel_loads: bool) -> dict[str, float]:
    of_sides = axle.parameters_by_side()
    if wheel_loads:
        of_sides = {
            side: values | axle.sides[side].wheel_load_parameters()
            for side, values in of_sides.items()
        }
    left = {f"{LEFT}_{name}": value for name, value in of_sides[LEFT].items()}
    return of_sides[RIGHT] | left | axle.parameters_of_bar()
