"""The way of a walk from its first step on, for drawings and exports."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import fmean

from attrs import evolve

from ..events import StrideTaken, WearerMoved
from ..types import PerFoot, Vec3
from ..types.vector import sub


def way_of(feet: PerFoot[list[StrideTaken]], moved: list[WearerMoved]) -> list[WearerMoved] | list[StrideTaken]:
    """Return the track of the wearer or, if it is not known, of the foot with the most strides, from its first step on.

    `feet` are the strides of each foot, `moved` where the wearer was after the strides."""
    if moved:
        return [*_first_steps([own for own in feet.values() if own], moved[0]), *moved]
    most = max(feet.values(), key=len)
    return [evolve(most[0], t=_start_of(most[0]), position=_before(most[0])), *most] if most else []


def _first_steps(strides: Sequence[Sequence[StrideTaken]], first: WearerMoved) -> list[WearerMoved]:
    """Return where the wearer was before the `first` position that a session gives: in the middle of the feet.

    A session gives it once the feet are known to carry a walker."""
    early = sorted([one for own in strides for one in own if one.t_end < first.t], key=lambda one: one.t_end)
    places = {own[0].foot: _before(own[0]) for own in strides}
    found = []
    for t, stride in [(min(map(_start_of, early), default=first.t), None), *[(one.t_end, one) for one in early]]:
        if stride is not None:
            places[stride.foot] = stride.position
        x, y, z = [fmean(values) for values in zip(*places.values(), strict=True)] if places else first.position
        found.append(evolve(first, t=t, position=(x, y, z)))
    return found if early else []


def _start_of(stride: StrideTaken) -> float:
    """Return when the foot left the ground, s, or the start of the stride if that is not known."""
    return stride.t_start if stride.t_toe_off is None else stride.t_toe_off


def _before(stride: StrideTaken) -> Vec3:
    """Return where a stride began, m."""
    return sub(stride.position, stride.displacement)
