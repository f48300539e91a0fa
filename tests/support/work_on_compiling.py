"""Work of another process in tests, in a file with few imports, since each process repeats them."""

import kintrafo
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR


def simulated_end(start):
    """Compile and simulate a mechanism; return its last state."""
    system = kintrafo.System(kintrafo.compile(FOUR_BAR))
    end = kintrafo.simulate(system, (0.0, 0.5), system.state(crank_angle=start)).y[:, -1]
    return [float(number) for number in end]


def what_is_needed():
    """Import the modules that derivation, compilation and simulation import at first use."""
    import kintrafo.generator.backends.files
    import kintrafo.generator.equations.outputs
    import kintrafo.simulation.simulate  # noqa: F401
