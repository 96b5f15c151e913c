"""Tables of emulated walks: what each kind of evidence earns, and how reliable the weights of places are."""

from __future__ import annotations

from attrs import evolve

from solepath import Packet, Sample, Site
from solepath.events import Candidate
from solepath_lab.emulated.evidence import NO_AIR_PRESSURE, NO_GYROSCOPE, ONE_FOOT
from solepath_lab.emulated.reliability import BINS, WeightBin, count, join

SAMPLE = Sample(1.0, Site.RIGHT_FOOT, (0.0, 0.0, 9.8), (0.1, 0.0, 0.0), air_pressure=101325.0)


def packet(channel: str) -> Packet:
    return Packet(1.0, Site.LEFT_FOOT, channel, b"")


def test_evidence_is_taken_from_samples_and_from_packets_and_the_rest_stays() -> None:
    gyro, air, acc = map(packet, ("cc2541/gyroscope", "cc2541/barometer", "cc2541/accelerometer"))
    assert NO_GYROSCOPE.remove(SAMPLE) == evolve(SAMPLE, gyro=None)
    assert [NO_GYROSCOPE.remove(one) for one in (gyro, air, acc)] == [None, air, acc]
    assert NO_AIR_PRESSURE.remove(SAMPLE) == evolve(SAMPLE, air_pressure=None)
    assert [NO_AIR_PRESSURE.remove(one) for one in (gyro, air, acc)] == [gyro, None, acc]
    assert [ONE_FOOT.remove(one) for one in (SAMPLE, acc)] == [None, acc]


def test_candidates_near_a_heavier_one_on_its_level_are_one_place() -> None:
    first, near, above, far = [
        Candidate(level, (x, 0.0, 0.0), None, weight, "start")
        for level, x, weight in (("0", 0.0, 0.4), ("0", 2.0, 0.3), ("1", 0.0, 0.2), ("0", 4.0, 0.1))
    ]
    assert join([first, near, above, far]) == [[first, near], [above], [far]]


def test_weights_are_counted_in_bins_and_the_only_place_by_itself() -> None:
    bins = count([(7, [(0.25, False, False), (0.75, False, True)]), (8, [(1.0, True, True), (0.25, False, True)])])
    assert [k for k, one in enumerate(bins) if one.count] == [2, 7, BINS]
    assert bins[2] == WeightBin(2, 1, 0.5, {7, 8}) and bins[2].text == "0.250: 0.500 (2 in 2)"
    assert bins[BINS] == WeightBin(1, 1, 1.0, {8})
