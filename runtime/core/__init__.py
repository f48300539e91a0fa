"""Errors, checks of arguments, files, units: the modules on which every other folder depends."""
