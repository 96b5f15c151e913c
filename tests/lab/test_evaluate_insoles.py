"""Contacts and strides of both insoles, in a data set made of an emulated walk whose vendor is always right."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from walks import columns_of

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.recipes import DEFAULT
from solepath.types import Foot
from solepath_lab.evaluate.jobs import evaluate
from solepath_lab.measures.score import Scored

ROUTE = Route().stand(2.0).walk(4.0, speed=0.8).walk(6.0, speed=1.6).stop(1.5)
"""A walk whose later strides are much longer, so that no stride has the length of the next one."""


@pytest.fixture(scope="module")
def insoles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a recording in which the vendor leaves out the lengths of each foot's last two strides."""
    walker, columns = Walker(ROUTE), dict[str, np.ndarray]()
    for foot in Foot:
        contacts, offs = walker.truth().feet[foot].heel_strikes, walker.truth().feet[foot].toe_offs
        # the stride that starts with a contact is the one after it
        lengths = [stride.length for stride in walker.truth().strides(foot)[1:]]
        columns |= {f"{key}_{foot.value}": values for key, values in columns_of(walker, foot).items()}
        columns |= {f"gt_ic_{foot.value}": np.array(contacts), f"gt_to_{foot.value}": np.array(offs)}
        columns[f"gt_stride_length_{foot.value}"] = np.array([*lengths[:-1], np.nan, np.nan])
    folder = tmp_path_factory.mktemp("data") / "moticon_opengo"
    folder.mkdir()
    np.savez(folder / "normal.npz", **columns)
    entries = {"normal": {"keys": {key: [] for key in columns}}, "events": {"keys": {}}}
    (folder / "dataset.json").write_text(json.dumps({"recordings": entries}))
    return folder.parent


@cache
def scored(folder: Path, data_set: str) -> Scored:
    (result,) = evaluate(folder, [DEFAULT], only=[data_set])
    assert not result.failures
    (score,) = result.scores
    return score


def test_contacts_of_both_insoles_are_those_of_the_walk(insoles: Path) -> None:
    events = scored(insoles, "moticon_opengo").events
    truth = Walker(ROUTE).truth().feet
    assert events["heel_strike"].n_true == sum(len(foot.heel_strikes) for foot in truth.values())
    assert events["heel_strike"].f1 == events["toe_off"].f1 == 1.0
    assert max(abs(offset) for kind in events.values() for offset in kind.offsets) < 0.05


def test_a_stride_has_the_length_that_the_vendor_gives_for_the_contact_before_it(insoles: Path) -> None:
    score = scored(insoles, "moticon_opengo")
    assert score.strides is not None and score.strides.n_invented == 0
    # the first stride ends with the first contact: it starts with none and has no length
    assert score.strides.n_found == score.strides.n_true == score.events["heel_strike"].n_true - len(Foot)
    assert len(score.strides.errors.values) == score.strides.n_true - len(Foot)
    assert max(abs(error) for error in score.strides.errors.values) < 0.05
    assert len(score.errors["stride_time"].values) == score.strides.n_true
