"""The table of sensors that fail in mid-walk: what holds, and what a session says a minute after a fault."""

from __future__ import annotations

import pytest

from solepath_lab.damage import faults
from solepath_lab.damage.faults import FAULTS, Failing, Failure, examine, table


@pytest.mark.parametrize(
    ("error", "half_axis", "inside", "holds"),
    [(2.0, 1.0, False, True), (4.0, 5.0, True, True), (4.0, 5.0, False, False), (4.0, 7.0, True, False)],
    ids=["near", "inside a small ellipse", "outside", "inside a large ellipse"],
)
def test_a_position_holds_that_is_near_or_knows_how_far_it_may_be(
    error: float, half_axis: float, inside: bool, holds: bool
) -> None:
    failure = Failure("seed 1", "gyroscope stuck", 20.0, error, half_axis, inside, 0.5)
    assert failure.holds is holds
    sound = [Failure("seed 1", name, t, 0.0, 1.0, True, None) for name in FAULTS for t in (1.0, 20.0)]
    (row,) = [line for line in table([failure, *sound[:-1]]) if line.startswith("| gyroscope stuck")]
    assert [cell.strip() for cell in row.split("|")[2:4]] == ["2", "100.0" if holds else "50.0"]


@pytest.mark.long
def test_a_walk_holds_with_each_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(faults, "INSTANTS", 2)
    failures = examine(Failing(600))
    assert len(failures) == 2 * len(FAULTS)
    assert all(failure.holds for failure in failures)
    assert {failure.named is not None for failure in failures if failure.fault == "all values stuck"} == {True}
