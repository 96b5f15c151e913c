"""The session that an app holds for one wearer: it takes packets or samples and returns events."""

from .session import NUMBER_TYPES, Session

__all__ = ["NUMBER_TYPES", "Session"]
