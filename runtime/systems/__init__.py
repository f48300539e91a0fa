"""Equations with values of their parameters, and analyses of any mechanism."""
