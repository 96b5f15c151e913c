"""How long `to_frame` takes for an hour of events of two feet: `python tests/bench/lab/frames.py`. Asserts nothing.

The events are those of a minute of an emulated walk with an insole on each foot, sixty times with later times. Seconds
are processor time of all threads, the median of five runs; libraries are imported before.
"""

from __future__ import annotations

import platform
from importlib import import_module
from statistics import median
from time import process_time

from solepath import Session, StrideTaken, to_frame
from solepath.emulate import Route, emulate
from solepath.events.happening import Happening
from solepath.types.attrs import evolve

RUNS = 5
MINUTES = 60


def hour() -> list[Happening]:
    """Return the events of an hour."""
    session = Session()
    walk = emulate(Route().stand(2.0).walk(72.0, speed=1.25), seed=1)
    minute = [event for event in session.feed(walk.packets) if event.t <= 60.0]
    return [
        evolve(event, t=event.t + 60.0 * number, known_at=event.known_at + 60.0 * number)
        for number in range(MINUTES)
        for event in minute
    ]


def main() -> None:
    events = hour()
    strides = [event for event in events if isinstance(event, StrideTaken)]
    print(f"Python {platform.python_version()}: {len(events)} events in an hour, {len(strides)} of them strides")
    for library, of in (("pandas", None), ("pandas", StrideTaken), ("polars", None), ("pyarrow", None)):
        module = import_module(library)
        times = []
        for _ in range(RUNS):
            started_at = process_time()
            frame = to_frame(events, of, library="arrow" if library == "pyarrow" else library)
            if library == "pyarrow":
                frame = module.table(frame)
            times.append(process_time() - started_at)
        name = f"{library} {module.__version__}{', strides' if of else ''}"
        print(f"{name:24} {frame.shape[0]:6} rows {frame.shape[1]:4} columns {median(times):6.2f} s")


if __name__ == "__main__":
    main()
