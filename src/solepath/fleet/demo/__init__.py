"""Demonstration: a fleet of emulated wearers on bytewax, killed, restarted, and compared with an uninterrupted run."""
