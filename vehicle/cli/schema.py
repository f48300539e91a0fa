"""``kintrafo schema``: the JSON Schema of input files, for editors."""

from pathlib import Path
from typing import Annotated

import typer

from ...terminal.console import say
from .options import Force, argument

EXAMPLES = ("kintrafo schema", "kintrafo schema kintrafo.schema.json")


def command(
    path: Annotated[Path | None, argument("File to write; ends in .json.", "PATH")] = None,
    *,
    force: Force = False,
) -> None:
    """Print or write the JSON Schema of input files: keys, units, ranges.

    Editors complete and check the files of suspensions, axles, cars and manoeuvres with it. Write
    it beside them, and let their first line be `#:schema ./kintrafo.schema.json`, which TOML
    language servers understand.
    """
    from ...core.files import refuse, write_text
    from .published import published

    text, _ = published()
    if path is None:
        typer.echo(text, nl=False)
        return
    refuse([path], force=force, endings=[".json"])
    say(f"  {write_text(path, text, force=force)}")
