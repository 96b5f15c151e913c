"""Chen et al. 2019: velocity known while the shoe rolls over heel and forefoot, and strides of both feet fused."""
