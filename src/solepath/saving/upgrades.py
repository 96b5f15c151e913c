"""From one version of the state to the next: what became of what was remembered.

`UPGRADES[n]` takes the tree of a packed state of version n (tree.py) and returns that of version n + 1; it may change
what it was given. A step is written when the version is raised and never changed after: what it is given and gives are
the shapes that were pinned (shapes/). What was not remembered then begins as it does in a new session.
"""

from __future__ import annotations

from base64 import b64decode, b64encode
from collections.abc import Callable
from hashlib import blake2b
from struct import Struct, error
from typing import Any

Tree = dict[str, Any]


def _to_2(tree: Tree) -> Tree:
    """Histories are kept in rows of bytes; where cells are only in layouts."""
    wearer = tree["state"]["wearer"]
    sides = wearer["wear"]["sides"]
    known = wearer["wear"]["swapped"] or sides["left"]["told"] or sides["right"]["told"]
    for side in (sides["left"], sides["right"]):
        del side["times"], side["turns"]
        side["turned"] = {"t": None, "turn": [0.0, 0.0, 0.0], "rows": ""}
        if known:
            side["sideways"] = []
    for foot in wearer["feet"].values():
        _habit_to_2(foot["gait"]["habit"])
        sole = foot["sole"]
        insole, layout = sole["insole"], sole["insole"]["layout"]
        del insole["xs"], insole["ys"]
        insole["cells"] = []
        insole["tells_newtons"] = layout is not None and layout["scale"] is not None and not sole["guessed"]
    for decoder in tree["state"]["decoders"].values():
        link = decoder["link"]
        if link is not None and link["kind"] == "InsoleLink" and link["is"]["info"]:
            link["is"]["info"] = _text(blake2b(b64decode(link["is"]["info"]), digest_size=8).digest())
    if wearer["altitude"] is not None:
        _altitude_to_2(wearer["altitude"])
    return tree


def _text(data: bytes) -> str:
    return b64encode(data).decode()


_MOMENT = Struct("<15f")
_TIMES = Struct("<2f")
_READ = Struct("<hBif")


def _habit_to_2(habit: Tree) -> None:
    """Moments as float32, positions from the first of them, and the times that are compared with theirs; none, where
    one is too large for that."""
    last, now = habit["last"], habit["now"]
    habit["origin"] = now[0]["position"] if now else [0.0, 0.0, 0.0]
    try:
        habit["now"] = _text(_moments(now))
        if last is not None:
            last["rows"] = _text(_moments(last.pop("moments")))
            last["toe_off"], last["heel_strike"] = _TIMES.unpack(_TIMES.pack(last["toe_off"], last["heel_strike"]))
    except (error, OverflowError):
        habit["last"], habit["now"], habit["lifted"], habit["origin"] = None, "", None, [0.0, 0.0, 0.0]


def _moments(moments: list[Tree]) -> bytes:
    rows = []
    for one in moments:
        place = [a - b for a, b in zip(one["position"], moments[0]["position"], strict=True)]
        rows.append(_MOMENT.pack(one["since"], *one["attitude"], *one["velocity"], *place, *one["rate"], one["force"]))
    return b"".join(rows)


def _altitude_to_2(altitude: Tree) -> None:
    """Times in hundredths of a second, heights in tenths of a millimetre."""
    altitude["strides"] = [[float(round(100.0 * t)) for t in stride] for stride in altitude["strides"]]
    rows, first, newest = [], 0, 0
    for k, (t, which, value, variance) in enumerate(altitude["kept"]):
        ticks = round(100.0 * t)
        if k == 0:
            first = newest = ticks
        since = max(-(2**15), min(ticks - newest, 2**15 - 1))
        newest += since
        rows.append(_READ.pack(since, which, round(10_000.0 * value), variance))
    altitude["kept"] = {"rows": _text(b"".join(rows)), "first": first, "last": newest}


UPGRADES: dict[int, Callable[[Tree], Tree]] = {1: _to_2}
