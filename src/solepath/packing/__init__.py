"""The packed form of a session's state: small, quick, and bit for bit. protocol/snapshot.md has its bytes."""
