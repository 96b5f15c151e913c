"""Tests what a page shows of the checks of the data, and of the whole walk, from events alone."""

from __future__ import annotations

from attrs import evolve
from shown import frame, shown

from solepath import (
    CellFault,
    CellsFailed,
    Connected,
    Defect,
    DefectFound,
    FeetSwapped,
    Foot,
    FootResumed,
    FootSilent,
    Site,
)
from solepath.show.page.scene.scene import Scene

RIGHT = Foot.RIGHT


def test_what_the_checks_found_stands_until_it_no_longer_holds() -> None:
    axes = DefectFound(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, defect=Defect.AXES, what="an axis is mirrored")
    cells = CellsFailed(t=2.0, known_at=2.0, site=Site.RIGHT_FOOT, fault=CellFault.DEAD, cells=(3, 4))
    silent = FootSilent(t=3.0, known_at=3.0, foot=RIGHT, silent_for=3.0)
    swapped = FeetSwapped(t=4.0, known_at=4.0)

    def found(scene: Scene) -> list[tuple[str, bool]]:
        return [(one["site"], one["act"]) for one in frame(scene)["findings"]]

    scene = shown([axes, cells, silent, swapped, evolve(axes, t=5.0, known_at=5.0, what="axis 2 is mirrored")])
    assert found(scene) == [("left foot", True), ("", True), ("right foot", True), ("right foot", False)]
    assert frame(scene)["findings"][0]["what"] == "axis 2 is mirrored", "the same defect, known better"
    shown([FootResumed(t=6.0, known_at=6.0, foot=RIGHT, silent_for=3.0)], scene)
    assert found(scene) == [("left foot", True), ("", True), ("right foot", False)]
    shown([Connected(t=7.0, known_at=7.0, site=Site.LEFT_FOOT, device="", name="Insole", signal=-50)], scene)
    assert found(scene) == [("", True), ("right foot", False)]


def test_a_wrong_scale_comes_before_another_range_on_the_page_too() -> None:
    scale = DefectFound(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, defect=Defect.WRONG_SCALE, what="it reads 4.9")
    cut = "the accelerometer's peaks are cut off: choose a larger range"
    clipped = DefectFound(t=2.0, known_at=2.0, site=Site.LEFT_FOOT, defect=Defect.CLIPPED, what=cut)
    assert [one["what"] for one in frame(shown([clipped]))["findings"]] == [cut]
    found = [one["what"] for one in frame(shown([scale, clipped]))["findings"]]
    assert found == ["the accelerometer's peaks are cut off: correct its scale first", "it reads 4.9"]
