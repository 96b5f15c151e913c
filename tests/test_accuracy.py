"""How accurate the default recipe is on recorded data: the figures that the README quotes, with their bounds."""

from solepath.evaluate.report import Result
from solepath.evaluate.score import Scored, Summary


def scores(results: list[Result], data_set: str) -> tuple[dict[str, Scored], Summary]:
    """The scores of each recording by its name, and the summary of all."""
    (result,) = (result for result in results if result.data_set.name == data_set)
    assert not result.failures
    return {score.recording: score for score in result.scores}, result.summaries[0]


def test_vicon_tracks_of_28_trials_with_one_causal_configuration(results):
    trials, summary = scores(results, "pyshoe_vicon")
    assert len(trials) == 28
    assert summary.mean["armse_2d"] <= 0.20
    assert summary.median["armse_2d"] <= 0.12


def test_every_surveyed_stride_is_found_and_its_length_known(results):
    walks, _ = scores(results, "gumushane_surveyed")
    for name in ("exp31", "exp33", "exp37"):
        strides = walks[name].strides
        assert (strides.n_found, strides.n_invented) == (strides.n_true, 0), name
        assert strides.mean_error <= 0.035, name


def test_a_closed_loop_of_60_m_ends_near_its_start(results):
    walks, _ = scores(results, "xio_closed_walks")
    assert walks["long_walk"].figures["end_error"] <= 0.9


def test_contacts_of_both_feet_are_found_in_spite_of_radio_losses(results):
    _, summary = scores(results, "ipol_10m_uturn")
    for kind in ("heel_strike", "toe_off"):
        assert summary.together[f"{kind}_f1"] >= 0.95
        assert abs(summary.together[f"{kind}_bias"]) <= 0.06
