"""A fleet of emulated wearers on bytewax, killed and restarted, and what came of it beside an uninterrupted run."""
