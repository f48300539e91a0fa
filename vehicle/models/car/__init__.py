"""A car: its file, its equations of motion, and its state of rest."""

from .car import Car

__all__ = ["Car"]
