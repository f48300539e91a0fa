"""Description of a model, as data."""
