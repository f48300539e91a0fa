"""Commands with random arguments and unusual file names."""

import contextlib
import io
import os
import sys
import tempfile
from pathlib import Path
from unittest import mock

from kintrafo.vehicle import cli
from kintrafo.vehicle.data.starter import packaged

from ..attempts import RawError, WrongError
from .chrono import DATA
from .toml import TEXTS


class RefusedError(Exception):
    """The command ended with a message and an exit code of its own."""


SHORT = 12
SECONDS = 60.0  # a report of a machine with something else to do
STEMS = (
    "a", "$^$", "two words", "two\nlines", "-o", "--help", os.fsdecode(b"caf\xe9"), "[red]x[",
    "=1+1", "日本", "\x1b[2J", "x" * 240, "x" * 300, "%s{0}",
    "..", "\u202etxt", "'", '"', "~", "CON", " ",
)  # fmt: skip
ENDINGS = (
    ".toml", ".toml", ".csv", ".sub", ".txt", ".nc", ".parquet", ".html", ".json", ".pdf", ".png",
    ".svg", ".xlsx", ".py", "", ".",
)  # fmt: skip
PLACES = ("", "", "", "", "sub/", "missing/", "file/", "link/", "circle/", "/proc/", "../")
NUMBERS = ("0", "1", "-1", "20", "60", "1e-9", "1e9", "1e400", "nan", "inf", "x", "", "0.001",
           "7,5")  # fmt: skip
FLAGS = ("--json", "--force", "--force")
COARSE = ("--step", "40")
FEW = {"tolerance": ("--cars", "2"), "pareto": ("--population", "4", "--generations", "2")}
VALUES = ("wheel.toe_deg=0,1", "wheel.toe_deg=0:1:2", "wheel.toe_deg=0:1:1e9", "x=1", "=",
          "wheel=1")  # fmt: skip
