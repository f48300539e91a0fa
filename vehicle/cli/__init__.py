"""The command line ``kintrafo``: one module for each command, which calls a Python function."""

from collections.abc import Mapping
from types import ModuleType
from typing import Annotated, Any, ClassVar

import typer
from rich.markup import escape

from ...terminal.exits import Exit, guarded, show_usage_error, standing_streams
from ...terminal.usage import Command, CommandGroup, MistakenUsage
from . import (
    characteristics,
    check,
    compare,
    compliance,
    drive,
    export,
    fit,
    import_,
    loads,
    mechanism,
    new,
    optimise,
    paper,
    pareto,
    report,
    ride,
    schema,
    sensitivity,
    sheet,
    simulate,
    sweep,
    tolerance,
    tyre,
)
from .option_groups import with_groups
from .values import explained

__all__ = ["COMMANDS", "app", "run"]

_EXIT_CODES = (
    "Exit codes: 0 done; 1 no result, or an invalid one, or [bold]check[/bold] found a problem; "
    "2 a mistake in the arguments or in a file; 3 a required package is not installed; "
    "130 Ctrl-C.\n\n"
    "Not listed: [bold]kintrafo schema[/bold], the JSON Schema of input files for editors, and "
    "[bold]kintrafo paper[/bold], the figures of the paper."
)


class _Commands(CommandGroup):
    """The commands, with suggestions for names of commands that do not exist."""

    instead: ClassVar[Mapping[str, str]] = {
        "animate": "kintrafo mechanism animate",
        "elastokinematics": "kintrafo compliance",
        "init": "kintrafo new",
        "kandc": "kintrafo sheet",
        "kc": "kintrafo sheet",
        "kinematics": "kintrafo characteristics --positions",
        "montecarlo": "kintrafo tolerance",
        "plot": "kintrafo characteristics FILE --plot curves.pdf",
        "positions": "kintrafo characteristics --positions",
        "validate": "kintrafo check",
    }


app = typer.Typer(
    cls=_Commands,
    help="Kinematics, compliance, loads and motions of suspensions, axles and cars.",
    epilog=_EXIT_CODES,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _flowing(docstring: str) -> str:
    """Return a docstring with one line for each paragraph, and brackets escaped as no markup."""
    paragraphs = (" ".join(paragraph.split()) for paragraph in docstring.split("\n\n"))
    return escape("\n\n".join(paragraphs))


# In the order of an engineer's work.
_PANELS = {
    "Begin": (new, import_, check),
    "Compute": (characteristics, simulate, ride, drive, loads, compliance, sheet, compare, tyre),
    "Design": (sensitivity, tolerance, optimise, pareto, fit, sweep),
    "Hand over": (report, export),
}
# Not listed by `kintrafo --help`.
_HIDDEN = (schema, paper)

COMMANDS: dict[str, ModuleType] = {}
"""Modules by command, such as ``"mechanism animate"``."""


def _add(to: typer.Typer, module: ModuleType, group: str = "", **options: Any) -> None:
    """Add the command of a module, named after the module."""
    name = module.__name__.rpartition(".")[2].strip("_")
    examples = "\n\n".join(("Examples:", *module.EXAMPLES))
    words = _flowing(module.command.__doc__ or "")
    kind = type(f"Command_{name}", (Command,), {"examples": module.EXAMPLES})
    made = to.command(name, cls=kind, help=words, epilog=escape(examples), **options)
    made(explained(with_groups(module.command)))
    COMMANDS[f"{group}{name}"] = module


for _panel, _modules in _PANELS.items():
    for _module in _modules:
        _add(app, _module, rich_help_panel=_panel)
for _module in _HIDDEN:
    _add(app, _module, hidden=True)
_mechanism = typer.Typer(
    cls=CommandGroup, no_args_is_help=True, help=mechanism.HELP, rich_markup_mode="rich"
)
for _module in mechanism.COMMANDS:
    _add(_mechanism, _module, group="mechanism ")
app.add_typer(_mechanism, name="mechanism", rich_help_panel="Hand over")


def _show_version(*, wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        from ...simulation.solvers import native_version

        typer.echo(f"kintrafo {version('kintrafo')}, SUNDIALS {native_version()}")
        raise typer.Exit


@app.callback()
def main(
    *,
    version: Annotated[
        bool,
        typer.Option(
            "--version",
            callback=lambda v: _show_version(wanted=v),
            is_eager=True,
            help="Show the versions of kintrafo and of its solver.",
        ),
    ] = False,
) -> None:
    """Kinematics, compliance, loads and motions of suspensions, axles and cars."""
    del version


def run() -> None:
    """Run the command line; a user's mistake ends with a message, not with a traceback."""
    with standing_streams(), guarded():
        try:
            # not standalone: Typer's own messages need rich's Markdown, which is slow to import
            code = app(prog_name="kintrafo", standalone_mode=False)
        except MistakenUsage as error:
            show_usage_error(error)
            code = error.exit_code
        raise SystemExit(code or Exit.DONE)
