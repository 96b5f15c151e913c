"""Soles and heels as they are worn: where they differ from rigid ones that roll without slip."""
