"""The derivation as text and picture."""
