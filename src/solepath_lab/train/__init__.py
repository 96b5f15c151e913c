"""Scripts that learn the parameters of parts, each from data on which the part is never scored.

They may use numpy. Each writes a small text file beside the part that reads it, or prints the numbers."""
