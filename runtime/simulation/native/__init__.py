"""Integration in C by SUNDIALS; present only where that library was found at build time."""
