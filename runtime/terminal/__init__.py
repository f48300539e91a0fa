"""Output and exit codes of any command line."""
