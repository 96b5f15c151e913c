"""The experiments of Li et al. 2016: their walks, the recipes that are compared, scores of strides, and figures."""
