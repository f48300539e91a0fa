"""Mechanisms that tests declare: of every closed form, of loops that iterate, of random sizes."""
