"""The plan of a model."""

from ..loops.planner import Plan

__all__ = ["Plan"]
