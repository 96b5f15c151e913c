"""Measures what activities cost: `python tests/bench/activities.py FILE`, with a recording of samples of both feet.

Prints the processor time that the part takes of a session's, a sample, medians of five runs. Asserts nothing."""

from __future__ import annotations

import sys
from statistics import median
from time import process_time
from typing import Any

from measure import RUNS, machine, no_garbage_collection

from solepath.body.activity.activities import Activities
from solepath.recording.samples import load_samples
from solepath.session import Session


class Timed:
    """A method of the part that adds up its processor time, s."""

    def __init__(self) -> None:
        self.feed, self.spent = Activities.feed, 0.0

    def __call__(self, *given: Any) -> Any:
        started_at = process_time()
        outputs = self.feed(*given)
        self.spent += process_time() - started_at
        return outputs


def main(file: str) -> None:
    """Print the times."""
    samples, timed = list(load_samples(file)), Timed()
    Activities.feed = lambda *given: timed(*given)  # type: ignore[method-assign]
    parts, wholes = [], []
    for _ in range(RUNS):
        timed.spent = 0.0
        with no_garbage_collection():
            started_at, session = process_time(), Session()
            for sample in samples:
                session.feed(sample)
            wholes.append(process_time() - started_at)
        parts.append(timed.spent)
    scale = 1e6 / len(samples)
    print(f"{machine()}; {len(samples)} samples; medians of {RUNS}")
    print(f"session {scale * median(wholes):.1f} us a sample, of which activities {scale * median(parts):.1f} us")


if __name__ == "__main__":
    main(sys.argv[1])
