"""Gong et al. 2023: each foot measured from the other at touchdown, compensated by walking mode; seven sensors."""
