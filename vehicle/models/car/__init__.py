"""Cars: files and equations of motion."""

from .car import Car

__all__ = ["Car"]
