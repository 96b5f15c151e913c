"""What is in the fields of bytes: a shape says no more of them than that they are bytes."""

from __future__ import annotations

from ..body.height import received as heard
from ..body.place import crowd
from ..body.worn import turned
from ..foot.gaps import moment

_MOMENTS = f"{moment.ROW.format}: a Moment each"
_CROWD = f"{crowd._COUNT.format}: places; {crowd._PLACE.format} each; {crowd._ROW.format}: a reading each, to the end"
_AS_IT_CAME = "B: as it came"
ROWS = {
    "Block.acc_bins": "B: samples in a bin each",
    "Block.gyro_bins": "B: samples in a bin each",
    "Fragment.body": _AS_IT_CAME,
    "Habit.now": _MOMENTS,
    "Heard.rows": f"{heard.ROW.format}: {heard.TICKS:g} a second, of whom, {heard.PARTS:g} a metre, variance, each",
    "InsoleLink.info": "8B: BLAKE2b of INFO",
    "Particles.crowd": _CROWD,
    "Reassembly.body": _AS_IT_CAME,
    "SnakeGame.crowd": _CROWD,
    "Stride.rows": _MOMENTS,
    "Turned.rows": f"{turned.ROW.format}: {turned.TICKS:g} a second, {turned.STEPS:g} a radian, each",
}
"""Field -> formats as of Python's `struct`, and units. They are pinned with the shape (pin.py): who changes a row
changes what is remembered."""
