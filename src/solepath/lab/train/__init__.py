"""Scripts that learn the parameters of the live parts, each from data on which it is never scored.

They may use numpy. Each writes a small readable file beside the part that reads it."""
