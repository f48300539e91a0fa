"""Python for JAX: arrays under jit, vmap and grad."""
