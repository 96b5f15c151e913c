"""The table of the figures without each part of the default recipe."""

from solepath.lab.evaluate.ablation import ABLATED_RECIPES, recipes
from solepath.lab.evaluate.datasets import DATASETS, EMULATED
from solepath.lab.evaluate.report import Result
from solepath.lab.measures.matching import Matching
from solepath.lab.measures.score import Scored
from solepath.lab.tables.scores import ablation_table
from solepath.recipes import DEFAULT

BY_NAME = {data_set.name: data_set for data_set in (*DATASETS, *EMULATED)}


def results(recipe, height, offset):
    loops = Scored("a", {"end_error": height})
    walks = Scored("b", events={"heel_strike": Matching(1, 1, (offset,))})
    return [
        Result(BY_NAME["xio_closed_walks"], recipe, (loops,)),
        Result(BY_NAME["gaitmap_examples"], recipe, (walks,)),
    ]


def test_every_row_differs_from_the_default_and_from_every_other():
    first, *rows = recipes()
    assert first is DEFAULT and [row.name for row in rows] == list(ABLATED_RECIPES)
    parts = [(row.detector, row.corrector, row.cues, row.insole, row.parts) for row in (first, *rows)]
    assert all(one != other for k, one in enumerate(parts) for other in parts[:k])


def test_a_row_holds_what_each_data_set_came_to():
    scored = [*results("default", 0.5, -0.012), *results("no wings", 2.0, 0.034)]
    text = ablation_table(scored).splitlines()
    assert text[0].split() == ["xio", "end", "m", "gaitmap", "HS", "ms"]
    assert text[2].split() == ["default", "0.500", "-12"] and text[3].split() == ["no", "wings", "2.000", "34"]
    assert ablation_table(scored, markdown=True).splitlines() == [
        "|  | xio end m | gaitmap HS ms |", "| --- | ---: | ---: |", "| default | 0.500 | -12 |",
        "| no wings | 2.000 | 34 |",
    ]  # fmt: skip
