"""examples/two_recipes.ipynb: Jupyter opens it, it is small, without outputs, and runs from the file to the figure."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from here import EXAMPLES, ROOT

from solepath import Foot
from solepath.emulate import Route, Walker

nbformat = pytest.importorskip("nbformat", reason="the extra notebook is not installed")
nbclient = pytest.importorskip("nbclient", reason="the extra notebook is not installed")
pytest.importorskip("ipykernel", reason="the extra notebook is not installed")
NOTEBOOK = EXAMPLES / "two_recipes.ipynb"


def executed(folder: Path, monkeypatch: pytest.MonkeyPatch, file: str = "walk.jsonl") -> Any:
    """Return the notebook after Jupyter's client has run all of its cells on a file in the folder."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT / "src"), os.environ.get("PYTHONPATH", "")]))
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    for cell in notebook.cells:
        cell.source = cell.source.replace('"walk.jsonl"', repr(file))
    return nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(folder)}}).execute()


def printed(notebook: Any) -> str:
    """Return what the cells print and show as text."""
    outputs = [one for cell in notebook.cells for one in cell.get("outputs", ())]
    return "\n".join(one.get("text") or one.get("data", {}).get("text/plain", "") for one in outputs)


def test_it_is_a_valid_notebook_without_outputs() -> None:
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    for cell in notebook.cells:
        assert not cell.get("outputs") and cell.get("execution_count") is None
    assert NOTEBOOK.stat().st_size < 12_000


@pytest.mark.long
def test_it_runs_from_an_emulated_walk_to_a_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    notebook = executed(tmp_path, monkeypatch)
    text = printed(notebook)
    assert "GaitCycleMeasured" in text and "1/min" in text and "limits of agreement" in text and "version" in text
    kinds = {kind for cell in notebook.cells for one in cell.get("outputs", ()) for kind in one.get("data", ())}
    assert "image/png" in kinds and "text/html" in kinds
    assert not [one for cell in notebook.cells for one in cell.get("outputs", ()) if one.get("name") == "stderr"]
    assert (tmp_path / "walk.jsonl").stat().st_size > 100_000 and (tmp_path / "two_recipes.png").is_file()


@pytest.mark.long
def test_of_samples_without_cells_it_says_what_a_recipe_cannot_do_and_compares_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    columns: dict[str, Any] = {}
    for foot in Foot:
        samples = Walker(Route().stand(2.0).walk(25.0, 1.3).stop(2.0), seed=1).samples(foot, 100.0)
        columns |= {f"{name}_{foot}": [getattr(one, name) for one in samples] for name in ("t", "acc", "gyro")}
    np.savez(tmp_path / "walk.npz", **columns)
    text = printed(executed(tmp_path, monkeypatch, "walk.npz"))
    assert "zupt: no strides, so that another recipe is compared" in text and "shoe-sensing - default" in text
    assert "nan" not in text.lower().replace("nans", "") and "zupt: " in text.replace("zupt: no strides", "")
