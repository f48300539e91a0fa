"""Packaged manoeuvres."""
