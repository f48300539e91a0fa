"""Simulation of a system: inputs over time, integration, events and results."""
