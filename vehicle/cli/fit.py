"""``kintrafo fit``: errors of the values of a file that explain curves measured on a rig."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...core.tabulated import significant
from ...terminal.console import console, print_json, progress_bar, say, table
from ...terminal.exits import Exit
from .loading import of_study, variable_subject
from .options import File, Held, among, argument, option
from .outputs import CarOptions, name_files
from .variation_options import Over

if TYPE_CHECKING:
    from xarray import Dataset

    from ..studies import Fit

EXAMPLES = (
    "kintrafo fit my_car.toml rig.csv tolerances.toml",
    "kintrafo fit my_car.toml rig.csv tolerances.toml --of toe -o as_built.toml --plot fitted.png",
)


def command(
    file: File,
    measured: Annotated[
        Path,
        argument(
            "CSV: wheel_travel [mm] or rack_position [mm], toe [deg], ...; of a rigid axle also "
            "over roll_angle [deg]; of a car over lateral_acceleration [m/s^2], "
            "steering_wheel_angle [deg], ...",
            "MEASURED",
        ),
    ],
    tolerances: Annotated[
        Path,
        argument("TOML: [tolerances] of uncertain values, and [accuracy] of curves.", "TOLERANCES"),
    ],
    *,
    of: Annotated[
        list[str] | None, option("Curves to explain, such as toe,camber. Default: all.", "NAME,...")
    ] = None,
    held: Annotated[Held, option("Support of the wheel when compliance was measured.")] = "height",
    over: Over = None,
    output: CarOptions,
) -> None:
    """Find deviations from the values of the file that explain measured curves.

    Each deviation stays within its tolerance. Of several explanations the most probable one is
    printed, with its uncertainty. The exit code is 1 if a curve is not explained.
    """
    from .. import studies as variation
    from ..analysis import rig
    from ..assembly.of import assembly_of

    outputs = output.files(file, measured, tolerances, car=output.car)
    subject = variable_subject(file)
    if assembly_of(subject).body_moves and outputs.pages:
        raise typer.BadParameter("--plot is only for suspensions and axles")
    curves = rig.measured_curves(measured)
    asked = variation.read(tolerances)
    names = among(of, map(str, curves)) if of else None
    with of_study(tolerances), progress_bar("fit") as progress:
        found = variation.fit(
            subject,
            curves,
            asked.get("tolerances", {}),
            accuracy=asked.get("accuracy"),
            names=names,
            held=held,
            over=over,
            progress=lambda left: progress(1.0 - left),
        )
    written: list[Path] = []
    if outputs.pages:
        from ..plots.curves import write_overview

        models = {"file": assembly_of(found.start), "fitted": assembly_of(found.suspension)}
        shown = rig.beside(curves, models, held=held)[[curve.name for curve in found.curves]]
        written += outputs.draw(write_overview, shown, (), f"{file}: {measured.name}")
    head = f"{file}, with values that kintrafo fit found to explain {measured.name}."
    written += outputs.write_car(found.suspension, head)
    if output.json:
        print_json(_facts(found))
    else:
        _print(found, curves, file)
        if curves.attrs.get("left_out"):
            say(f"columns that were not read: {curves.attrs['left_out']}.")
        name_files(written)
    if not found.success:
        raise typer.Exit(Exit.REFUSED)


def _facts(found: "Fit") -> dict[str, Any]:
    names = ("moved", "uncertainty", "determined", "success", "message")
    facts: dict[str, Any] = {name: getattr(found, name) for name in names}
    facts["curves"] = [vars(curve) for curve in found.curves]
    return facts | {"suspension": found.suspension.to_dict()}


def _print(found: "Fit", measured: "Dataset", file: str) -> None:
    from ...core.quantities import display_of, heading_of

    values, curves = [], []
    for place in found.places:
        by, deviation = found.moved[place.name], found.uncertainty[place.name]
        numbers = [f"{value:.3f}" for value in (place.value, place.value + by, by, deviation)]
        part = f"{100.0 * found.determined[place.name]:.0f} %"
        values.append((place.name, *numbers, place.unit or "-", part))
    for curve in found.curves:
        data = measured[curve.name]
        factor = display_of(data.attrs).factor
        shown = (significant(v * factor) for v in (curve.before, curve.after, curve.within))
        curves.append((heading_of(data), *shown))
    head = ("value", "file", "fitted", "deviation", "+/-", "unit", "determined by the curves")
    console.print(table(f"{file}: fitted values", head, values, words=(0, 5)))
    title = "deviations of the curves, root mean square"
    console.print(table(title, ("characteristic", "file", "fitted", "accuracy"), curves))
    say(f"{found.message}; {found.evaluations} evaluations.")
