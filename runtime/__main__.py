"""``python -m kintrafo``, and the command ``kintrafo``.

Importing the command line takes a part of a second; Ctrl-C during it ends the program quietly, too.
"""

import sys
from typing import Any

INTERRUPTED = 130
"""Exit code of a program that Ctrl-C ended."""


def run() -> None:
    """Run the command line."""
    try:
        from .core import interrupts  # noqa: PLC0415 (inside, to be guarded)

        interrupts.heed()
        # xarray imports an installed dask to recognise its arrays, which takes 0.3 s; with None in
        # its entry it is not installed for the imports of this command
        modules: dict[str, Any] = sys.modules
        hidden = modules.keys().isdisjoint(("dask", "xarray"))
        if hidden:
            modules["dask"] = None
        try:
            from .vehicle.cli import run as run_command_line  # noqa: PLC0415 (inside, to be guarded)

            run_command_line()
        finally:
            if hidden:
                del modules["dask"]
            interrupts.end()
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None


if __name__ == "__main__":
    run()
