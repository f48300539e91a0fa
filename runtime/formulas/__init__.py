"""Formulas that are evaluated on arrays and written into equations of motion, from one text.

`arithmetic`       the functions that a formula may use, and NumPy's
`magic_formula`    forces of a rolling contact by the Magic Formula
`tmeasy`           the same by TMeasy
`linear_contact`   the same, linear in slip up to the friction

A formula imports neither NumPy nor SymPy: it is handed an `Arithmetic`. The generator has one whose
results are steps of a program, so that their derivatives are exact.
"""
