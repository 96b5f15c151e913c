"""Says how early heel-strikes without pressure cells are known: `python tests/bench/impacts.py DIR [NAME ...]`.

DIR holds data sets, NAME those that are used. For each it prints the heel-strikes of `Session(impacts=True)`, the share
that is reported before it is final, how long after its `t` that is known, how much later the final `t` is, and how many
no final event has named. Pressure is left out. It asserts nothing. LEAST_IMPACT_SHOCK was chosen on parts of the first
five: those are no proof."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from attrs import evolve

from solepath import HeelStrike, Session
from solepath.recording.samples import load_samples

NAMES = (
    "ipol_10m_uturn", "tripod_treadmill", "marpino_heel_toe", "gaitmap_examples", "slow_gait", "moticon_opengo",
    "hugadb", "felius_2min_walk", "smart_insole_35",
)  # fmt: skip


def heel_strikes(path: Path) -> list[HeelStrike]:
    session = Session(impacts=True)
    events = [event for one in load_samples(path) for event in session.feed(evolve(one, pressure=None))]
    return [one for one in [*events, *session.finish()] if isinstance(one, HeelStrike)]


def spread(times: list[float]) -> str:
    """Return the first, 50th and 99th percentile, ms."""
    return " / ".join(f"{1e3 * value:.0f}" for value in np.percentile(times, [1, 50, 99])) if times else "-"


def main(folder: Path, names: tuple[str, ...]) -> None:
    print(f"{'':18} strikes  early   known after t, ms   final t later, ms  unconfirmed")
    for name in names:
        count, known, later, lost = 0, list[float](), list[float](), 0
        for path in sorted((folder / name).glob("*.npz")):
            strikes = heel_strikes(path)
            early = {(one.foot, one.t): one for one in strikes if not one.final}
            final = [one for one in strikes if one.final]
            count += len(final)
            known += [one.known_at - one.t for one in early.values()]
            named = [(one.t, early.pop((one.foot, one.revises))) for one in final if one.revises is not None]
            later += [t - one.t for t, one in named]
            lost += len(early)
        share = len(later) / max(count, 1)
        print(f"{name:18} {count:7} {share:6.2f} {spread(known):>19} {spread(later):>19} {lost:12}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), tuple(sys.argv[2:]) or NAMES)
