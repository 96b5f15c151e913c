"""Checks of the data of a wearer for what contradicts itself or physics."""