OPTIONS = {
    "new": ("--suspension", "--template", "--axle"),
    "import": ("--side", "--from", "--from", "--from", "--name", "--kind", "--tire",
               "--points-only", "--mirror", "--unit", "--axes", "--left-handed", "--sheet"),
    "export": ("-o", "--fmi", "--model"),
    "schema": (),
    "check": ("--json",),
    "mechanism topology": ("--free-rack", "--json"),
    "characteristics": ("-o", "--bump", "--rebound", "--travel", "--rack", "--rack-extent",
                        "--over", "--roll", "--of", "--goals", "--positions"),
    "simulate": ("-o", "--road-step", "--road-sine", "--road-frequency", "--measured", "--speed",
                 "--rack", "--rack-sine", "--height", "--spin", "--output-step", "--method",
                 "--rtol", "--atol", "--road-step-at", "--wheels"),
    "loads": ("-o", "--plot", "--cases", "--case", "--part"),
    "compliance": ("-o", "--plot", "--bushes", "--held", "--at", "--rack", "--bump", "--of",
                   "--goals"),
    "compliance --nonlinear": ("-o", "--plot", "--under", "--most", "--held", "--at", "--rack",
                               "--bump", "--wheels", "--over"),
    "sheet": ("-o", "--bushes", "--held", "--json"),
    "compare": ("-o", "--over", "--of", "--held", "--goals"),
    "sensitivity": ("-o", "--plot", "--place", "--of", "--over", "--at"),
    "tolerance": ("-o", "--plot", "--of", "--over", "--at", "--seed"),
    "optimise": ("-o", "--plot"),
    "pareto": ("-o", "--plot", "--member-file", "--member", "--seed"),
    "fit": ("-o", "--plot", "--of"),
    "sweep": ("-o", "--plot", "--keep", "--height", "--road-step", "--measured"),
    "report": ("--title", "--goals"),
    "paper": ("--data",),
    "mechanism derivation": ("-o", "-o", "--model"),
    "mechanism generate": ("-o", "--model", "--numpy"),
}  # fmt: skip
WORDS = {
    "--suspension": ("macpherson", "double_wishbone", "x"),
    "--template": (*packaged(), "x"),
    "--kind": ("macpherson", "double_wishbone", "x"),
    "--from": (*packaged(), "x"),
    "--name": ("spring_top=top_mount", "spring_top=x", "x", "="),
    "--side": ("left", "right", "x"),
    "--unit": ("mm", "in", "x", ""),
    "--axes": ("rearward right up", "forward right up", "up up up", "x", ""),
    "--sheet": ("points", ""),
    "--over": ("travel", "rack", "both", "bump", "roll", "left", "steer", "x", "", "bump,roll"),
    "--wheels": ("left", "both", "x"),
    "--place": ("wheel", "hardpoints.tie_rod_inner.z", "vehicle", "rack.axis", "*", "x", ""),
    "--of": ("toe", "toe,camber", "ackermann", "toe_by_lateral", "x", ""),
    "--keep": ("toe:max", "tyre_force:above:1", "toe", "toe:above", "toe:percentile:90", "toe:psd",
               "x:max", ""),
    "--case": ("static", "brake", "x", ""),
    "--part": ("knuckle", "chassis", "x", ""),
    "--held": ("height", "spring", "x"),
    "--under": ("lateral", "aligning", "x"),
    "--method": ("BDF", "Adams", "Verner", "Radau", "RK45", "x", ""),
    "--model": ("four_bar", "x"),
}  # fmt: skip
PATHS = (
    "-o", "--plot", "--member-file", "--cases", "--data", "--tire", "--measured", "--title",
    "--goals", "--bushes",
)  # fmt: skip
CLEAR = (RefusedError,)
STUDY = b"""
[bushings.arm_rear]
radial_N_per_mm = 1000.0
[tolerances]
"hardpoints.tie_rod_inner.z" = 1.0
[free]
"hardpoints.tie_rod_inner.z" = 1.0
[targets.toe]
value = 0.1
within = 1.0
[maximise.camber]
at_mm = 10.0
[limits.bump_steer]
least = -1.0
"""
HELD = (
    b"",
    b"""
[limits.toe_by_lateral]
held = "spring"
most = 1.0
""",
    b"""
[[targets.camber_by_braking]]
held = "x"
value = 0.0
""",
)
MECHANISM = "from kintrafo.generator.mechanisms.four_bar import FOUR_BAR\n"


def attempt(random):
    """Run one command in a folder of files that are somebody's, and look at what is left."""
    with tempfile.TemporaryDirectory() as name, _in(Path(name, "work")) as folder:
        named = _files(random, folder)
        arguments = _arguments(random, named)
        before = _contents(folder)
        code, out, err = run(arguments)
        after = _contents(folder)
    shown = f"{arguments!r}: code {code}, {err[-600:]!r}"
    if code not in (0, 1, 2, 3):
        raise RawError(shown)
    if "Traceback" in out + err or (code and not (out + err).strip()):
        raise RawError(shown)
    if "--force" not in arguments:
        lost = [path for path in before if after.get(path) != before[path]]
        if lost:
            raise WrongError(f"{shown}: changed {lost}")
    elif any(after.get(path) != before[path] for path in before if path.endswith(".py")):
        raise WrongError(f"{shown}: a source was changed by force")
    if any(".kintrafo-" in path for path in after):
        raise WrongError(f"{shown}: left {sorted(after.keys() - before.keys())}")
    if code:
        raise RefusedError(shown)


@contextlib.contextmanager
def _in(folder):
    folder.mkdir()
    here = Path.cwd()
    os.chdir(folder)
    try:
        with mock.patch.dict(os.environ, {"KINTRAFO_CACHE": str(folder.parent / "cache")}):
            yield folder
    finally:
        os.chdir(here)


