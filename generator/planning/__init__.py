"""The planner with the catalogue of closed forms, and proposals of coordinates."""
