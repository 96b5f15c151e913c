"""Shared fixtures: the folder of recorded data, and the default recipe's results on them."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
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

    from solepath_lab.evaluate.report import Result


TESTS = Path(__file__).resolve().parent
WAITING = {TESTS / name for name in ("ble", "cli", "life", "page", "web")}
"""Folders with tests that wait for seconds, for programs, radios and browsers."""

# Each worker has a processor at most: threads that share the small products of the emulator would wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when numpy is imported; programs that tests start inherit it

if "PYTEST_XDIST_WORKER" in os.environ:
    gc.disable()  # what is collected stays until the end; pytest_collection_finish enables it

settings.register_profile("unhurried", deadline=None)  # the time of a case depends on the machine
settings.load_profile("unhurried")

# A shell starts what runs in its background with Ctrl-C ignored, and nohup what it runs with the end of the terminal
# ignored. Programs that tests start would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Return the folder of recorded data, SOLEPATH_DATA or beside the checkout; skip the test without it."""
    configured = os.environ.get("SOLEPATH_DATA")
    folder = Path(configured) if configured else TESTS.parents[1] / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"no recorded data at {folder}; SOLEPATH_DATA says where they are")
    return folder


@pytest.fixture(scope="session")
def evaluated(data_dir: Path) -> Callable[[str, str], Result]:
    """Return a function from a data set's name and a recipe's name to the result; each is computed once a process."""
    from solepath_lab.evaluate.jobs import evaluate

    @cache
    def of(data_set: str, recipe: str) -> Result:
        (result,) = evaluate(data_dir, [recipes.by_name(recipe)], only=[data_set], processes=2)
        return result

    return of


@pytest.fixture(scope="session")
def browser() -> Iterator[Browsing]:
    """Yield the browser that all tests of the page share; skip the test where no browser can run."""
    from browsers import browsing, why_not

    reason = why_not()
    if reason is not None:
        pytest.skip(reason)
    with browsing() as browsing_:
        yield browsing_


@pytest.fixture
def chromium(browser: Browsing) -> Browser:
    """Return the shared browser, for a test that is a coroutine."""
    return browser.browser


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Return one worker more than there are processors, because tests over Bluetooth wait for seconds."""
    return (os.cpu_count() or 1) + 1


def pytest_configure(config: pytest.Config) -> None:
    """Begin each worker of xdist with other folders, so that it finds compiled what another one has collected."""
    number = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    if number and [Path(given).resolve() for given in config.args] == [TESTS]:
        folders = sorted(str(path) for path in TESTS.iterdir() if path.is_dir())
        first = len(folders) * number // int(os.environ["PYTEST_XDIST_WORKER_COUNT"])
        config.args[:] = folders[first:] + folders[:first]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Spread the files of each folder over the run: while some tests wait for a radio or a browser, others compute.

    Folders whose tests wait come to an end before the others, so that at the end every worker has something to do."""
    folders: dict[Path, list[Path]] = {}
    for path in dict.fromkeys(item.path for item in items):
        folders.setdefault(path.parent, []).append(path)
    place = {
        path: (k / len(files) * (0.7 if WAITING & {folder, *folder.parents} else 1.0), path)
        for folder, files in folders.items()
        for k, path in enumerate(files)
    }
    items.sort(key=lambda item: place[item.path])


def pytest_collection_finish() -> None:
    """Leave modules and tests out of garbage collection, and collect less often: walks that tests share are kept."""
    gc.enable()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Run a test that is a coroutine: with the fixture `chromium` on the browser's loop, in the soak for four times as
    long as else; without it on a new loop for at most 30 s."""
    if not iscoroutinefunction(pyfuncitem.obj):
        return None
    arguments = {name: pyfuncitem.funcargs[name] for name in signature(pyfuncitem.obj).parameters}
    if "chromium" in arguments:
        from browsers import MAX_TEST_TIME

        longest = MAX_TEST_TIME * (4 if pyfuncitem.get_closest_marker("soak") else 1)
        pyfuncitem.funcargs["browser"].run(lambda _: pyfuncitem.obj(**arguments), longest)
    else:
        asyncio.run(asyncio.wait_for(pyfuncitem.obj(**arguments), 30.0))
    return True
