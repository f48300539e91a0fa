"""``python -m kintrafo``, and the command ``kintrafo``.

What the command line imports takes a part of a second, in which Ctrl-C ends it as quietly as later.
"""

INTERRUPTED = 130
"""What a shell is told by a program that ended for Ctrl-C."""


def run() -> None:
    """Run the command line."""
    try:
        from .core import interrupts  # noqa: PLC0415 (inside, to be guarded)

        interrupts.heed()
        try:
            from .vehicle.cli import run as run_command_line  # noqa: PLC0415 (inside, to be guarded)

            run_command_line()
        finally:
            interrupts.end()
    except KeyboardInterrupt:
        raise SystemExit(INTERRUPTED) from None


if __name__ == "__main__":
    run()
