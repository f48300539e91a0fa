"""Fuzzers: every way into kintrafo is tried with what a person, or an attacker, might give it."""
