"""CITATION.cff is valid, and agrees with the package that it cites."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from here import ROOT

pytest.importorskip("check_jsonschema", reason="check-jsonschema is not installed")
from ruamel.yaml import YAML  # noqa: E402 - comes with check-jsonschema

CITATION = ROOT / "CITATION.cff"


def fault(path: Path) -> str:
    """Return what the schema of the Citation File Format finds wrong with a file; check-jsonschema has the schema."""
    words = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.citation-file-format", str(path)]
    done = subprocess.run(words, capture_output=True, text=True)
    return done.stdout + done.stderr if done.returncode else ""


def test_the_citation_is_valid_by_the_schema_of_its_format() -> None:
    assert fault(CITATION) == ""


def test_the_citation_names_this_version_and_licence() -> None:
    about = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    citation = YAML(typ="safe").load(CITATION)
    assert citation["title"].startswith(about["name"])
    assert (citation["version"], citation["license"]) == (about["version"], about["license"])
    assert citation["authors"][0]["name"] in (ROOT / "LICENSE").read_text("utf-8")
