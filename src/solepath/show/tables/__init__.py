"""Puts counts and gait parameters into tables, sentences, a floor plan and the live terminal."""
