"""The building: levels with walls and doors, the stairs and lifts between them, and a fast test for crossed walls."""
