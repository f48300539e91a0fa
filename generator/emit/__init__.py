"""Printers, one a target: C, Cython, the derivation report, the picture of the joint graph."""
