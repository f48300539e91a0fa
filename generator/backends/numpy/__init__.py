"""Python over NumPy arrays, for where there is no compiler."""
