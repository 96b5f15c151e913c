"""Skin moves over the bones as the literature has it: some degrees and centimetres at the thigh, none in standing."""

from __future__ import annotations

import numpy as np
import pytest

from solepath.emulate.routes.laps import straight
from solepath.emulate.sensors.soft_tissue import tissue_constants
from solepath.emulate.sensors.suit import limb_samples, worn_body
from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.gait import SUBJECTS, Wearer
from solepath.emulate.wearers.walker import Walker
from solepath.types import Site

THIGHS, SHANKS = (Site.LEFT_THIGH, Site.RIGHT_THIGH), (Site.LEFT_SHANK, Site.RIGHT_SHANK)


def motion_of_skin(wearer: Wearer, site: Site, t: Array, seed: int = 1) -> tuple[Array, Array]:
    """Return by how far the skin of a site is turned, degrees, and moved, mm, from the bone at times `t`, s."""
    walker = Walker(straight(6.0), wearer, seed=2)
    (p, r), (q, s) = walker.body.segment(site, t), worn_body(walker, walker.body, seed).segment(site, t)
    cosines = 0.5 * (np.einsum("nij,nij->n", r, s) - 1.0)
    return np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))), 1e3 * np.linalg.norm(q - p, axis=1)


def test_while_the_wearer_stands_the_skin_is_where_it_was_when_the_sensors_were_strapped_on() -> None:
    for site in (*THIGHS, *SHANKS, Site.PELVIS):
        turned, moved = motion_of_skin(SUBJECTS[0], site, np.linspace(0.2, 1.0, 20))
        assert turned.max() < 0.3 and moved.max() < 1.0


def test_in_walking_the_thigh_moves_most_and_all_of_it_as_much_as_fluoroscopy_has_it() -> None:
    t = np.linspace(3.0, 6.0, 200)
    most = {
        sites: [max(one.max() for one in ones) for ones in zip(
            *(motion_of_skin(wearer, site, t) for wearer in SUBJECTS for site in sites), strict=True)]
        for sites in (THIGHS, SHANKS)
    }  # fmt: skip
    assert 4.0 < most[THIGHS][0] < 12.0 and 5.0 < most[THIGHS][1] < 30.0
    assert 2.0 < most[SHANKS][0] < 10.0 and 5.0 < most[SHANKS][1] < 30.0
    for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT):
        turned, moved = motion_of_skin(SUBJECTS[0], site, t)
        assert turned.max() < 1e-4 and moved.max() < 1e-9


def test_a_wearer_keeps_most_of_it_when_the_sensors_are_strapped_on_again() -> None:
    again, others = [], []
    for number in range(40):
        first, second, other = (
            tissue_constants(number, 1),
            tissue_constants(number, 2),
            tissue_constants(number + 100, 1),
        )
        for site in THIGHS:
            again.append((first[site].load_turn[1], second[site].load_turn[1]))
            others.append((first[site].load_turn[1], other[site].load_turn[1]))
    assert np.corrcoef(np.array(again).T)[0, 1] > 0.6
    assert abs(np.corrcoef(np.array(others).T)[0, 1]) < 0.4


@pytest.mark.parametrize("scale", [0.0, 2.0])
def test_a_study_may_take_it_away_or_double_it(scale: float) -> None:
    usual, scaled = tissue_constants(3, 4), tissue_constants(3, 4, scale)
    assert set(scaled) == (set(usual) if scale else set())
    for site, constants in scaled.items():
        assert constants.knee_turn == pytest.approx([scale * value for value in usual[site].knee_turn])


def test_attitudes_alone_are_those_of_whole_samples() -> None:
    walker = Walker(straight(2.0), SUBJECTS[0], seed=2)
    whole, alone = (
        [
            s
            for s in limb_samples(walker, 25.0, attitude=None, errors=None, limb_attitudes_only=only)
            if s.site in SHANKS
        ]
        for only in (False, True)
    )
    for one, other in zip(whole, alone, strict=True):
        assert one.quat is not None and other.quat is not None and one.acc is not None and other.acc is None
        assert abs(float(np.dot(one.quat, other.quat))) == pytest.approx(1.0, abs=1e-12)
