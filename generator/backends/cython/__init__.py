"""What links the C code to Python by Cython."""
