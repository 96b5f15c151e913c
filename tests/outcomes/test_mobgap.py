"""Bouts and outcomes of random strides are those of mobgap itself, where it is installed (Python 3.10 on).

It is no extra of solepath: `pip install mobgap numpydoc` beside it, then `pytest tests/outcomes/test_mobgap.py`."""

from __future__ import annotations

from random import Random
from typing import Any

import pytest
from attrs import asdict
from strides import cycle, cycles

from solepath import GaitCycleMeasured
from solepath.show.outcomes import implausible, mobility_outcomes, walking_bouts
from solepath.show.outcomes.mobility import LIMITS
from solepath.types import Foot

pd: Any = pytest.importorskip("pandas")
wba: Any = pytest.importorskip("mobgap.wba", reason="mobgap is not installed")
aggregation: Any = pytest.importorskip("mobgap.aggregation", reason="mobgap is not installed")

COLUMNS = {
    "stride_duration": "stride_duration_s",
    "cadence": "cadence_spm",
    "stride_length": "stride_length_m",
    "walking_speed": "walking_speed_mps",
}
FACTORS = {"walkdur_all_sum": 1.0 / 60.0}
"""Factors from the units here to those of mobgap: minutes of walking."""


def wandering(seed: int) -> list[GaitCycleMeasured]:
    """Return strides with pauses, with some that are too long or too small or not seen, and a bout of giant ones."""
    rng, found, t = Random(seed), [], 0.0
    for _ in range(40):
        pace, size = rng.uniform(0.9, 1.6), rng.choice([0.5, 1.0, 1.4, 2.6])
        for _ in range(rng.choice([1, 3, 8, 30, 70])):
            for foot, offset in ((Foot.LEFT, 0.0), (Foot.RIGHT, 0.5 * pace)):
                time = pace * rng.choice([1.0, 1.0, 1.0, 1.02, 0.98, 2.2])
                length = size * rng.choice([1.0, 1.0, 1.05, 0.95, 0.05])
                if rng.random() < 0.95:
                    found.append(cycle(foot, round(t + offset, 2), round(time, 2), length))
            t += pace
        t += rng.choice([0.0, 2.0, 3.0, 3.5, 20.0])
    return [*found, *cycles(Foot.LEFT, t + 10.0, [1.2] * 40, 2.6)]


@pytest.mark.parametrize("seed", range(2))
def test_bouts_and_outcomes_are_those_of_mobgap(seed: int) -> None:
    walked = wandering(seed)
    table = pd.DataFrame(
        [
            {
                "start": round(100 * c.t_start), "end": round(100 * c.t), "foot": c.foot.value,
                "stride_duration_s": c.stride_time, "stride_length_m": c.stride_length, "cadence_spm": c.cadence,
                "walking_speed_mps": c.speed,
            }
            for c in walked
        ]
    )  # fmt: skip
    table.index.name = "stride"
    selected = wba.StrideSelection().filter(table, sampling_rate_hz=100.0).filtered_stride_list_
    theirs = wba.WbAssembly().assemble(selected, sampling_rate_hz=100.0)
    strides = theirs.annotated_stride_list_
    ours = walking_bouts(walked)
    assert len(ours) > 5
    assert [(round(100 * b.t_start), round(100 * b.t_end), b.strides) for b in ours] == [
        (group["start"].min(), group["end"].max(), len(group)) for _, group in strides.groupby("wb_id")
    ]
    means = strides.groupby("wb_id")[list(COLUMNS.values())].mean()
    for name, column in COLUMNS.items():
        assert [getattr(bout, name) for bout in ours] == pytest.approx(means[column].tolist())
    dmos = means.assign(
        duration_s=[b.duration for b in ours], n_raw_initial_contacts=[b.steps for b in ours], n_turns=0
    )
    mask = pd.DataFrame(
        {COLUMNS[name]: [name not in implausible(b) for b in ours] for name in LIMITS}, index=dmos.index
    )
    assert not mask.to_numpy().all()
    mask = mask.reindex(columns=dmos.columns, fill_value=True)
    grouped, grouped_mask = (one.assign(person=1).set_index("person", append=True) for one in (dmos, mask))
    aggregator = aggregation.MobilisedAggregator(groupby=["person"], use_original_names=True)
    (row,) = aggregator.aggregate(grouped, wb_dmos_mask=grouped_mask).aggregated_data_.to_dict("records")
    outcomes = asdict(mobility_outcomes(ours))
    assert row.keys() == outcomes.keys()
    for name, value in row.items():
        expected = outcomes[name]
        if name == "wb_1030_sum" and expected == 0:  # the one count for which mobgap has no 0
            expected = None
        assert pd.isna(value) if expected is None else value == pytest.approx(expected * FACTORS.get(name, 1.0)), name
