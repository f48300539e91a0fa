"""What another process does, for tests: in a file that imports little, since each one does so."""

import kintrafo
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR


def simulated_end(start: float) -> list[float]:
    """Compile and simulate a mechanism; return its last state."""
    system = kintrafo.System(kintrafo.compile(FOUR_BAR))
    end = kintrafo.simulate(system, (0.0, 0.5), system.state(crank_angle=start)).y[:, -1]
    return [float(number) for number in end]


def what_is_needed() -> None:
    """Import what deriving, compiling and simulating import when they are first asked for."""
    import kintrafo.generator.backends.files
    import kintrafo.generator.equations.outputs
    import kintrafo.simulation.simulate  # noqa: F401
