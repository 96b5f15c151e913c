"""Allowed imports between the rooms, no circle, names without private words, what loads by name, and when."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from here import DOCS
from quoted import below
from walks import insoles, packets

import solepath
from solepath import recipes
from solepath.types.registry import TABLE, load

ROOT = Path(solepath.__file__).parent

CORE = {"types", "events", "saving", "calibration", "floorplan", "wire", "link", "foot", "body", "place",
        "recipes", "papers", "session"}  # fmt: skip


def rooms() -> dict[str, set[str]]:
    """Return, by room (a module or a folder of src/solepath), the rooms that it may import (docs/architecture.md)."""
    header, *lines = below("rooms")
    column = header.index("may import")
    named = {line.split()[0]: set(line[column:].split()) - {"-"} for line in lines}
    return {name: (names - {"CORE"}) | (CORE if "CORE" in names else set()) for name, names in named.items()}


ALLOWED = rooms() | {"__init__": CORE, "__main__": {"cli"}}

FORBIDDEN = {"numpy", "bleak", "asyncio"}
LIVE = CORE - {"papers"} | {"__init__", "feedback"}
"""Rooms on the live path; modules of papers on this path are checked below, in a run."""


def modules() -> dict[str, Path]:
    """Return the file of each module, by dotted name below solepath; a folder stands for its __init__."""
    files = {}
    for path in sorted(ROOT.rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        files[".".join(parts[:-1] if len(parts) > 1 and parts[-1] == "__init__" else parts)] = path
    return files


MODULES = modules()
NAMED: dict[type, str] = {
    ast.Name: "id", ast.Attribute: "attr", ast.arg: "arg", ast.keyword: "arg", ast.alias: "name",
    ast.FunctionDef: "name", ast.AsyncFunctionDef: "name", ast.ClassDef: "name", ast.ExceptHandler: "name",
}  # fmt: skip
"""Field of a node that holds a name."""


@cache
def read(name: str) -> tuple[set[str], set[str], set[str]]:
    """Return the modules of solepath and the other packages that a module imports anywhere, and the names in it."""
    package = () if name == "__init__" else tuple(name.split("."))
    if MODULES[name].name != "__init__.py":
        package = package[:-1]
    imported: set[str] = set()
    others: set[str] = set()
    names: set[str] = set()
    for node in ast.walk(ast.parse(MODULES[name].read_text("utf-8"))):
        names.add(getattr(node, NAMED.get(type(node), ""), None) or "")
        if isinstance(node, ast.ImportFrom) and node.level:
            target = ".".join((*package[: len(package) - node.level + 1], *filter(None, [node.module])))
            inner = [f"{target}.{alias.name}".removeprefix(".") for alias in node.names]
            imported |= {one if one in MODULES else target or "__init__" for one in inner}
        elif isinstance(node, ast.Import | ast.ImportFrom):
            full = [node.module or ""] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names]
            imported |= {one.partition(".")[2] or "__init__" for one in full if one.partition(".")[0] == "solepath"}
            others |= {one.partition(".")[0] for one in full} - {"solepath"}
    return imported, others, names


def room(module: str) -> str:
    return module.partition(".")[0]


def test_every_import_follows_the_order_of_the_rooms_and_every_room_is_in_the_picture() -> None:
    assert {room(name) for name in MODULES} == ALLOWED.keys(), "docs/architecture.md says what a room may import"
    assert [
        f"{name} imports {target}"
        for name in MODULES
        for target in read(name)[0]
        if room(target) != room(name) and room(target) not in ALLOWED[room(name)]
    ] == []
    for own, allowed in ALLOWED.items():
        assert own not in CORE or allowed <= CORE | {"recording"}, f"{own} is of the core and may import an edge"


def test_there_is_no_circle_of_modules() -> None:
    graph = {name: read(name)[0] - {name} for name in MODULES}
    while free := [name for name, targets in graph.items() if not targets & graph.keys()]:
        for name in free:
            del graph[name]
    assert not graph, f"these import each other: {sorted(graph)}"


def test_the_live_path_names_neither_numpy_nor_bleak_nor_asyncio() -> None:
    assert [name for name in MODULES if room(name) in LIVE and read(name)[1] & FORBIDDEN] == []


def test_solepath_never_imports_the_laboratory() -> None:
    assert [name for name in MODULES if "solepath_lab" in read(name)[1]] == []


def test_no_name_holds_a_private_word() -> None:
    families = [line for line in (DOCS / "words.txt").read_text("utf-8").splitlines() if line and line[0] != "#"]
    private = {word for line in families for word in line.partition(":")[0].split()}
    standard = {word for line in families for word in line.partition(";")[2].split()}
    used = set().union(*(read(name)[2] for name in MODULES)) - standard
    words = {one: {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", one)} for one in used}
    assert len(private) > 50
    assert sorted(one for one, parts in words.items() if parts & private) == [], "docs/words.txt has other words"


MAY_NAME_MODULES = {"types.registry", "__init__", "cli.main", "show.web.rehearsal"}
"""The registry, the package, whose names test_surface.py reads, the program, and the rehearsal, which names what it
leaves out."""


def test_every_row_loads_and_a_class_is_called_as_its_row() -> None:
    assert len(TABLE) == 5
    for kind, rows in TABLE.items():
        for name in rows:
            assert load(kind, name).__name__ == name if kind in ("part", "aid", "link") else load(kind, name), name


def test_every_part_of_a_recipe_is_in_it() -> None:
    for recipe in map(recipes.by_name, recipes.NAMES):
        for part in (recipe.detector, recipe.corrector, recipe.cues, *recipe.parts, recipe.place):
            assert part is None or load("part", type(part).__name__) is type(part), recipe


def test_no_other_module_that_imports_by_name_holds_the_name_of_a_module() -> None:
    for name in MODULES.keys() - MAY_NAME_MODULES:
        nodes = [*ast.walk(ast.parse(MODULES[name].read_text("utf-8")))]
        if any(getattr(node, "id", getattr(node, "attr", None)) in ("import_module", "__import__") for node in nodes):
            texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
            paths = [one.partition(":")[0].strip(".").removeprefix("solepath.") for one in texts]
            named = [one for one in paths if "." in one and one in MODULES]
            assert named == [] and not any("solepath." in one for one in texts[1:]), name


LISTEN_PROGRAM = """
import json, sys
from solepath import Packet, Session, Site, StrideTaken
bare = sorted(sys.modules)
live = []
for walk in json.load(open(sys.argv[1])):
    packets = [Packet(t, Site(site), channel, bytes.fromhex(data)) for t, site, channel, data in walk]
    session = Session(poses=True)
    steps = sum(isinstance(event, StrideTaken) for event in session.feed(packets))
    session = Session.restore(json.loads(json.dumps(session.snapshot())))
    session = Session.unpack(session.pack())
    session.finish()
    live.append([sorted(sys.modules), steps])
