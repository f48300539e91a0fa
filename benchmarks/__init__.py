"""Measurements outside the test suite: ``python -m benchmarks`` writes to ``out/benchmark/``.

paper_timing
    The paper's protocol: Runge-Kutta that steps onto every output against Gear's method.
work_precision
    Free steps: what each method costs for the accuracy that it reaches.
report
    Tables, JSON, the machine, and how times are taken.
"""
