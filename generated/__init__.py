"""Compiled models. Written by ``make generate``; do not edit.

Each module is one model: ``from kintrafo.generated import macpherson``.
"""
