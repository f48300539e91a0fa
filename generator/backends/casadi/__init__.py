"""Python for CasADi: functions over SX."""
