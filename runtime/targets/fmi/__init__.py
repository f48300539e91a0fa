"""Parts of a functional mock-up unit (FMU): description, sources and libraries."""
