"""The fields of events in docs/events.md are those of the classes, and every number has its unit in its sentence."""

from __future__ import annotations

import event_fields
import pytest
from quoted import PAGES, run_page

from solepath import Foot, GaitCycleMeasured, Session
from solepath.emulate import Route, emulate
from solepath.show.observer import Observer


def test_the_page_has_the_fields_of_the_classes() -> None:
    written = PAGES["docs/events.md"].split("<!-- fields -->\n", 1)[1].split("\n<!-- end -->", 1)[0]
    assert written == event_fields.event_fields(), "python .ci/readme --fields writes it"


def test_the_program_of_the_page_selects_the_cycles_of_the_means() -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    (out,), _ = run_page("docs/events.md")
    selected, of_session = map(float, out.split())
    assert selected == pytest.approx(of_session, rel=1e-9)


def test_the_means_are_those_of_the_steady_cycles_that_another_one_follows_at_once() -> None:
    session, observer = Session(), Observer()
    events = []
    for packet in emulate(Route().stand(2.0).walk(9.0).stand(3.0).walk(9.0).stop(2.0), seed=5).packets:
        events += (found := session.feed(packet))
        observer.take(packet, found)
    events += (found := session.finish())
    observer.take(None, found)
    whole, recent = observer.gait.parameters, session.gait
    assert whole is not None and recent is not None
    left_out = 0
    for foot in Foot:
        cycles = [one for one in events if isinstance(one, GaitCycleMeasured) and one.foot is foot]
        pairs = zip(cycles, cycles[1:], strict=False)
        counted = [one for one, after in pairs if one.steady and after.t_start == one.t]
        lengths = [one.stride_length for one in counted if one.stride_length is not None]
        left_out += sum(one.steady for one in cycles) - len(lengths)
        for means in (whole, recent):
            figure = means.feet[foot].stride_length
            assert figure is not None and figure.strides == len(lengths)
            assert figure.mean == pytest.approx(sum(lengths) / len(lengths), rel=1e-9)
    assert left_out > 0, "the last cycle before a stop"
