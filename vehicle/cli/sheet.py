"""``kintrafo sheet``: the K&C sheet of a suspension or an axle, at design."""

from typing import Annotated

from ...terminal.console import print_json, print_table, say
from .loading import assembly_of_file, bushes_of
from .options import SUPPORT, Bushes, File, Held, option
from .outputs import DataOptions, name_files

EXAMPLES = (
    "kintrafo sheet my_car.toml --bushes bushes.toml",
    "kintrafo sheet my_axle.toml -o sheet.csv",
    "kintrafo sheet rigid_axle --bushes axle_bushes.toml",
    "kintrafo sheet bmw_e90",
)


def command(
    file: File,
    *,
    bushes: Bushes = None,
    held: Annotated[Held, option(SUPPORT)] = "height",
    output: DataOptions,
) -> None:
    """Print the K&C sheet: kinematic and compliance gradients at design, as measured on a rig.

    A car has both axles side by side, on a held body. The sheet has definitions, and the signs of
    ISO 8855 and of SAE J670 (z down). It has compliance if the file has bushes, or with --bushes.
    """
    from ...datasets import export
    from ..analysis.sheet import one_page, sheet

    outputs = output.files(file, bushes)
    assembly = assembly_of_file(file)
    found = sheet(assembly, bushes_of(assembly, bushes, file), held=held)
    written = outputs.write_data(found)
    if output.json:
        print_json(export.as_dict(found))
        return
    for table in one_page(found, f"{file}: K&C sheet at design, signs of ISO 8855"):
        print_table(table, ruled=False)
    say("* opposite sign in SAE J670, z down. Data files (-o) have definitions and both signs.")
    name_files(written)
