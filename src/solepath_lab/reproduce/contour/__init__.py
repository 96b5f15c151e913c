"""The half-hour walks of Bebek et al. 2010: their loops, the velocity of the heel in each stance, and figures."""
