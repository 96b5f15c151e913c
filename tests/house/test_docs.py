"""README.md and docs/ are true: programs run, commands and options exist, links lead somewhere, figures are printed."""

import io
import re
import shlex
import shutil
from argparse import ArgumentParser
from contextlib import redirect_stdout
from functools import cache
from importlib import import_module

import pytest
from commands import run
from here import EXAMPLES, PROTOCOL
from quoted import PAGES, ROOT, below, blocks, run_page
from recordings import recorded
from snooped import insoles_log
from sparks import needed
from walks import insoles

from solepath import LiftRidden
from solepath.cli.main import parser
from solepath.emulate import Route
from solepath.fleet import Sent, sent_line
from solepath.fleet.spark_files import committed
from solepath.show.output import STRIDE_COLUMNS, TRACK_COLUMNS
from solepath.types import Foot
from solepath.types.registry import TABLE
from solepath_lab.command import parser as laboratory

MARKDOWN = {**PAGES, **{f"protocol/{path.name}": path.read_text() for path in (PROTOCOL).glob("*.md")}}
WALK = insoles(Route().stand(2).walk(6, speed=1.3).stop(2))


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder with the examples, in which programs run."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(EXAMPLES, "examples")
    return tmp_path


def test_samples_of_any_other_sensor_are_fed(here):
    _, names = run_page("docs/app.md", programs=slice(6, 7))
    assert names["samples"].now == 0.01 and names["events"] == []


def test_the_line_for_the_phases_prints_both_tables():
    (program,) = re.findall(r'^python -c "(.*)"$', PAGES["docs/architecture.md"], re.MULTILINE)
    with redirect_stdout(io.StringIO()) as out:
        exec(program, {})
    rows = [line.split() for line in out.getvalue().splitlines()]
    assert ["SWING", "LOADING", "STATIONARY", "SWING", "SWING", "LOADING", "SWING"] in rows
    assert ["SWING", "RIGHT", "RIGHT", "RIGHT", "FLIGHT"] in rows


def test_activities_of_the_wearer_are_reported(here):
    _, names = run_page("docs/events.md", programs=slice(3, 4))
    with redirect_stdout(io.StringIO()) as out:
        names["did"](LiftRidden(t=9.0, known_at=9.5, t_start=2.0, up=False, height=-3.0))
    assert out.getvalue() == "down -3.0\n"


def test_gait_parameters_are_printed(here):
    _, names = run_page("docs/events.md", programs=slice(1))
    with redirect_stdout(io.StringIO()) as out:
        for event in names["session"].feed(insoles(Route().stand(2).walk(15).stop(2)).packets):
            names["measured"](event)
    assert out.getvalue().splitlines()[0].split()[0] in ("left", "right")


def test_a_wearer_of_a_fleet_goes_through_its_step_and_through_its_job(here):
    needed()
    parquet = import_module("pyarrow.parquet")
    walk = insoles(Route().stand(2).walk(3).stop(1))
    recorded(here / "walk.jsonl", walk.packets)
    (here / "sent").mkdir()
    lines = [sent_line(Sent("w-17", number, packet)) for number, packet in enumerate(walk.packets)]
    (here / "sent" / "w-17.jsonl").write_bytes(b"".join(lines))
    (emitted, _), names = run_page("docs/fleet.md")
    names["spark"].stop()
    rows = [row for path in committed(here / "events") for row in parquet.read_table(path).to_pylist()]
    assert sorted((row["wearer"], row["number"], row["event"]) for row in rows) == sorted(
        (wearer, int(number), event) for wearer, number, event in map(str.split, emitted.splitlines())
    )
    strides = [row for row in rows if row["event"] == "StrideTaken"]
    assert len(strides) == sum(len(walk.truth.strides(foot)) for foot in Foot)


def test_the_loop_over_bluetooth_is_a_program(here):
    """A loop like it runs in examples/app.py, against emulated insoles (tests/life/test_app.py)."""
    printed, names = run_page("docs/device.md", programs=slice(3))
    assert names["listen"].__name__ == "listen"
    assert "acc=(9.80665, 0.0, 0.0), gyro=(0.0339" in printed[1]  # one notification of a SensorTag


