"""The planner with the catalogue of closed forms in its hands, and proposals of coordinates."""
