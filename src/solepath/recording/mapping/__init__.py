"""Mappings: what the columns of a table of samples mean, from options, a file, a known format, or Python."""

from .file import read_mapping
from .mapping import TableMapping

__all__ = ["TableMapping", "read_mapping"]
