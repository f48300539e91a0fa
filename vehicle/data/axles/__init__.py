"""Packaged axles."""
