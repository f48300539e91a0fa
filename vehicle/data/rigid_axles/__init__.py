"""Rigid axles that come with the project."""
