"""Building the program for this machine and for the board, and running it."""

import math
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import kintrafo
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.systems.system import System
from kintrafo.targets.emitted import Emitted

HERE = Path(__file__).parent
COMPILER, EMULATOR = "arm-none-eabi-gcc", "qemu-system-arm"
PACKAGES = "gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm"
"""The packages of Debian that have these."""

FUNCTIONS = ("rhs", "rhs_jacobian", "signals", "margins")
UNITS = {
    "fpv5-d16": ("-mfpu=fpv5-d16", "-mfloat-abi=hard"),
    "none": ("-mfloat-abi=soft",),
}
"""Units of floating point: that of the processor for doubles, or none: the compiler's library."""

_FLAGS = (
    "-std=c99", "-O2", "-ffp-contract=off", "-fno-math-errno",
    "-Wall", "-Wextra", "-Wpedantic", "-Werror",
)  # fmt: skip
_BOARD = (
    "-mcpu=cortex-m7", "-mthumb", "-ffunction-sections", "-fdata-sections", "-DBOARD",
)  # fmt: skip
_MACHINE = ("-M", "mps2-an500", "-nographic", "-monitor", "none", "-serial", "none")
_COUNTING = ("-icount", "shift=5", "-semihosting-config", "enable=on,target=native")
_LONGEST_S = 60.0


def missing() -> list[str]:
    """Return the programs that are not installed."""
    return [name for name in (COMPILER, EMULATOR) if shutil.which(name) is None]


@dataclass(frozen=True)
class Measured:
    """Output of the board."""

    bits: list[str]  # a line for each function in each state: status, and results in hexadecimal
    instructions: dict[str, int]  # of a call; `thousand` is one of a thousand instructions
    stack: dict[str, int]  # bytes that a call takes of it
    code: int  # bytes of these functions and of all constants


class Program:
    """The functions of exported equations, for this machine and for the board.

    Parameters
    ----------
    system : System
    folder : Path
        Where it is built; it is made.
    """

    def __init__(self, system: System, folder: Path) -> None:
        self.name, self.folder = system.equations.NAME, folder
        code = kintrafo.export_model(system, folder / "c", "c")
        described = Emitted(system, system.design_state, system.inputs()).compiled()
        lengths = {name: math.prod(described[name]["shape"]) for name in FUNCTIONS}
        macros = {
            "VALUES": f'"{code / self.name}_values.h"',
            "EQUATIONS": self.name,
            "FUNCTIONS": " ".join(f"CALL({name}, {size})" for name, size in lengths.items()),
            "LARGEST": str(max(lengths.values())),
            "STATES": str(len(system.state_names)),
        }
        self._defined = [f"-D{macro}={value}" for macro, value in macros.items()]
        ends = ("", "_derivatives", "_values")
        self._sources = [str(code / f"{self.name}{end}.c") for end in ends]
        self._sources.append(str(HERE / "calls.c"))

    def here(self) -> list[str]:
        """Return the bits that this machine computes, see `Measured`."""
        compiler, program = find_compiler(), self.folder / "here"
        assert compiler is not None
        command = [compiler.command[0], *_FLAGS, *self._defined, *self._sources]
        subprocess.run([*command, "-o", str(program), "-lm"], check=True)
        return _printed([str(program)])

    def on_board(self, unit: str) -> Measured:
        """Return what the board computes with a unit of floating point, see `UNITS`."""
        folder = self.folder / unit
        folder.mkdir()
        flags = [*_FLAGS, *_BOARD, *UNITS[unit], *self._defined]
        sources = [*self._sources, str(HERE / "board.c")]
        subprocess.run([COMPILER, *flags, "-c", *sources], check=True, cwd=folder)
        objects = [f"{Path(source).stem}.o" for source in sources]
        linking = [
            "--specs=rdimon.specs",
            "-T",
            str(HERE / "board.ld"),
            "-Wl,--gc-sections,-Map=map",
        ]
        command = [COMPILER, *flags, *objects, *linking, "-o", "program.elf", "-lm"]
        subprocess.run(command, check=True, cwd=folder)
        lines = _printed([EMULATOR, *_MACHINE, *_COUNTING, "-kernel", str(folder / "program.elf")])
        words = [line.split() for line in lines]
        counted, stack = (
            {name: int(number) for kind, name, number, *_ in words if kind == which}
            for which in ("count", "stack")
        )
        bits = [line for line in lines if not line.startswith(("count ", "stack "))]
        return Measured(bits, counted, stack, self._code(folder / "map"))

    def _code(self, table: Path) -> int:
        """Return the size of the linked equations in bytes, from the linker's table."""
        linked = table.read_text(encoding="utf-8").partition("Linker script and memory map")[2]
        found = re.findall(
            rf"^ \.(?:text|rodata)\S*\s+0x\w+\s+(0x\w+) {self.name}\w*\.o$", linked, re.MULTILINE
        )
        return sum(int(size, 16) for size in found)


def _printed(command: list[str]) -> list[str]:
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=_LONGEST_S)
    return done.stdout.splitlines()
