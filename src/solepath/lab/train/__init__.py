"""Scripts that learn the parameters that the live parts ship with, each from data that it is never scored on.

They may use numpy; what they write is a small readable file beside the part that reads it.
"""
