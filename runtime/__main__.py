"""``python -m kintrafo``, and the command ``kintrafo``.

Importing the command line takes a part of a second; Ctrl-C during it ends the program quietly, too.
"""

import sys

INTERRUPTED = 130
"""Exit code of a program that Ctrl-C ended."""


def run() -> None:
    """Run the command line."""
    try:
        from .core import interrupts  # noqa: PLC0415 (inside, to be guarded)

        interrupts.heed()
        # xarray imports an installed dask, which takes 0.3 s, to recognise its arrays
        sys.modules.setdefault("dask", None)  # type: ignore[arg-type]  # None: not installed
        try:
            from .vehicle.cli import run as run_command_line  # noqa: PLC0415 (inside, to be guarded)

            run_command_line()
        finally:
            interrupts.end()
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None


if __name__ == "__main__":
    run()
