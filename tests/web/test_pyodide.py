"""The package of Pyodide: it is fetched once, checked by its hash, and its absence is said in one sentence."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from solepath.cli.main import main
from solepath.show.web import pyodide
from solepath.show.web.pyodide import BuildError, package_files
from solepath.show.web.serve import serving
from solepath.show.web.site import MARK, build_site, write_site


def test_another_package_than_the_pinned_one_is_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    manifest = {"name": "pyodide", "version": pyodide.VERSION}
    (tmp_path / "package").mkdir()
    (tmp_path / "package" / "package.json").write_text(json.dumps(manifest))
    shutil.make_archive(str(tmp_path / "other"), "gztar", tmp_path, "package")
    with serving(tmp_path) as address:
        about = {"versions": {pyodide.VERSION: {**manifest, "dist": {"tarball": f"{address}other.tar.gz"}}}}
        (tmp_path / "pyodide").write_text(json.dumps(about))
        monkeypatch.setenv("NPM_CONFIG_REGISTRY", address)
        with pytest.raises(BuildError, match="its hash is another"):
            package_files()


def test_a_folder_with_other_files_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(BuildError, match="no site that solepath wrote"):
        build_site(tmp_path, ())
    assert main(["web", str(tmp_path)]) == 2
    assert "no site that solepath wrote" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_a_new_build_replaces_its_own_files_and_leaves_those_that_a_person_added(tmp_path: Path) -> None:
    def site(*names: str) -> dict[str, bytes]:
        return {MARK: json.dumps({"files": [MARK, *names]}).encode()} | {name: b"new" for name in names}

    write_site(tmp_path, site("a.js", "b.js"))
    (tmp_path / "CNAME").write_text("gait.example")
    (tmp_path / "c.js").write_text("mine")
    with pytest.raises(BuildError, match="c.js: exists, and was not written by solepath"):
        write_site(tmp_path, site("a.js", "c.js"))
    assert (tmp_path / "c.js").read_text() == "mine" and (tmp_path / "b.js").exists()
    write_site(tmp_path, site("a.js"))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["CNAME", "a.js", "c.js", MARK]


def test_a_list_of_files_never_reaches_out_of_its_folder(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "mine.txt").write_text("mine")
    names = [MARK, "", "..", "../mine.txt", str(tmp_path / "mine.txt")]
    (tmp_path / "out" / MARK).write_text(json.dumps({"files": names}))
    write_site(tmp_path / "out", {MARK: b"{}"})
    assert (tmp_path / "mine.txt").exists()