print(json.dumps([bare, live]))
"""


def test_a_live_session_of_any_device_loads_neither_numpy_nor_bleak_nor_asyncio(tmp_path: Path) -> None:
    """Insoles come first, for which alone it is tested what else is loaded."""
    file, devices = tmp_path / "packets.json", ("two insoles", *packets())
    walks = (insoles().packets, *(walked[: len(walked) // 4] for walked in packets().values()))
    file.write_text(json.dumps([[[p.t, p.site.value, p.channel, p.data.hex()] for p in fed] for fed in walks]))
    done = subprocess.run([sys.executable, "-c", LISTEN_PROGRAM, str(file)], capture_output=True, text=True, check=True)
    bare, live = json.loads(done.stdout)
    assert "solepath.session" in bare
    assert not {"zipfile", "pyexpat"} & set(bare), "what reads floor plan files comes with the first file"
    for device, (loaded, _) in zip(devices, live, strict=True):
        assert not FORBIDDEN & {name.partition(".")[0] for name in loaded}, device
    first, steps = live[0]
    assert steps > 6
    own = {name.partition(".")[2] for name in first if name.startswith("solepath.")}
    assert {room(name) for name in own} <= CORE | {"__init__"}
    assert "link.devices.insole" in own and "link.devices.cc2650" not in own, "a device loads when heard"


USE_PROGRAM = """
import json, sys
from pathlib import Path
from solepath import Packet, Session, Site
session = Session()
loaded = [[*sys.modules]]
told = json.loads(Path(sys.argv[1]).read_text())
session.feed([Packet(t, Site(site), channel, bytes.fromhex(data)) for t, site, channel, data in told])
Session.restore(json.loads(json.dumps(session.snapshot()))).finish()
loaded.append([*sys.modules])
print(json.dumps(loaded))
"""
ON_USE = {
    "link.decoder": {"insoles", "cc2650", "orphe"},
    "foot.tracker": {"insoles", "cc2650", "orphe"},
    "foot.navigate.clipping": {"insoles", "cc2650", "orphe"},
    "foot.pressure.cell_health": {"insoles", "orphe"},
    "foot.pressure.insole": {"insoles", "orphe"},
    "foot.cues.touch": {"orphe"},
    "body.fuse.compass": {"cc2650"},
    "body.activity.pressure_height": {"cc2650"},
}
"""Devices for which a module is loaded that a new session does not load; `orphe` has few cells."""


@pytest.mark.parametrize("device", ["insoles", "cc2650", "orphe"])
def test_an_app_loads_only_the_parts_that_it_uses(device: str, tmp_path: Path) -> None:
    file, walked = tmp_path / "packets.json", insoles().packets if device == "insoles" else packets()[device]
    file.write_text(json.dumps([[p.t, p.site.value, p.channel, p.data.hex()] for p in walked[:600]]))
    done = subprocess.run([sys.executable, "-c", USE_PROGRAM, str(file)], capture_output=True, text=True, check=True)
    new, used = [{name.partition(".")[2] for name in loaded} for loaded in json.loads(done.stdout)]
    assert {name for name in ON_USE if name in new} == set()
    assert {name for name in ON_USE if name in used} == {name for name, users in ON_USE.items() if device in users}


def test_names_and_the_help_of_commands_load_what_they_need_and_no_session() -> None:
    program = "import sys; {}; print(*[name for name in sys.modules if name.partition('.')[0] in ('solepath', 'attr')])"
    helped = "from solepath.cli import main\ntry: main([{}'--help'])\nexcept SystemExit: pass\nfinally: print()"
    alone_helped, track_helped = helped.format(""), helped.format("'track', ")
    loaded = {}
    for work in (
        "import solepath", "from solepath import Foot", f"exec({alone_helped!r})", f"exec({track_helped!r})"
    ):  # fmt: skip
        done = subprocess.run([sys.executable, "-c", program.format(work)], capture_output=True, text=True, check=True)
        loaded[work] = set(done.stdout.splitlines()[-1].split())
    alone, foot, commands, command = loaded.values()
    assert alone == {"solepath"}
    assert {room(name.partition(".")[2]) for name in foot - alone if name.startswith("solepath.")} == {"types"}
    assert "attr" not in commands and not {f"solepath.cli.{name}" for name in ("track", "demo", "check")} & commands
    assert "solepath.cli.track" in command and "solepath.session" not in command


WALK_PROGRAM = """
import json, sys
from pathlib import Path
from solepath import Packet, Session, Site, recipes
file, name, saved = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
restored = saved.exists()
session = Session.restore(json.loads(saved.read_text())) if restored else Session(recipes.by_name(name))
ours = [Path(module.__file__) for name, module in sys.modules.items() if name.partition(".")[0] == "solepath"]
told = json.loads(file.read_text())
packets = [Packet(t, Site(site), channel, bytes.fromhex(data)) for t, site, channel, data in told]
begun = 60 if restored else 30
session.feed(packets[begun - 30 : begun])
if not restored:
    saved.write_text(json.dumps(session.snapshot()))
