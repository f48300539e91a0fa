"""Loops of a mechanism: the joint graph, what is known, and the order of solution."""
