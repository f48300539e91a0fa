"""The Markdown tables of everything measured, and the ratios that are quoted."""

from ..report import markdown_table, power
from .case import ACCURACY
from .compiled import FLAGS
from .timing import Evaluation, Second

OURS = "kintrafo"


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


def blocks(evaluations: list[Evaluation], seconds: list[Second], machine: str) -> dict[str, str]:
    """Return the parts of the page in docs/ by name."""
    return {
        "machine": f"{machine}. One core; least time over the rounds.",
        "evaluations": _evaluation_ratios(evaluations),
        "builds": _build_times(evaluations),
        "seconds": _second_ratios(seconds),
        "times": _times_as_fast(seconds),
    }


def _evaluation_ratios(evaluations: list[Evaluation]) -> str:
    """Right-hand sides, and how much longer than ours each takes."""
    header, rows = ["right-hand side"], []
    for flags in FLAGS:
        header += [f"{flags}: dependent [ns]", "/ kintrafo", "independent [ns]", "/ kintrafo"]
    for name, parameters in dict.fromkeys((e.name, e.parameters) for e in evaluations):
        cells = [f"{name}, numbers" if parameters == "literal" else name]
        for flags in FLAGS:
            times = _nanoseconds(evaluations, name, parameters, flags)
            ours = _nanoseconds(evaluations, OURS, "inputs", flags)
            pairs = zip(times, ours, strict=True) if times and ours else ()
            filled = [text for t, o in pairs for text in (f"{t:.0f}", f"{t / o:.2f}")]
            cells += filled or ["-"] * 4
        rows.append(cells)
    return markdown_table(header, rows)


def _nanoseconds(
    evaluations: list[Evaluation], name: str, parameters: str, flags: str
) -> list[float]:
    for e in evaluations:
        if (e.name, e.parameters, e.flags) == (name, parameters, flags):
            return [spread["least"] for spread in e.nanoseconds.values()]
    return []


def _build_times(evaluations: list[Evaluation]) -> str:
    """Time to set up, write and compile each right-hand side, parameters as inputs."""
    seconds: dict[str, list[str]] = {}
    for e in evaluations:
        if e.parameters != "literal":
            phases = (e.derive_seconds, e.generate_seconds, e.compile_seconds)
            seconds.setdefault(e.name, [f"{phase:.2f}" for phase in phases])
    header = ["right-hand side", "derive [s]", "write [s]", "compile [s]"]
    return markdown_table(header, [[name, *cells] for name, cells in seconds.items()])


def _fastest(seconds: list[Second]) -> dict[str, Second]:
    """Return the fastest of each kind of program."""
    fastest: dict[str, Second] = {}
    for second in sorted((s for s in seconds if ", numbers" not in s.name), key=_least):
        fastest.setdefault(_kind(second.name), second)
    return fastest


def _times_as_fast(seconds: list[Second]) -> str:
    """Return a comparison of `simulate`, and of its solver alone, with the best of CasADi."""
    fastest = _fastest(seconds)
    theirs = fastest.get("CasADi CVODES tuned jit")
    solver = fastest.get("kintrafo's solver alone")
    if theirs is None or solver is None:
        return "CasADi was not installed."
    whole, alone = (
        theirs.least_milliseconds / s.least_milliseconds
        for s in (fastest["kintrafo.simulate"], solver)
    )
    return (
        f"CasADi's CVODES, tuned, compiled and called from Python, takes {alone:.1f} times as long "
        f"as the compiled solver of `simulate` alone, and {whole:.1f} times as long as `simulate`, "
        "which also checks arguments and labels results."
    )


def _second_ratios(seconds: list[Second]) -> str:
    """Return the fastest of each kind of program, and how much longer than `simulate` it takes."""
    fastest = _fastest(seconds)
    ours = fastest["kintrafo.simulate"].least_milliseconds
    rows = [
        [
            s.name,
            _shortened(s.setting),
            f"{s.error:.1e}",
            f"{_least(s):.3g}",
            f"{_least(s) / ours:.3g}",
        ]
        for s in fastest.values()
    ]
    return markdown_table(["program", "setting", "error [rad]", "time [ms]", "/ simulate"], rows)


def _shortened(setting: str) -> str:
    """Return a setting; of a tolerance two digits are enough."""
    return power(float(setting)) if "e-" in setting else setting


def _kind(name: str) -> str:
    """Return what is compared: a tool, and how it is run."""
    tool = name.split(",", maxsplit=1)[0].split(" (", maxsplit=1)[0]
    endings = [word for word in ("jit", "RK4 in C", "extrapolated") if name.endswith(word)]
    if tool.startswith("Exudyn"):
        tool = "Exudyn"
    if "RK4 in C" in endings and tool.startswith("CasADi"):
        tool = "CasADi"
    return " ".join([tool, *endings])


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
