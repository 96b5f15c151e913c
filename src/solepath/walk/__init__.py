"""One walk: what a session was fed and what it reported, counted and kept once for every kind of output."""

from .walk import Walk

__all__ = ["Walk"]
