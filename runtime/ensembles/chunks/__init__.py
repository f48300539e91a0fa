"""An ensemble in chunks of thousands of systems: on other machines, and kept until all are done."""
