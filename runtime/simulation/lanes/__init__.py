"""Integration of many systems of one model, in the lanes of vectors and on all cores."""
