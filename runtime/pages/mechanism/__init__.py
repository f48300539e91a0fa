"""Pages of any mechanism: a report with sliders, and a motion to play."""