def _files(random, folder):
    """Fill the folder; return names, of which some are there."""
    (folder / "sub").mkdir()
    (folder / "file").write_text("mine")
    (folder / "link").symlink_to("sub")
    (folder / "circle").symlink_to("circle")
    names = [
        str(random.choice(PLACES))
        + STEMS[random.integers(len(STEMS))]
        + str(random.choice(ENDINGS))
        for _ in range(5)
    ]
    for name in names[:3]:
        # RuntimeError: pathlib's, of links that lead in a circle
        with contextlib.suppress(OSError, RuntimeError):
            path = folder / name
            if path.exists() or folder not in path.resolve().parents:
                continue
            path.write_bytes(_content(random, path.suffix))
    return names


def _content(random, ending):
    if ending == ".py":
        return MECHANISM.encode()
    if ending == ".json":
        return (DATA / "MacPhersonStrut.json").read_bytes()
    if ending == ".sub" or (ending == ".txt" and random.random() < 0.5):
        return (DATA.parent / "adams/front_suspension.sub").read_bytes()
    if ending == ".toml" and random.random() < 0.3:
        return STUDY + HELD[random.integers(len(HELD))]
    if ending == ".csv" and random.random() < 0.5:
        return b"time_s,road_height_mm\n0,0\n0.1,5\n"
    return TEXTS[random.integers(len(TEXTS))]


def _arguments(random, names):
    command = str(random.choice(list(OPTIONS), p=_WEIGHTS))
    arguments = command.split()
    for _ in range(random.choice([0, 1, 1, 1, 1, 2, 2])):
        # the equations of an axle would have to be compiled
        axles = () if command == "simulate" else ("reference_axle",)
        known = str(random.choice((*packaged(), *axles)))
        arguments.append(known if random.random() < 0.4 else names[random.integers(len(names))])
    options = OPTIONS[command]
    for _ in range(random.integers(0, 4)):
        if options:
            option = options[random.integers(len(options))]
            arguments += [option, *_value(random, option, names)]
    if command == "characteristics" and "--step" not in arguments:
        arguments += COARSE
    if command == "sensitivity" and "--place" not in arguments:
        arguments += ["--place", "hardpoints.tie_rod_inner.z"]
    arguments += FEW.get(command, ())
    if command == "export":
        arguments += ["--to", str(random.choice(("points", "points", "c", "x")))]
    if command == "sweep":
        arguments.append(str(random.choice(VALUES)))
    if command in ("simulate", "sweep"):
        arguments += ["--duration", "0.02"]
    if random.random() < 0.4:
        arguments.append(FLAGS[random.integers(len(FLAGS))])
    return arguments


_COSTLY = {"report": 0.02, "paper": 0.01, "mechanism derivation": 0.01, "mechanism generate": 0.03,
           "compare": 0.05, "characteristics": 0.05}  # fmt: skip
_WEIGHTS = [
    _COSTLY.get(name, (1.0 - sum(_COSTLY.values())) / (len(OPTIONS) - len(_COSTLY)))
    for name in OPTIONS
]


def _value(random, option, names):
    if option in (
        "--json",
        "--free-rack",
        "--numpy",
        "--axle",
        "--mirror",
        "--left-handed",
        "--points-only",
        "--positions",
    ):
        return []
    if option in WORDS:
        return [str(random.choice(WORDS[option]))]
    if option in PATHS:
        return [names[random.integers(len(names))]]
    return [str(random.choice(NUMBERS))]


def _contents(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and not path.is_symlink()
    }


def run(arguments):
    """Run a command line in this process; return exit code, stdout and stderr."""
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2)]
    code = 0
    with (
        mock.patch.object(sys, "argv", ["kintrafo", *arguments]),
        mock.patch.object(sys, "stdout", streams[0]),
        mock.patch.object(sys, "stderr", streams[1]),
    ):
        try:
            cli.run()
        except SystemExit as end:
            code = end.code or 0
    texts = []
    for stream in streams:
        stream.flush()
        texts.append(stream.buffer.getvalue().decode("utf-8", "replace"))
    return (code if isinstance(code, int) else -1), *texts
