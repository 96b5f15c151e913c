"""Walks of the experiment of Gong et al. 2023, and its figures."""
