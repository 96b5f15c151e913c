"""A walk as one file that can be mailed: figures and the gait table."""
