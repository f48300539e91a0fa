"""What another process does, for tests: in a file that imports little, since each one does so."""

import kintrafo
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR


def simulated_end(start: float) -> list[float]:
    """Compile and simulate a mechanism; return its last state."""
    system = kintrafo.System(kintrafo.compile(FOUR_BAR))
    end = kintrafo.simulate(system, (0.0, 0.5), system.state(crank_angle=start)).y[:, -1]
    return [float(number) for number in end]
