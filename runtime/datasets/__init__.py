"""Results as labelled datasets, and datasets as files."""
