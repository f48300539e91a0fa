"""Equations of motion, and the functions that are emitted."""
