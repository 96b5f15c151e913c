"""The session, which an app holds: one wearer, packets or samples in, events out."""

from .session import A_NUMBER, Session

__all__ = ["A_NUMBER", "Session"]
