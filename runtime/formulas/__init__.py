"""Formulas that are evaluated on arrays and written into equations of motion, from one source.

A formula imports neither NumPy nor SymPy: its argument is an `Arithmetic`. The generator has one
whose results are steps of a program, so that their derivatives are exact.
"""