def test_three_commands_make_a_report_of_a_phones_log(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    insoles_log(WALK.packets).save(tmp_path / "btsnoop_hci.log")
    install, *lines = below("phone")
    assert "pip install ." in install and len(lines) == 2
    for line in lines:
        program, *arguments = shlex.split(line)
        done = run(*arguments)
        assert (program, done.returncode, done.stderr) == (".venv/bin/solepath", 0, "")
    steps = len(WALK.truth.strides(Foot.LEFT))
    assert f"left foot took {steps} strides" in (tmp_path / "report.html").read_text()


PARSERS = {"solepath": parser, "solepath-lab": laboratory}


@cache
def commands(program: str = "solepath") -> dict[str, ArgumentParser]:
    (subparsers,) = (action for action in PARSERS[program]()._actions if isinstance(action.choices, dict))
    return dict(subparsers.choices)


def test_commands_of_all_pages_can_be_typed():
    lines = [line for page in PAGES.values() for block in blocks(page, "sh") for line in block.splitlines()]
    for line in lines:
        for part in line.split(" && "):
            program, *arguments = shlex.split(part, comments=True)
            if make := PARSERS.get(program.removeprefix(".venv/bin/")):
                make().parse_args(arguments)  # exits where they are wrong


def test_options_of_all_pages_are_those_of_the_command_line():
    """All commands quoted within a line are checked, also those with words to be filled in."""
    for program, quoted in re.findall(r"`(solepath(?:-lab)?) ([^`]+)`", "".join(PAGES.values())):
        name, *words = quoted.split()
        assert name in commands(program), quoted
        known = "".join(_options(commands(program)[name]))
        assert all(word.split("=")[0] in known for word in words if word.startswith("--")), quoted


def _options(command: ArgumentParser) -> list[str]:
    """Return the options of a command and of its subcommands."""
    inner = [one for a in command._actions if isinstance(a.choices, dict) for one in a.choices.values()]
    return [f"{option} " for option in command._option_string_actions] + [o for one in inner for o in _options(one)]


@pytest.mark.parametrize("program", PARSERS)
def test_all_options_of_the_table_of_commands_exist(program):
    lines = re.findall(rf"^\| `{program} ([\w-]+)(.*)", PAGES["docs/commands.md"], re.MULTILINE)
    kinds = re.findall(r"^- \*(\w+ options)\*(.*?)(?=\n- |\n\n)", PAGES["docs/commands.md"], re.DOTALL | re.MULTILINE)
    of_kind = {kind.lower(): options for kind, options in kinds}
    expanded = {name: re.sub(r"\*(\w+ options)\*", lambda kind: of_kind[kind[1]], line) for name, line in lines}
    named = {name: set(re.findall(r"--[a-z-]+", line)) for name, line in expanded.items()}
    assert named.keys() == commands(program).keys()
    for name, options in named.items():
        known = {option.strip() for option in _options(commands(program)[name])}
        assert options <= known | {"--help"}, name
        missing = {option for option in known if option.startswith("--")} - options - {"--help"}
        has_kinds = any(isinstance(action.choices, dict) for action in commands(program)[name]._actions)
        assert has_kinds or not missing, f"{name} has {missing} as well"


def anchors(text: str) -> set[str]:
    """Return the anchors that a forge (GitHub) makes of the headings."""
    prose = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    titles = re.findall(r"^#+ (.+)$", prose, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles}


def test_links_of_all_pages_lead_somewhere():
    for page, source in MARKDOWN.items():
        text = re.sub(r"`[^`\n]*`", "", source)
        for target in re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'<img src="([^"]+)"', text):
            path, _, anchor = target.partition("#")
            if path.startswith("https:"):
                continue
            whole = ((ROOT / page).parent / path).resolve() if path else ROOT / page
            assert whole.exists() and whole.is_relative_to(ROOT), f"{page}: {target}"
            if anchor and whole.suffix == ".md":
                assert anchor in anchors(whole.read_text()), f"{page}: {target}"


def test_columns_are_those_that_are_written():
    assert f"`{','.join(TRACK_COLUMNS)}`" in PAGES["docs/commands.md"]
    assert f"`{','.join(STRIDE_COLUMNS)}`" in PAGES["docs/commands.md"]


def test_the_table_of_parts_has_them_all():
    named = re.findall(r"`(\w+)`", "".join(below("parts")))
    assert sorted(named) == sorted(["InsoleLoads", *TABLE["part"]])
