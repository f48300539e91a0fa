"""Commands of the golden set: exit codes, columns of CSV and keys of JSON.

Commands refuse, too: what an axle or a rigid axle does not have today stands here with its exit
code, so that a hole that closes is seen.
"""

import contextlib
import io
import json
import sys
from pathlib import Path

from kintrafo.vehicle import cli

DATA = Path(__file__).parents[1] / "data/studies"
FILES = ("reference_car", "reference_axle", "rigid_axle")
BUSHED = {
    "reference_car": "[bushings.arm_rear]\nradial_N_per_mm = 1000.0\n",
    "reference_axle": "[bushings.arm_rear]\nradial_N_per_mm = 1000.0\n",
    "rigid_axle": "[bushings.panhard_rod_axle]\naxial_N_per_mm = 5000.0\n",
}
SOFT = ("--bushes", "BUSHES")
GRID = ("--bump", "20", "--rebound", "20")
LINES = (
    ("characteristics", "FILE", *GRID),
    ("characteristics", "FILE", *GRID, "--over", "roll"),
    ("characteristics", "FILE", *GRID, "--over", "steer"),
    ("characteristics", "FILE", *GRID, "--positions"),
    ("simulate", "FILE", "--duration", "0.02"),
    ("loads", "FILE"),
    ("loads", "FILE", "--envelope"),
    ("compliance", "FILE", *SOFT, *GRID),
    ("compliance", "FILE", "--bushes", "BUSHES", "--nonlinear", "--under", "lateral", "--most",
     "500"),
    ("compliance", "FILE", *SOFT, "--nonlinear", "--over", "bump", *GRID),
    ("sheet", "FILE", *SOFT),
    ("compare", "FILE", "FILE"),
    ("compare", "FILE", "FILE", "--held", "height"),
    ("sensitivity", "FILE", "--place", "hardpoints.wheel_center", "--at", "10"),
    ("tolerance", "FILE", "TOLERANCES", "--cars", "5"),
    ("check", "FILE"),
    ("mechanism", "topology", "FILE"),
)  # fmt: skip


def observed(folder):
    """Return what each command does with each file: exit code, columns, keys.

    Parameters
    ----------
    folder : pathlib.Path
        An empty one, for what the commands write.
    """
    found = {}
    for file in FILES:
        bushes, tolerances = folder / f"{file}_bushes.toml", folder / "tolerances.toml"
        bushes.write_text(BUSHED[file], encoding="utf-8")
        tolerances.write_text('[tolerances]\n"hardpoints.wheel_center.z" = 1.0\n', encoding="utf-8")
        names = {"FILE": file, "BUSHES": str(bushes), "TOLERANCES": str(tolerances)}
        for line in LINES:
            arguments = [names.get(word, word) for word in line]
            spelled = " ".join(file if word == "FILE" else word for word in line)
            found[spelled] = _observed(arguments, folder / f"{len(found)}.csv")
    return found


def _observed(arguments, out):
    writes = [] if arguments[0] in {"check", "mechanism"} else ["--out", str(out)]
    code, printed = _run([*arguments, "--json", *writes])
    return {
        "exit": code,
        "columns": {
            path.stem.removeprefix(out.stem): path.read_text(encoding="utf-8").partition("\n")[0]
            for path in sorted(out.parent.glob(f"{out.stem}[._]*"))
        },
        "keys": _keys(json.loads(printed)) if code == 0 else None,
    }


def _run(arguments):
    """Return exit code and standard output of a command line."""
    before, out = sys.argv, io.StringIO()
    sys.argv = ["kintrafo", *arguments]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
            cli.run()
    except SystemExit as end:
        return int(end.code or 0), out.getvalue()
    finally:
        sys.argv = before
    return 0, out.getvalue()


def _keys(value, depth=2):
    """Return the keys of JSON without its values, to a depth."""
    if isinstance(value, dict) and depth:
        return {key: _keys(item, depth - 1) for key, item in value.items()}
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return [_keys(value[0], depth)]
    return type(value).__name__
