"""The sentence on how an extra of this package is installed, which every message about a missing library ends with."""

from __future__ import annotations


def install_hint(extra: str) -> str:
    """Return what installs an extra, for a person with a clone of the sources and for one with an installed package."""
    clone, package = f"pip install '.[{extra}]'", f"pip install 'solepath[{extra}]'"
    return f"install the extra {extra} (in a clone: {clone}; otherwise: {package})"
