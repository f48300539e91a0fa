"""Packaged axles described in one file with both wheels; each is named after its kind."""
