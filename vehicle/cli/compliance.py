"""``kintrafo compliance``: deflections of the wheels on their bushes, linear or nonlinear."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import typer

from ...terminal.console import console, print_json, print_table, say
from . import goals as wanted
from .loading import assembly_of_file, bushes_of
from .options import (
    SUPPORT,
    Bump,
    Bushes,
    File,
    Held,
    Rebound,
    among,
    metres,
    option,
    refuse_options,
)
from .outputs import Outputs, PlotOptions, name_files, named, of_both, only, title_of
from .variation_options import with_position

if TYPE_CHECKING:
    from xarray import Dataset

    from ...core.named_types import Array
    from ..assembly.assembly import Assembly
    from ..assembly.rig import SweepRange

EXAMPLES = (
    "kintrafo compliance my_car.toml --bushes bushes.toml",
    "kintrafo compliance my_car.toml --bushes bushes.toml --held spring --plot curves.png",
    "kintrafo compliance my_car.toml --bushes bushes.toml --goals goals.toml --plot goals.png",
    "kintrafo compliance my_car.toml --bushes bushes.toml --of toe_by_lateral -o lateral.csv",
    "kintrafo compliance reference_axle --bushes bushes.toml",
    "kintrafo compliance my_car.toml --bushes bushes.toml --nonlinear --plot curves.png",
    "kintrafo compliance my_car.toml --bushes bushes.toml --nonlinear --under lateral --most 6000",
    "kintrafo compliance rigid_axle --bushes axle_bushes.toml --nonlinear --over roll",
    "kintrafo compliance reference_axle --bushes bushes.toml --nonlinear --under braking",
)

_USUAL, _USUAL_TORQUE = 5000.0, 250.0  # greatest loads [N], [N m]
_STEPS = 41  # of the load


@dataclass(frozen=True)
class NonlinearOptions:
    """The options of equilibria with large deflections."""

    nonlinear: Annotated[
        bool, option("Equilibrium with large deflections: over a motion, or --under a load.")
    ] = False
    under: Annotated[
        Literal["lateral", "braking", "recession", "aligning"] | None,
        option("With --nonlinear: the load."),
    ] = None
    most: Annotated[
        float | None, option("Greatest load, N or N m. Default: 5000; aligning: 250.", "N")
    ] = None
    wheels: Annotated[
        Literal["both", "opposed", "left", "right"] | None,
        option(
            "Of an axle: the loaded wheels; both in one direction, or in opposed ones. Default: "
            "both."
        ),
    ] = None
    over: Annotated[
        Literal["travel", "bump", "roll", "left", "right", "steer"] | None,
        option(
            "With --nonlinear: the motion of the rig; travel of one suspension, others of an axle. "
            "Default: travel, bump of an axle."
        ),
    ] = None
    hardpoints: Annotated[
        Literal["loaded", "relaxed"] | None,
        option(
            "With --nonlinear: the load under which the joints are at the hardpoints. loaded (the "
            "default): the static load at design; relaxed: none, with unloaded bushes."
        ),
    ] = None

    @property
    def loads(self) -> dict[str, Any]:
        """The options of a load."""
        return {"--most": self.most, "--wheels": self.wheels}

    @property
    def motions(self) -> dict[str, Any]:
        """The options of a motion."""
        return {"--over": self.over}

    def refuse_without_effect(self, rig: "_Rig", held: Held | None) -> None:
        """Refuse options without effect on this file or with the other options."""
        if len(rig.assembly.wheels) == 1:
            refuse_options("the file of an axle", {"--wheels": self.wheels})
        if self.over is not None:
            rig.assembly.refuse_motion(self.over)
            among([self.over], [name for name in rig.assembly.motions if name != "rack"], "--over")
        if self.under is None:
            refuse_options("--under", self.loads | {"--held": held})


def command(
    file: File,
    *,
    bushes: Bushes = None,
    large: NonlinearOptions,
    held: Annotated[
        Held | None,
        option(f"{SUPPORT} Default: height."),
    ] = None,
    at: Annotated[
        float,
        option(
            "Wheel travel: of the table; with --under, of the wheel before the load; with --over "
            "steer, during the steering.",
            "MM",
        ),
    ] = 0.0,
    rack: Annotated[float, option("Constant rack displacement.", "MM")] = 0.0,
    rebound: Rebound = None,
    bump: Bump = None,
    of: Annotated[
        list[str] | None,
        option("Curves to show, such as toe_by_lateral,toe_by_braking.", "NAME,..."),
    ] = None,
    goals: wanted.Goals = None,
    output: PlotOptions,
) -> None:
    """Print toe, camber and displacement of the wheels per kN and per 100 N m, on their bushes.

    The table is for one position; data files and curves are over wheel travel. The loads act on
    both wheels of an axle, in one direction and oppositely. With --nonlinear the result is the
    equilibrium of all parts with large deflections: over wheel travel, or roll and steering of an
    axle, beside the curves with rigid joints; or under a load, beside the linear result.
    """
    if goals and rack:
        raise typer.BadParameter(wanted.ELSEWHERE)
    outputs = output.files(file, bushes, goals)
    rig = _Rig.of(file, bushes, (at, rack), (rebound, bump))
    if not large.nonlinear:
        others = {"--under": large.under, "--hardpoints": large.hardpoints}
        refuse_options("--nonlinear", others | large.loads | large.motions)
        _linear(rig, held or "height", outputs, of=of, goals=goals, json=output.json)
        return
    refuse_options("linear compliance", {"--of": of, "--goals": goals})
    large.refuse_without_effect(rig, held)
    if large.under is None:
        found = _over_motion(rig, large.over, large.hardpoints or "loaded")
    else:
        ends = {"--rebound": rebound, "--bump": bump}
        refuse_options("curves over a motion", ends | large.motions)
        found = _under(rig, large, held or "height")
    _show_nonlinear(rig, found, outputs, json=output.json)


class _Rig(NamedTuple):
    """A suspension or an axle on the rig, its bushes and its position; lengths in m."""

    file: str
    assembly: "Assembly"
    bushings: Mapping[str, Any] | None
    at: float
    rack: float
    extent: "SweepRange"

    @classmethod
    def of(
        cls,
        file: str,
        bushes: Path | None,
        where: tuple[float, float],
        ends: tuple[float | None, float | None],
    ) -> "_Rig":
        """Return the rig of a file, from travel and rack position, and ends of travel [mm]."""
        from ..assembly.rig import SweepRange

        assembly = assembly_of_file(file, "compliance")
        at, rack = where
        if not assembly.steered:
            refuse_options("files with a rack", {"--rack": rack or None})
        rebound, bump = map(metres, ends)
        extent = SweepRange(rebound=rebound, bump=bump)
        return cls(file, assembly, bushes_of(assembly, bushes, file), at / 1e3, rack / 1e3, extent)

    def on_bushes(self) -> Any:
        """Return the subject of the file on these bushes."""
        if self.bushings is None:
            return self.assembly.subject
        return self.assembly.with_bushings(self.bushings)

    def travels(self) -> "Array":
        """Return the wheel travels of curves, including that of the table [m]."""
        usual = self.assembly.usual(self.assembly.usual_motion, self.extent, rack=self.rack)
        return with_position(usual, 1e3 * self.at)


def _linear(
    rig: _Rig, held: Held, outputs: Outputs, *, of: list[str] | None, goals: Path | None, json: bool
) -> None:
    """Write and print linear compliance."""
    from ...datasets import export
    from ..analysis import compliance
    from ..analysis.compliance.tables import compliances, compliances_of_beam
    from ..assembly.by_wheel import flat
    from ..studies.sweep_axes import sweep_axes_of

    subject = rig.assembly.subject
    found = compliance.linear(
        rig.assembly, rig.bushings, rig.travels(), rack_position=rig.rack, held=held
    )
    curves = found.drop_dims(["moved", "by"])
    columns = flat(curves)
    names = named(of_both(of), {held: curves})[held]
    aims = wanted.read(goals, [held], sweep_axes_of(subject))
    judged = wanted.judged({rig.file: rig.on_bushes()}, aims, goals) if aims else []
    if outputs.drawn:
        wanted.refuse_beyond(aims, {held: columns}, goals)
    title = f"{title_of(rig.file)}: compliance, {found.attrs['held']}"
    written = outputs.write(found, title=title, names=names, rows=columns, drawn=curves, goals=aims)
    if json:
        print_json(export.as_dict(flat(found)) | ({"goals": judged} if aims else {}))
        return
    title = f"{rig.file}: compliance, at {1e3 * rig.at:g} mm of wheel travel"
    shown = only(of, columns)
    of_wheels = compliances(shown, title, rig.at)
    for table in (of_wheels, *compliances_of_beam(shown, f"{title}, the axle", rig.at)):
        if table.rows:
            print_table(table)
    if aims:
        console.print(wanted.table(judged, f"{rig.file}: targets and limits of {goals}"))
    without = found.attrs["left_out"]
    say(f"{found.attrs['held']}; relaxed bushes, linear{without and f'; without {without}'}.")
    name_files(written)


def _over_motion(rig: _Rig, motion: str | None, hardpoints: Any) -> "Dataset":
    """Return elastokinematic curves over a motion."""
    from ..analysis import compliance

    if motion in ("roll", "steer"):
        far = {"--rebound": rig.extent.rebound, "--bump": rig.extent.bump}
        refuse_options("curves over wheel travel", far)
    along = None
    if len(rig.assembly.wheels) == 1:
        along = rig.travels()
    elif motion != "steer":
        refuse_options("the file of one suspension, or a load", {"--at": rig.at or None})
    return compliance.elastokinematics(
        rig.assembly, rig.bushings, motion, along, extent=rig.extent,
        travel=rig.at if motion == "steer" else 0.0, rack_position=rig.rack, hardpoints=hardpoints,
    )  # fmt: skip


def _under(rig: _Rig, large: NonlinearOptions, held: Held) -> "Dataset":
    """Return displacements of the wheels under loads."""
    import numpy as np

    from ...core.errors import InputError
    from ..analysis import compliance

    usual = _USUAL_TORQUE if large.under == "aligning" else _USUAL
    greatest = usual if large.most is None else large.most
    if not 0.0 < greatest < np.inf:
        raise InputError([f"--most {greatest}: a load of more than 0 is needed."], "compliance")
    amounts = np.linspace(-greatest, greatest, _STEPS)
    return compliance.nonlinear(
        rig.assembly, rig.bushings, str(large.under), amounts,
        wheels="parallel" if large.wheels == "both" else large.wheels, travel=rig.at,
        rack_position=rig.rack, held=held, hardpoints=large.hardpoints or "loaded",
    )  # fmt: skip


def _show_nonlinear(rig: _Rig, found: "Dataset", outputs: Outputs, *, json: bool) -> None:
    """Write and print the results of --nonlinear."""
    from ...datasets import export
    from ..analysis.compliance.tables import deflections
    from ..assembly.by_wheel import flat

    columns = flat(found)
    title = f"{title_of(rig.file)}: {found.attrs['title']}"
    written = outputs.write(found, title=title, rows=columns, drawn=columns)
    if json:
        print_json(export.as_dict(columns))
        return
    for sheet in deflections(found, f"{rig.file}: {found.attrs['title']}"):
        print_table(sheet)
    say(f"{'; '.join(found.attrs[key] for key in ('held', 'hardpoints') if key in found.attrs)}.")
    name_files(written)
