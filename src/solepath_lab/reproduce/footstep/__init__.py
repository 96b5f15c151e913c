"""The experiments of Liu et al. 2015: one module for each, with its walks and its scores."""
