"""What prints a derived model: a folder for each target."""
