"""Samples with numbers of other libraries become plain, and layouts that are equal to the bit are one object."""

from __future__ import annotations

from typing import Any

import pytest
from attrs import evolve, fields

from solepath import Sample, Session, Site
from solepath.types import Cell, Foot, Layout, shared
from solepath.types.plain import has_floats, with_floats  # internal: which samples a session converts

numpy = pytest.importorskip("numpy", reason="numpy is not installed")
SAMPLE = Sample(1.0, Site.PELVIS, (1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8), (0.5, 0.5, 0.5, -0.5), (1e-5, 2e-5, 3e-5),
                1e5, 2.0, True)  # fmt: skip
NUMBERS = [one.name for one in fields(Sample) if one.name != "site"]


@pytest.mark.parametrize("name", NUMBERS)
def test_each_quantity_of_numpy_becomes_the_same_plain_one_and_text_is_named(name: str) -> None:
    assert has_floats(SAMPLE) and has_floats(evolve(SAMPLE, **{name: None})) is (
        name not in ("t", "known_at", "saturated")
    )
    value = getattr(SAMPLE, name)
    foreign: list[Any] = [numpy.asarray(value)[()]]
    if isinstance(value, tuple):
        foreign += [list(value), (*value[:-1], numpy.float64(value[-1])), (numpy.float32(value[0]), *value[1:])]
    for other in foreign:
        sample = evolve(SAMPLE, **{name: other})
        assert not has_floats(sample)
        plain = getattr(with_floats(sample), name)
        assert plain == pytest.approx(value, rel=1e-7) and type(plain) is type(value)
        assert {*map(type, plain if isinstance(plain, tuple) else ())} <= {float}
    for wrong in ("x", ("a", "b", "c", "d"), (1.0,) * 5 if name != "pressure" else 3.0):
        with pytest.raises(TypeError, match=name):
            Session().feed(evolve(SAMPLE, **{name: wrong}))


def test_layouts_that_are_equal_to_the_bit_are_one_object_and_know_their_neighbours() -> None:
    made = [
        Layout(1, Foot.LEFT, (Cell(0.1, y), Cell(0.1, 0.02), Cell(0.2, 0.0), Cell(0.25, 0.0)), 0.26)
        for y in (0.0, -0.0, 0.0)
    ]
    assert shared(made[0]) is shared(made[2]) is not shared(made[1]) and made[0] == made[1]
    for other in ({"id": 2}, {"foot": Foot.RIGHT}, {"length": 0.27}, {"scale": 0.0}, {"full_scale": 1.0}):
        assert shared(evolve(made[0], **other)) is not shared(made[0])
    assert made[0].xs == (0.1, 0.1, 0.2, 0.25) and made[0].ys == (0.0, 0.02, 0.0, 0.0)
    assert made[0].neighbours == ((1,), (0,), (3,), (2,))  # 0.02 m and 0.05 m apart; the pairs are 0.1 m apart
    assert evolve(made[0], cells=()).neighbours == () and evolve(made[0], cells=(Cell(0.1, 0.0),)).neighbours == ((),)


@pytest.mark.parametrize("form", [iter, list, tuple])
def test_a_vector_that_can_be_read_only_once_is_read_once(form: Any) -> None:
    plain = Sample(1.0, Site.LEFT_FOOT, (0.1, 0.2, 9.8), (0.0, 0.3, 0.0))
    given = Sample(1.0, Site.LEFT_FOOT, form((0.1, 0.2, 9.8)), form((0.0, 0.3, 0.0)))
    assert (given if has_floats(given) else with_floats(given)) == plain
