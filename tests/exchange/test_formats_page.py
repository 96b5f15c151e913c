"""The program for OpenSim of docs/formats.md runs, and the commands do what the page says."""

import pytest
import walks
from programs import run
from quoted import run_page
from recordings import recorded


def test_a_walk_of_the_page_goes_to_opensim(tmp_path) -> None:
    _, names = run_page("docs/formats.md", programs=slice(4, None))
    source = recorded(tmp_path / "walk.jsonl", walks.insoles().packets)
    assert names["to_opensim"](str(source), str(tmp_path / "walk.sto")) > 350


@pytest.mark.soak
def test_the_official_programs_read_what_convert_writes(tmp_path) -> None:
    pytest.importorskip("opensim", reason="the extra opensim is not installed")
    pytest.importorskip("bids_validator_deno", reason="the extra bids is not installed")
    source = recorded(tmp_path / "walk.jsonl", walks.insoles().packets)
    done = run("convert", source, tmp_path / "walk.sto", "--validate")
    assert done.stdout.splitlines()[-1].endswith(" rows of calcn_l_imu, calcn_r_imu")
    done = run("convert", source, tmp_path / "study", "--subject", "01", "--validate")
    assert "the validator of BIDS: 0 errors, " in done.stdout
    (tmp_path / "study" / "sub-01" / "notes.txt").write_text("x")
    done = run("convert", source, tmp_path / "study", "--subject", "02", "--validate", expect=1)
    assert "notes.txt" in done.stdout and "the validator of BIDS: 1 errors" in done.stdout
