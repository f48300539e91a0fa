"""The Python face of a model."""
