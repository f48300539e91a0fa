"""Axles that come with the project."""
