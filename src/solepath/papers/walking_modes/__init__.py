"""Gong et al. 2023: each foot's position relative to the other at touchdown, compensated by walking mode."""
