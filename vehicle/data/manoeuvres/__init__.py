"""Manoeuvres that come with the project."""
