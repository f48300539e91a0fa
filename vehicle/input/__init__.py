"""Sections of input files, and their checks."""
