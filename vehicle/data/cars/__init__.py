"""Packaged cars."""
