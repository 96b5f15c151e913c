"""docs/architecture.md against the code: a packet makes the listed calls, and the example part works."""

from __future__ import annotations

import sys
from pathlib import Path
from types import FrameType

from quoted import below
from walks import insoles, samples

import solepath
from solepath import Session, StrideTaken

ROOT = Path(solepath.__file__).parent


def test_a_frame_without_events_makes_the_calls_of_the_page() -> None:
    session = Session()
    for packet in insoles().packets:
        calls: list[str] = []

        def called(frame: FrameType, event: str, _: object, calls: list[str] = calls) -> None:
            code = frame.f_code
            if event == "call" and code.co_filename.startswith(str(ROOT)):
                calls.append(f"{Path(code.co_filename).relative_to(ROOT)} {code.co_qualname}")

        sys.setprofile(called if packet.t > 4.0 else None)
        events = session.feed(packet)
        sys.setprofile(None)
        if calls and not events and packet.channel == "insole/frame":
            steps = iter(calls)
            if [line for line in below("way") if " ".join(line.split()[:2]) not in steps] == []:
                return
    raise AssertionError("no frame makes all these calls in this order")


def test_the_body_part_of_the_page_works_and_goes_on_from_a_snapshot() -> None:
    page: dict[str, object] = {}
    exec(compile("\n".join(below("part")), "architecture.md, part", "exec", dont_inherit=True), page)
    session = page["session"]
    assert isinstance(session, Session)
    session._state.parts[-1].distance = dict.fromkeys(solepath.Foot, 99.0)  # type: ignore[attr-defined]
    events = session.feed(samples(cells=0))
    assert len([event for event in events if isinstance(event, StrideTaken)]) > 4
    assert [type(event).__name__ for event in events].count("HundredMetres") == 2
