"""``python -m kintrafo``, and the command ``kintrafo``.

What the command line imports takes a part of a second, in which Ctrl-C ends it as quietly as later.
"""

import sys

INTERRUPTED = 130
"""Exit code of a program that Ctrl-C ended."""


def run() -> None:
    """Run the command line."""
    try:
        from .core import interrupts  # noqa: PLC0415 (inside, to be guarded)

        interrupts.heed()
        # where dask is installed, xarray imports it for 0.3 s to see whether it has arrays of it
        sys.modules.setdefault("dask", None)  # type: ignore[arg-type]  # None: not there
        try:
            from .vehicle.cli import run as run_command_line  # noqa: PLC0415 (inside, to be guarded)

            run_command_line()
        finally:
            interrupts.end()
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None


if __name__ == "__main__":
    run()
