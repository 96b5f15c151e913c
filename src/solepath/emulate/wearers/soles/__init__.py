"""How worn soles differ from rigid ones that roll without slip."""