amid = []
sys.addaudithook(lambda event, of: amid.append(f"{event} {of[0]}") if event in ("open", "import") else None)
session.feed(packets[begun:])
print(json.dumps([len(ours), amid]))
"""


@pytest.mark.parametrize("name", ["default", "footstep-tracker"])
def test_a_session_loads_little_and_amid_a_walk_nothing_is_imported_and_no_file_is_opened(
    name: str, tmp_path: Path
) -> None:
    """Neither where it began nor where it goes on; of the recipes, those that have learnt something."""
    file, saved = tmp_path / "packets.json", tmp_path / "saved.json"
    file.write_text(json.dumps([[p.t, p.site.value, p.channel, p.data.hex()] for p in insoles().packets]))
    for number in range(2 if name == "default" else 1):
        words = [sys.executable, "-c", WALK_PROGRAM, str(file), name, str(saved)]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        count, amid = json.loads(done.stdout)
        assert amid == []
        if name == "default" and number == 0:
            assert count <= 90, "`python tests/bench/way.py` says what importing takes"


def test_a_name_of_a_module_is_given_one_value() -> None:
    twice = []
    for path in ROOT.rglob("*.py"):
        statements = [one for one in ast.parse(path.read_text("utf-8")).body if isinstance(one, ast.Assign)]
        targets = [node for one in statements for target in one.targets for node in ast.walk(target)]
        stored = [node.id for node in targets if isinstance(node, ast.Name)]
        twice += [f"{path.name}: {name}" for name in {*stored} if stored.count(name) > 1]
    assert twice == []
