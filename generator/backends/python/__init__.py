"""The Python interface of a model."""
