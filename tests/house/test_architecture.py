"""docs/architecture.md against the code: the folders exist, a packet makes the listed calls, the example parts work."""

from __future__ import annotations

import sys
from pathlib import Path
from types import FrameType

from here import DOCS
from walks import insoles, samples

import solepath
from solepath import Session, StrideTaken

PAGE = (DOCS / "architecture.md").read_text("utf-8")
ROOT = Path(solepath.__file__).parent


def block(name: str) -> str:
    """Return the block below <!-- name --> in the page."""
    return PAGE.partition(f"<!-- {name} -->\n```")[2].partition("\n")[2].partition("```")[0]


def test_every_room_is_in_the_picture_and_every_room_of_the_picture_is_there() -> None:
    pictured = {line.split()[0] for line in block("rooms").splitlines()[1:]}
    there = {
        path.stem for path in ROOT.iterdir() if (path.is_dir() and path.name != "__pycache__") or path.suffix == ".py"
    }
    assert pictured == there - {"__init__", "__main__"}


def test_a_frame_without_events_makes_the_calls_of_the_page() -> None:
    session, silent_calls = Session(), list[str]()
    for packet in insoles().packets:
        calls: list[str] = []

        def called(frame: FrameType, event: str, _: object, calls: list[str] = calls) -> None:
            code = frame.f_code
            if event == "call" and code.co_filename.startswith(str(ROOT)):
                calls.append(f"{Path(code.co_filename).relative_to(ROOT)} {code.co_qualname}")

        sys.setprofile(called)
        events = session.feed(packet)
        sys.setprofile(None)
        if not events and packet.channel == "insole/frame" and packet.t > 4.0:
            silent_calls = calls
    steps = iter(silent_calls)
    for line in block("way").splitlines():
        expected = " ".join(line.split()[:2])
        assert expected in steps, f"{expected} is not called there"


def test_the_parts_of_the_page_work_together_and_go_on_from_a_snapshot() -> None:
    page: dict[str, object] = {}
    for name in ("detector", "part", "recipe", "promises"):
        exec(compile(block(name), f"architecture.md, {name}", "exec", dont_inherit=True), page)
    session = page["session"]
    assert isinstance(session, Session)
    parts = session._state.wearer.parts
    parts[-1].distance = {foot: 99.0 for foot in solepath.Foot}  # type: ignore[attr-defined]
    events = session.feed(samples(cells=0))
    assert len([event for event in events if isinstance(event, StrideTaken)]) > 4
    assert [type(event).__name__ for event in events].count("HundredMetres") == 2
