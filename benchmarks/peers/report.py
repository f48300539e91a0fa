"""The Markdown table of everything measured."""

from .case import ACCURACY
from .compiled import FLAGS
from .timing import Evaluation, Second


def markdown(
    evaluations: list[Evaluation],
    seconds: list[Second],
    skipped: dict[str, str],
    machine: str,
) -> str:
    """Return the report.

    Parameters
    ----------
    evaluations : list of Evaluation
        Right-hand sides.
    seconds : list of Second
        Simulations.
    skipped : dict of str
        Reasons by name.
    machine : str
        Said at the top.
    """
    flags = "; ".join(f"`{name}`: {' '.join(given)}" for name, given in FLAGS.items())
    lines = [
        "# The same suspension in other tools",
        "",
        f"{machine}. One core; least time over the rounds, median in brackets. Flags {flags}.",
        "",
        "## Time of a right-hand side",
        "",
        *_table(
            (
                "model",
                "parameters",
                "flags",
                "dependent calls [ns]",
                "independent calls [ns]",
                "derive [s]",
                "generate [s]",
                "compile [s]",
                "error",
            ),
            [_evaluation_row(evaluation) for evaluation in evaluations],
        ),
        "",
        "The error is that of the accelerations at random states, relative to one plus their size.",
        "",
        f"## Time of the second at {ACCURACY:g} rad in the arm angle",
        "",
        *_table(
            ("tool", "setting", "error [rad]", "time [ms]", "median [ms]", "build [s]"),
            [_second_row(second) for second in sorted(seconds, key=_least)],
        ),
        "",
        *(["## Not timed", ""] if skipped else []),
        *(f"- {name}: {' '.join(reason.split())}" for name, reason in skipped.items()),
    ]
    return "\n".join(lines).rstrip() + "\n"


def _least(second: Second) -> float:
    return second.least_milliseconds


def _evaluation_row(evaluation: Evaluation) -> tuple[str, ...]:
    times = (
        f"{spread['least']:.0f} ({spread['median']:.0f})"
        for spread in evaluation.nanoseconds.values()
    )
    return (
        evaluation.name,
        evaluation.parameters,
        evaluation.flags,
        *times,
        f"{evaluation.derive_seconds:.2f}",
        f"{evaluation.generate_seconds:.2f}",
        f"{evaluation.compile_seconds:.2f}",
        f"{evaluation.error:.0e}",
    )


def _second_row(second: Second) -> tuple[str, ...]:
    return (
        second.name,
        second.setting,
        f"{second.error:.1e}",
        f"{second.least_milliseconds:.3g}",
        f"{second.median_milliseconds:.3g}",
        f"{second.build_seconds:.2f}",
    )


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    return [f"| {' | '.join(row)} |" for row in (head, ("---",) * len(head), *rows)]
