"""Walks of the experiment of Chen et al. 2019, and what is measured in them."""
