"""Every record that can be saved comes back field by field, with other values in all of its fields."""

from __future__ import annotations

import json
import sys
from base64 import b64encode
from collections import deque
from collections.abc import Iterator
from functools import cache
from types import ModuleType
from typing import Any, get_args

import attrs
import pytest
from attrs import evolve
from made import NAMES, Maker, places, replaced
from walks import samples

from solepath import Calibration, Event, Packet, Sample, Session
from solepath.floorplan.plan import FloorPlan
from solepath.recipes import DEFAULT, part_class
from solepath.saving.codec import SnapshotError, load, save

# internal: the packed form of a record that is not a whole session, and the schema from which it is made
from solepath.saving.nodes import LateNode, RecordNode
from solepath.saving.schema import record_of
from solepath.saving.streams import Lists, Streams, from_bytes, to_bytes
from solepath.session.packed import Head
from solepath.session.state import SessionState
from solepath.types.attrs import NOT_SAVED, ROW_SIZE

NOTHING_LIKE_IT = {"no": {"no": {"no": "no"}}}
OTHERS: dict[type, tuple[Any, ...]] = {
    float: ("x", True),
    int: ("x", True, []),
    str: (7,),
    bool: (1, "x"),
    list: (7, "x"),
}
"""Values that no field of this type in JSON may have."""


def told(value: Any) -> Any:
    """Return everything that a value holds, as what differs if any bit of it differs."""
    if isinstance(value, dict):
        return type(value).__name__, [(told(key), told(item)) for key, item in value.items()]
    if isinstance(value, (tuple, list, deque)):
        return type(value).__name__, getattr(value, "maxlen", None), [told(item) for item in value]
    if attrs.has(type(value)):
        return type(value), [(one.name, told(getattr(value, one.name))) for one in attrs.fields(type(value))]
    if type(value).__module__.startswith("solepath.") and hasattr(value, "__dict__") and not hasattr(value, "name"):
        return type(value), told(vars(value))
    return type(value), repr(value)


def inside(node: Any) -> Iterator[Any]:
    """Yield a node and all nodes in it."""
    node = node.record if isinstance(node, LateNode) else node
    yield node
    inner = [*getattr(node, "items", ()), getattr(node, "of", None), getattr(node, "key", None)]
    for one in [one for one in inner if one is not None]:
        yield from inside(one)


@cache
def classes() -> list[Any]:
    """Return every record in a session's state, of every part and device, every event, calibration and floor plan."""
    found = dict.fromkeys([SessionState, Head, Calibration, FloorPlan, Packet, Sample, *get_args(Event)])
    waiting = [*found, *map(part_class, NAMES)]
    while waiting:
        found[cls := waiting.pop()] = None
        for one in [one for of in record_of(cls).fields.values() for one in inside(of)]:
            more = [one.cls] if isinstance(one, RecordNode) else [*getattr(one, "known", {}).values()]
            waiting += [cls for cls in more if cls not in found and not getattr(cls, "__parameters__", ())]
    return [*found]


def packed(node: RecordNode, record: Any) -> Streams:
    lists = Lists([], [], [], [])
    node.write(record, lists)
    return from_bytes(to_bytes(lists), part_class)


def test_every_field_of_every_record_is_saved_unless_it_is_marked() -> None:
    assert len(classes()) > 150
    unsaved = set[str]()
    for cls in [cls for cls in classes() if attrs.has(cls)]:
        marked = {one.name for one in attrs.fields(cls) if NOT_SAVED.items() <= one.metadata.items()}
        assert set(record_of(cls).fields) == {one.name for one in attrs.fields(cls)} - marked, cls
        unsaved |= marked
    assert unsaved == {"awake", "plan", "threshold", "used"}, "what a restored session makes again"


@pytest.mark.parametrize("shape", range(6))
def test_every_record_comes_back_from_json_and_from_bytes_as_it_was(shape: int) -> None:
    for cls in classes():
        node = record_of(cls)
        record = Maker(shape).record(node)
        saved = json.loads(json.dumps(save(record), allow_nan=False))
        assert told(load(cls, saved, part_class)) == told(record), cls
        streams = packed(node, record)
        assert told(node.read(None, streams)) == told(record), cls
        streams.end()


@pytest.mark.parametrize("shape", range(6))
def test_a_record_that_is_made_again_has_its_state_from_the_bytes_and_its_settings_from_its_holder(shape: int) -> None:
    for cls in [cls for cls in classes() if attrs.has(cls)]:
        node, whole = record_of(cls, made=True), record_of(cls)
        saved, again = Maker(shape).record(whole), Maker(shape, 10_000).record(whole)
        streams = packed(node, saved)
        restored = node.read(again, streams)
        streams.end()
        for one in [one for one in attrs.fields(cls) if one.name in whole.fields]:
            if one.name not in node.fields:
                assert one.init and getattr(restored, one.name) is getattr(again, one.name), (cls, one.name)
            elif not any([getattr(inner, "made", False) for inner in inside(node.fields[one.name])]):
                assert told(getattr(restored, one.name)) == told(getattr(saved, one.name)), (cls, one.name)


def test_values_of_other_types_missing_fields_and_further_ones_are_rejected_in_one_sentence() -> None:
    for cls in classes():
        saved: Any = save(Maker(2).of(cls))
        wrong = [{**saved, "more": 1}, *[dict([*saved.items()][1:])] * bool(saved)]
        for path in (every := places(saved)[1:])[:: 1 + len(every) // 12]:
            value: Any = saved
            for key in path:
                value = value[key]
            wrong += [replaced(saved, path, other) for other in OTHERS.get(type(value), ()) + (NOTHING_LIKE_IT,)]
        for other in wrong:
            with pytest.raises(SnapshotError) as caught:
                load(cls, other, part_class)
            assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


def test_rows_that_are_not_whole_are_rejected() -> None:
    fields = {
        (cls, one) for cls in classes() if attrs.has(cls) for one in attrs.fields(cls) if ROW_SIZE in one.metadata
    }
    assert len(fields) > 5
    for cls, one in fields:
        saved: Any = save(Maker(2).of(cls))
        size = one.metadata[ROW_SIZE] + 1
        saved[one.name] = [0.0] * size if isinstance(saved[one.name], list) else b64encode(bytes(size)).decode()
        with pytest.raises(SnapshotError, match=f"{size} values are no whole rows of {size - 1}"):
            load(cls, saved, part_class)


MODULES = {
    "app_base": """
from __future__ import annotations
from solepath.body.part import Part
from solepath.types.attrs import define, field
@define
class Recovery:
    count: int = 0
@define
class Counter(Part):
    needs_samples = True
    recovery: Recovery | None = field(default=None, init=False)
    def feed(self, events, view):
        self.recovery = Recovery(1 if self.recovery is None else self.recovery.count + 1)
        return ()
""",
    "app_part": """
from __future__ import annotations
from app_base import Counter, define
@define
class OwnCounter(Counter):
    pass
""",
}
"""Modules of an app, with a class that is named as one that solepath loads late."""


def test_an_apps_class_is_its_own_also_where_solepath_has_one_of_that_name(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, source in MODULES.items():
        module = ModuleType(name)
        monkeypatch.setitem(sys.modules, name, module)
        exec(compile(source, name, "exec"), vars(module))
    own = sys.modules["app_part"].OwnCounter
    session = Session(evolve(DEFAULT, name="own", parts=(*DEFAULT.parts, own())))
    for sample in samples():
        session.feed(sample)
    saved = session.snapshot()
    assert Session.restore(json.loads(json.dumps(saved)), parts=[own]).snapshot() == saved
    assert '"count"' in json.dumps(saved)
