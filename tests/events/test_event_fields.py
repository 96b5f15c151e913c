"""The fields of events in docs/events.md are those of the classes, and every number has its unit in its sentence."""

from __future__ import annotations

import event_fields
import pytest
from quoted import PAGES, run_page


def test_the_page_has_the_fields_of_the_classes() -> None:
    written = PAGES["docs/events.md"].split("<!-- fields -->\n", 1)[1].split("\n<!-- end -->", 1)[0]
    assert written == event_fields.event_fields(), "python .ci/readme --fields writes it"


def test_the_program_of_the_page_selects_the_cycles_of_the_means() -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    (out,), _ = run_page("docs/events.md")
    selected, of_session = map(float, out.split())
    assert selected == pytest.approx(of_session, rel=1e-9)
