"""The session that an app holds for one wearer: it takes packets or samples and returns events."""

from .session import Session

__all__ = ["Session"]
