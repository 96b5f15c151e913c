"""CITATION.cff is valid, and agrees with the package that it cites."""

from __future__ import annotations

import tomllib

import pytest
from here import ROOT

pytest.importorskip("check_jsonschema", reason="check-jsonschema is not installed")
from ruamel.yaml import YAML  # noqa: E402 - comes with check-jsonschema

CITATION = ROOT / "CITATION.cff"


def test_the_citation_names_this_version_and_licence() -> None:
    about = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    citation = YAML(typ="safe").load(CITATION)
    assert citation["title"].startswith(about["name"])
    assert (citation["version"], citation["license"]) == (about["version"], about["license"])
    assert citation["authors"][0]["name"] in (ROOT / "LICENSE").read_text("utf-8")
