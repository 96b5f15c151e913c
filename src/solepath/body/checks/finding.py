"""The finding of a check of a foot's sensors."""

from __future__ import annotations

from typing import NamedTuple

from ...events import Defect
from .closure import Axes


class Finding(NamedTuple):
    """A defect of a foot's samples; the fields are those of `DefectFound`."""

    defect: Defect
    what: str
    spoils: bool = True
    axes: Axes | None = None
