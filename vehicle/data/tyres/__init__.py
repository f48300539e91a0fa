"""Packaged tyres; their coefficients are invented, not measured."""
