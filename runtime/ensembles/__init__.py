"""Many systems simulated at once, each with parameters, start and inputs of its own."""

from .ensemble import ensemble

__all__ = ["ensemble"]
