"""Suspensions, axles and cars that several tests use, and files of them."""
