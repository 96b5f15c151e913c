"""Files that take an earlier run's place: nothing of them is left, whenever the run is ended."""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path

import pytest

from solepath.cli.common.files import Replacing


def test_a_file_interrupted_as_it_is_made_is_thrown_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = Replacing()
    made = Path.open

    def interrupted(*arguments: object) -> None:
        made(*arguments).close()  # type: ignore[call-overload]
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "open", interrupted)
    with pytest.raises(KeyboardInterrupt):
        files.beside(tmp_path / "track.csv")
    monkeypatch.undo()
    assert len(list(tmp_path.iterdir())) == 1
    files.drop()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kept", [True, False])
def test_a_file_is_there_as_it_was_until_it_is_kept(kept: bool, tmp_path: Path) -> None:
    earlier = tmp_path / "track.csv"
    earlier.write_text("earlier")
    files = Replacing()
    files.beside(earlier).write_text("later")
    assert earlier.read_text() == "earlier"
    if kept:
        files.keep()
    files.drop()
    assert earlier.read_text() == ("later" if kept else "earlier")
    assert list(tmp_path.iterdir()) == [earlier]


def test_another_programs_file_is_not_thrown_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two machines that share a directory may give two programs the same number."""
    files = Replacing()
    monkeypatch.setattr("solepath.cli.common.files._numbers", count(7))
    another = tmp_path / f".solepath-{os.getpid()}-7.part"
    another.write_text("half of a track")
    with pytest.raises(OSError, match=r"track\.csv"):
        files.beside(tmp_path / "track.csv")
    files.drop()
    assert another.read_text() == "half of a track"
