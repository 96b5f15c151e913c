"""Paths in the checkout."""

from __future__ import annotations

from pathlib import Path

HELPERS = Path(__file__).resolve().parent
TESTS = HELPERS.parent
ROOT = TESTS.parent
PROTOCOL, EXAMPLES, DOCS = ROOT / "protocol", ROOT / "examples", ROOT / "docs"
