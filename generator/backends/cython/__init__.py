"""Links between C code and Python by Cython."""
