"""The table of the figures without each part of the default recipe."""

from solepath.recipes import DEFAULT
from solepath_lab.evaluate.ablation import ABLATED_RECIPES, recipes


def test_every_row_differs_from_the_default_and_from_every_other():
    first, *rows = recipes()
    assert first is DEFAULT and [row.name for row in rows] == list(ABLATED_RECIPES)
    parts = [(row.detector, row.corrector, row.cues, row.insole, row.parts) for row in (first, *rows)]
    assert all(one != other for k, one in enumerate(parts) for other in parts[:k])
