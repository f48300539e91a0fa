"""Printers of a derived model: a folder for each target."""
