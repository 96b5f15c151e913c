"""Shared fixtures: the folder of recorded data, and the default recipe's results on them."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterator
from functools import cache
from inspect import iscoroutinefunction, signature
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

from solepath import recipes

if TYPE_CHECKING:
    from browsers import Browser, Browsing

    from solepath.lab.evaluate.report import Result


settings.register_profile("unhurried", deadline=None)  # how long a case takes is the machine's matter
settings.load_profile("unhurried")


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Return the folder of recorded data, SOLEPATH_DATA or beside the checkout; skip the test without it."""
    named = os.environ.get("SOLEPATH_DATA")
    folder = Path(named) if named else Path(__file__).resolve().parents[2] / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"no recorded data at {folder}; SOLEPATH_DATA says where they are")
    return folder


@pytest.fixture(scope="session")
def evaluated(data_dir: Path) -> Callable[[str, str], Result]:
    """What a recipe makes of the recordings of a data set, by the names of both; each is evaluated once
    in a process."""
    from solepath.lab.evaluate.jobs import evaluate

    @cache
    def of(data_set: str, recipe: str) -> Result:
        (result,) = evaluate(data_dir, [recipes.by_name(recipe)], only=[data_set], processes=2)
        return result

    return of


@pytest.fixture(scope="session")
def browser() -> Iterator[Browsing]:
    """The browser that all tests of the page share; a skip where there can be none."""
    from browsers import browsing, why_not

    reason = why_not()
    if reason is not None:
        pytest.skip(reason)
    with browsing() as found:
        yield found


@pytest.fixture
def chromium(browser: Browsing) -> Browser:
    """The same, for a test that is a coroutine."""
    return browser.browser


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Runs a test that is a coroutine: on the browser's loop where it asks for `chromium`, elsewhere on a loop of its
    own, for half a minute at the most."""
    if not iscoroutinefunction(pyfuncitem.obj):
        return None
    given = {name: pyfuncitem.funcargs[name] for name in signature(pyfuncitem.obj).parameters}
    if "chromium" in given:
        pyfuncitem.funcargs["browser"].run(lambda _: pyfuncitem.obj(**given))
    else:
        asyncio.run(asyncio.wait_for(pyfuncitem.obj(**given), 30.0))
    return True
