"""Axles that come with the project whose file is of both wheels: one a sort, with its name."""
