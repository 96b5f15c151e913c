"""The building: levels with walls and doors, the stairs and lifts between them, and one fast crossing test."""
