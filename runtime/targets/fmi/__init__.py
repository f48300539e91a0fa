"""Parts of a functional mock-up unit: description, sources and libraries."""
