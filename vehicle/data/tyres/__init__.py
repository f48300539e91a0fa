"""Tyres that come with the project: made up for it, none of them was measured."""
