"""Independent oracles for the equations: redundant coordinates, Newton, multipliers."""
