"""The correctors of a swing after Chen et al. 2019: linear drift removed, rolling velocities known or as evidence."""
