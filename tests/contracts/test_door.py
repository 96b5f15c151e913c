"""Contract 9: numbers of any kind become plain ones at the door, or are refused there before any state changes."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable, Iterator, Sequence
from copy import copy, deepcopy
from decimal import Decimal
from enum import Enum, IntEnum
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from attrs import define, evolve
from soak import soaked
from toys import BOTH
from walks import LEFT, insoles, machines, of, run_session, samples

from solepath import (
    Calibration,
    Cell,
    Foot,
    ItemError,
    Layout,
    Packet,
    PacketRejected,
    Placed,
    Rejection,
    Sample,
    Session,
    StrideTaken,
)
from solepath.body.part import Part, PartInput, PartOutput
from solepath.calibration import ShoeGeometry
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.settings import ErrorStateSettings
from solepath.foot.view import FootView
from solepath.link.driver import Measured, Reading, check_reading
from solepath.recipes import DEFAULT
from solepath.wire.error import WireError

KINDS: dict[str, Callable[[float], Any]] = {
    "float64": np.float64,
    "float32": np.float32,
    "0-d arrays": np.array,
    "Fraction": Fraction,
    "Decimal": Decimal,
}


def foreign(sample: Sample, number: Callable[[float], Any], sequence: Callable[[Any], Any] = tuple) -> Sample:
    """Return the sample with all its numbers as numbers of another kind."""

    def vector(values: Any) -> Any:
        return None if values is None else sequence([number(value) for value in values])

    return evolve(
        sample,
        t=number(sample.t),
        known_at=number(sample.known_at),
        acc=vector(sample.acc),
        gyro=vector(sample.gyro),
        pressure=vector(sample.pressure),
        quat=vector((1.0, 0.0, 0.0, 0.0)),
        mag=vector((1e-5, 0.0, 4e-5)),
        air_pressure=number(101_325.0),
        saturated=np.bool_(sample.saturated),
    )


def plain(sample: Sample, number: Callable[[float], Any] = float) -> Sample:
    """Return the sample with what remains of its numbers after they were of another kind."""
    return foreign(sample, lambda value: float(number(value)))


@pytest.mark.parametrize("kind", [*KINDS][-1:] + soaked(*[*KINDS][:-1]))
def test_a_walk_in_numbers_of_another_kind_gives_the_same_events_and_can_be_saved(kind: str) -> None:
    walk = samples()
    session = Session(poses=True, pressures=True)
    events = session.feed([foreign(sample, KINDS[kind]) for sample in walk])
    json.dumps(session.snapshot(), allow_nan=False)
    session.pack()
    exact = [evolve(plain(sample, KINDS[kind]), saturated=False) for sample in walk]
    assert events + session.finish() == run_session(exact, poses=True, pressures=True)


@pytest.mark.parametrize("sequence", [list, np.array], ids=["lists", "arrays"])
def test_vectors_may_be_lists_and_arrays(sequence: Callable[[Any], Any]) -> None:
    walk = samples()[:400]
    assert run_session([foreign(one, float, sequence) for one in walk]) == run_session([plain(one) for one in walk])


@pytest.mark.parametrize(
    "change",
    [
        {"acc": (1.0, 2.0)},
        {"gyro": (1.0, 2.0, 3.0, 4.0)},
        {"acc": 9.81},
        {"acc": "xyz"},
        {"acc": ("1", "2", "3")},
        {"gyro": (0.0, None, 0.0)},
        {"acc": (0.0, 1j, 9.81)},
        {"quat": (1.0, 0.0, 0.0)},
        {"mag": (1.0,)},
        {"pressure": 5.0},
        {"pressure": ("much",)},
        {"air_pressure": "x"},
        {"air_pressure": (1.0,)},
        {"saturated": "no"},
        {"saturated": np.array([True, False])},
        {"acc": {1.0, 2.0, 3.0}},
        {"gyro": bytearray(3)},
        {"air_pressure": np.complex64(1.0)},
        {"air_pressure": np.datetime64(5, "ns")},
        {"t": "1.0"},
        {"known_at": "now"},
    ],
    ids=lambda change: " ".join(f"{name} {value!r}" for name, value in change.items()),
)
def test_a_value_that_is_no_number_is_a_type_error_that_names_it_and_changes_nothing(change: dict[str, Any]) -> None:
    session = Session()
    walk = samples()[:300]
    session.feed(walk)
    snapshot = session.snapshot()
    with pytest.raises(TypeError, match=next(iter(change))):
        session.feed(evolve(samples()[300], **change))
    assert session.snapshot() == snapshot


def test_the_events_before_an_item_that_cannot_be_used_come_with_the_error() -> None:
    walk, whole = samples(), Session()
    wrong = evolve(walk[700], acc=(None, None, None))
    session = Session()
    with pytest.raises(ItemError, match="item 700: acc of a sample") as raised:
        session.feed([*walk[:700], wrong, *walk[700:]])
    assert raised.value.number == 700
    assert raised.value.events + session.feed(walk[700:]) == whole.feed(walk)
    with pytest.raises(ItemError, match="item 1: feed takes packets or samples, not str"):
        session.feed([evolve(walk[-1], t=walk[-1].t + 0.01), "x"])


@pytest.mark.parametrize("error", [OSError("the disk is gone"), ValueError("a wrong line"), StopAsyncIteration()])
def test_the_events_before_an_iterator_fails_come_with_the_error_and_feeding_goes_on(error: Exception) -> None:
    walk, session = samples(), Session()

    def read() -> Iterator[Sample]:
        yield from walk[:700]
        raise error

    with pytest.raises(ItemError, match="item 700") as raised:
        session.feed(read())
    assert (raised.value.number, raised.value.__cause__) == (700, error)
    assert raised.value.events + session.feed(walk[700:]) == Session().feed(walk)


@define
class Careless(Part):
    """A part of an app that raises at its third stride."""

    strides: int = 0
    has_raised: bool = False

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        self.strides += sum(isinstance(event, StrideTaken) for event in events)
        if self.strides > 2 and not self.has_raised:
            self.has_raised = True
            raise ZeroDivisionError("a part of the app")
        return []


@pytest.mark.parametrize("one_by_one", [True, False])
def test_what_the_feet_found_in_a_sample_comes_with_the_error_of_an_apps_own_part(one_by_one: bool) -> None:
    walk, found = samples(), []
    session = Session(evolve(DEFAULT, name="own", parts=(*DEFAULT.parts, Careless())))
    rest, raised = list(walk), 0
    while rest:
        try:
            found += session.feed(rest.pop(0) if one_by_one else iter(rest))
            rest = rest if one_by_one else []
        except ItemError as error:
            assert isinstance(error.__cause__, ZeroDivisionError)
            found, raised = found + error.events, raised + 1
            rest = rest if one_by_one else rest[error.number + 1 :]
    assert raised == 1 and len(of(StrideTaken, found)) > 3
    assert of(StrideTaken, found) == of(StrideTaken, Session().feed(walk))


def test_texts_and_flags_of_numpy_can_be_saved() -> None:
    address = np.str_("C0:FF:EE:00:00:01")
    channels = sorted({one.channel for one in insoles().packets})
    channel = Enum("Channels", [(f"CHANNEL_{index}", name) for index, name in enumerate(channels)], type=str)
    packets = [evolve(one, device=address, channel=channel(one.channel)) for one in insoles().packets[:50]]
    session = Session(poses=np.bool_(True), pressures=np.bool_(False), devices={LEFT: address})
    assert not of(PacketRejected, session.feed([packet for packet in packets if packet.site is LEFT]))
    session.feed(evolve(packets[-1], site=LEFT, t=packets[-1].t + 1.0, data=memoryview(np.zeros((4, 2), np.uint8))))
    assert Session.restore(json.loads(json.dumps(session.snapshot()))).pack() == session.pack()
    for wrong in ("yes", 2, None):
        with pytest.raises(TypeError, match="poses is True or False"):
            Session(poses=wrong)


def test_a_sample_without_known_at_was_known_at_once() -> None:
    walk = samples()[:400]
    assert run_session([evolve(one, known_at=None) for one in walk]) == run_session(
        [evolve(one, known_at=one.t) for one in walk]
    )


def test_settings_and_calibrations_may_hold_numbers_of_numpy() -> None:
    settings = ErrorStateSettings(acc_noise=np.float64(0.02))
    shoe = ShoeGeometry(heel_radius=np.float64(0.12))
    session = Session(evolve(DEFAULT, corrector=ErrorStateFilter(settings)), calibration=Calibration(shoe=shoe))
    session.feed(samples())
    session.pack()
    saved = json.loads(json.dumps(session.snapshot(), allow_nan=False))
    assert Session.restore(saved).snapshot() == session.snapshot()
    assert [type(part.settings.acc_noise) for part in of(ErrorStateFilter, [session.recipe.corrector])] == [float]


def test_a_reader_that_gives_numbers_of_numpy_is_rejected_in_words() -> None:
    cells = (Cell(np.float64(0.1), 0.0),)
    for reading, words in (
        (Reading(samples=(Measured(acc=(np.float64(0.0), 0.0, 9.81)),)), r"acc\[0\] is float64\(0\)"),
        (Reading(battery=np.float64(0.5)), r"battery is float64\(0.5\)"),
        (Reading(layout=Layout(1, Foot.LEFT, cells, 0.28)), r"layout.cells\[0\].x is float64\(0.1\)"),
        (Reading(layout=Layout(1, "left", (), 0.28)), "layout.foot is 'left', not of type Foot"),
        (Reading(layout=Layout(IntEnum("Sizes", "SMALL")(1), Foot.LEFT, (), 0.28)), "layout.id is a Sizes"),
        (Reading(known={"a\ud800": 1.0}), "known has the name"),
        (Reading(known={f"number {k}": 1.0 for k in range(65)}), "known has 65 values"),
    ):
        with pytest.raises(WireError, match=words):
            check_reading(reading)


@pytest.mark.parametrize("device", ["C0:FF:EE\ud800", "a\nb", "x" * 300], ids=["half a surrogate", "two lines", "long"])
def test_an_address_that_cannot_be_saved_is_rejected_with_its_packet(device: str) -> None:
    session = Session()
    (rejection,) = session.feed(Packet(0.0, LEFT, "device/battery", b"\x20", device))
    assert isinstance(rejection, PacketRejected) and rejection.reason is Rejection.MALFORMED
    assert session.now is None
    session.pack()
    with pytest.raises(ValueError, match="no address"):
        session.bind(LEFT, device)
    with pytest.raises(ValueError, match="no address"):
        Session(devices={LEFT: device})


def test_copies_of_a_session_go_on_by_themselves() -> None:
    packets = insoles().packets
    half = len(packets) // 2
    session = Session(poses=True)
    session.feed(packets[:half])
    copies = [copy(session), deepcopy(session), pickle.loads(pickle.dumps(session))]
    events = session.feed(packets[half:]) + session.finish()
    for one in copies:
        assert one.feed(packets[half:]) + one.finish() == events
        assert one.pack() == session.pack()


def test_a_copy_of_a_session_keeps_the_floor_plan_and_the_parts_of_the_app() -> None:
    machine = machines()["session, particles"]
    session = machine.start()
    half = len(machine.items) // 2
    session.feed(machine.items[:half])
    copies = [copy(session), deepcopy(session), pickle.loads(pickle.dumps(session))]
    events = session.feed(machine.items[half:])
    assert any([isinstance(event, Placed) for event in events])
    for one in copies:
        assert one.feed(machine.items[half:]) == events


def test_a_subclass_of_session_is_copied_with_its_attributes_and_pickles_itself() -> None:
    class Watched(Session):
        pass

    session = Watched()
    session.wearer = ["Ann"]
    session.feed(samples()[:100])
    for copied in (copy(session), deepcopy(session)):
        assert copied.wearer == ["Ann"] and copied.wearer is not session.wearer
        assert isinstance(copied, Watched) and copied.pack() == session.pack()
    with pytest.raises(TypeError, match="Watched is pickled"):
        pickle.dumps(session)


def test_what_is_known_of_a_device_does_not_grow_without_bound() -> None:
    names = iter(range(1000))

    def reader(sent: Any, known: Any) -> Reading:
        return Reading(known={f"number {next(names)}": 1.0})

    driver = evolve(BOTH, readers={"toy/data": reader})
    session = Session(losses=True, profiles=[driver])
    data = driver.write("toy/data", {"number": 1, "ticks": 0, "count": 1, "up": [9.8]})
    events = session.feed([Packet(0.01 * k, LEFT, "toy/data", data) for k in range(100)])
    assert [event.detail for event in of(PacketRejected, events)] == ["more than 64 known numbers"] * 36


def test_a_session_with_devices_of_the_app_is_copied_but_not_pickled_and_gives_the_reason() -> None:
    session = Session(profiles=[BOTH])
    assert deepcopy(session).snapshot() == copy(session).snapshot() == session.snapshot()
    with pytest.raises(TypeError, match=r"snapshot.*restore"):
        pickle.dumps(session)
