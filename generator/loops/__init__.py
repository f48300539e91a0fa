"""Loops of a mechanism: the joint graph, known coordinates, and the order of solution."""
