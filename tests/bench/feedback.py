"""Measures the delay of feedback, from the contact on the floor to the signal: `python tests/bench/feedback.py [DIR]`.

Emulated walks and, with the folder DIR of data sets, recordings (ipol_10m_uturn, hugadb_daily) go as packets through an
emulated radio to a host that has other work too. A signal's delay is split into four parts: *sensor*, from the contact
until the radio has the last sample that the session needs (its wait for later samples included); *radio*, until that
packet arrives; *host*, until the app gets to it; *decision*, `Session.feed` and `Feedback.feed`, measured here.

Idealised: an emulated contact is where the emulator puts it, and its cells show load from then on; a connection event
takes any number of packets; a lost packet never comes, and a burst delays all packets until its end. Nothing is in it
of a speaker or a motor."""

from __future__ import annotations

import argparse
import warnings
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from math import inf
from operator import attrgetter
from pathlib import Path
from time import thread_time

import numpy as np
from attrs import evolve, field, frozen
from construct import Int16ul, Int32ul, Struct, Terminated
from measure import machine

from solepath import Driver, Fields, Foot, Measured, Packet, Profile, Reading, Sample, Session, Site
from solepath.emulate import Insole, Radio, Route, Walker
from solepath.emulate.sensors.device import Notification, device_rng
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.truth import Truth
from solepath.feedback import (
    CadenceAbove,
    CadenceBelow,
    EveryHeelStrike,
    Feedback,
    Rule,
    Signal,
    StanceLonger,
    StanceShorter,
    StanceUneven,
    StrideShorter,
)
from solepath.link.profile import Access, Channel
from solepath.recording.samples import load_samples
from solepath.recording.samples.npz import read_arrays
from solepath.types import OTHER, SITE_OF_FOOT
from solepath_lab.emulated.other_motions import MOTIONS, samples_of
from solepath_lab.train.hugadb import EIGHT_TIMES, with_true_rates

STANCE = 0.5
"""Limit of StanceLonger, s: every stance of a walk passes it, so that each has a true moment."""
RULES: tuple[Rule, ...] = (
    *[EveryHeelStrike(foot) for foot in Foot],
    *[StanceLonger(foot, STANCE, remind=0.1) for foot in Foot],
)
MANY_RULES: tuple[Rule, ...] = (
    *[rule for foot in Foot for rule in (EveryHeelStrike(foot), StanceLonger(foot, 0.75), StanceShorter(foot, 0.4))],
    StrideShorter(0.9), CadenceBelow(90.0), CadenceAbove(140.0), StanceUneven(0.2),
)  # fmt: skip
"""Rules of which a person on a bicycle, in a car or on a chair gets no signal."""
TOLERANCE = 0.25
"""Largest difference of a signal's cause and the true moment that it is about, s, as in the scores of heel-strikes."""
DRAWING, FRAME = 0.004, 1.0 / 60.0
"""Time for which a busy host draws one frame of its screen, and time between two, s (assumed)."""
PAUSE, PAUSES_EVERY = 0.03, 2.0
"""Mean pause of a busy host for other work, exponentially distributed, and mean time between two, s (assumed)."""
BURST, BURSTS_EVERY = (0.05, 0.25), 10.0
"""Shortest and longest time for which a disturbed radio delivers nothing, and mean time between two, s (assumed)."""

CHANNEL = Channel("bench/motion", "0" * 8, "1" * 8, Access.NOTIFY)
FORMAT = Struct("number" / Int16ul, "ticks" / Int32ul, "acc" / Fields("<3f"), "gyro" / Fields("<3f"), Terminated)


def _read(sent: object, known: object) -> Reading:
    acc, gyro = tuple(sent.acc), tuple(sent.gyro)  # type: ignore[attr-defined]
    return Reading((Measured(acc=acc, gyro=gyro),), sequence=sent.number, ticks=sent.ticks)  # type: ignore[attr-defined]


def driver(rate: float) -> Driver:
    """Return an inertial sensor of this rate, Hz, whose packets have one sample, a number and microseconds."""
    profile = Profile(
        name="bench", names=("bench",), services=(CHANNEL.service,), channels=(CHANNEL,), streams=(CHANNEL.name,),
        nominal_rate=rate, stale_after=1.0,
    )  # fmt: skip
    formats = {CHANNEL.name: FORMAT}
    return Driver(profile, formats, {CHANNEL.name: _read}, sequence=2**16, tick_rate=1e6, tick_modulus=2**32)


@frozen
class Air:
    """A radio and a host."""

    interval: float = 0.03
    loss: float = 0.01
    bursts: bool = False
    is_busy: bool = True

    @property
    def words(self) -> str:
        words = f"{1e3 * self.interval:4g} ms, {100 * self.loss:g} % lost{', bursts' if self.bursts else ''}"
        return words + ("" if self.is_busy else ", idle host")


@frozen
class Arrival:
    """A packet at its arrival, and the time at which the radio had it, s."""

    sent: float
    packet: Packet


@frozen
class Given:
    """A signal, and when it was given."""

    signal: Signal
    sent: float
    arrived: float
    taken: float
    """Time at which the app got to the packet, s."""
    decision: float
    """Processor time from then on, s."""

    @property
    def at(self) -> float:
        return self.taken + self.decision


def outages(draw: Callable[[], float], every: float, end: float, rng: np.random.Generator) -> list[tuple[float, float]]:
    """Return spans up to `end`, s, of drawn lengths, with times of the mean `every`, s, between them."""
    found, t = list[tuple[float, float]](), 0.0
    while t < end:
        start = t + float(rng.exponential(every))
        t = start + draw()
        found.append((start, t))
    return found


def transmit(air: Air, sent: dict[Site, Sequence[Notification]], seed: int) -> list[Arrival]:
    """Return what arrives of the values, in the order of arrival."""
    arrivals = []
    for site, values in sent.items():
        rng = np.random.default_rng([seed, 77, list(Site).index(site)])
        radio = Radio(loss=air.loss, interval=air.interval)
        numbered = [evolve(one, data=number.to_bytes(4)) for number, one in enumerate(values)]
        breaks = outages(partial(rng.uniform, *BURST), BURSTS_EVERY, values[-1].t, rng) if air.bursts else []
        for packet in radio.transmit(numbered, site, rng):
            value = values[int.from_bytes(packet.data)]
            t = max([packet.t, *[end for start, end in breaks if start <= packet.t < end]])
            arrivals.append(Arrival(value.t, evolve(packet, t=t, data=value.data)))
    return sorted(arrivals, key=lambda one: one.packet.t)


def pauses(air: Air, seed: int, end: float) -> Iterator[tuple[float, float]]:
    """Yield when the host does other work, from when to when, s, in order."""
    if not air.is_busy:
        return
    rng = np.random.default_rng([seed, 78])
    frames = [(k * FRAME, k * FRAME + DRAWING) for k in range(int(end / FRAME))]
    yield from sorted([*frames, *outages(partial(rng.exponential, PAUSE), PAUSES_EVERY, end, rng)])


def listen(
    arrivals: Sequence[Arrival], air: Air, rules: Sequence[Rule], seed: int, drivers: Sequence[Driver] = ()
) -> tuple[list[Given], list[float]]:
    """Return the signals of a session and its feedback on this host, and the processor time of each packet, s."""
    feedback = Feedback(rules)
    session, given, spent = (
        Session(poses=feedback.needs_poses, impacts=True, profiles=drivers),
        list[Given](),
        list[float](),
    )
    work, free = [*pauses(air, seed, arrivals[-1].packet.t + 10.0), (inf, inf)], 0.0
    number = 0
    for one in arrivals:
        taken = max(free, one.packet.t)
        while work[number][0] <= taken:  # work that was due before goes first
            taken = max(taken, max(free, work[number][0]) + work[number][1] - work[number][0])
            free, number = taken, number + 1
        started_at = thread_time()
        signals = feedback.feed(session.feed(one.packet), taken)
        decision = thread_time() - started_at
        free = taken + decision
        spent.append(decision)
        given += [Given(signal, one.sent, one.packet.t, taken, decision) for signal in signals]
    return given, spent


Moments = Mapping[Foot, Sequence[float]]


@frozen
class Score:
    """Signals against the true moments."""

    parts: list[tuple[float, float, float, float]] = field(factory=list)
    """Sensor, radio, host and decision of each signal, s."""
    before: list[float] = field(factory=list)
    """Time from the first true moment of each bout to the first with a signal, s."""
    counts: dict[str, float] = field(factory=lambda: defaultdict(float))

    def add(self, moments: Moments, given: Sequence[Given], span: float) -> None:
        """Add the signals of one rule about both feet in `span` s."""
        found: dict[Foot, set[float]] = {foot: set() for foot in Foot}
        for one in given:
            foot = one.signal.foot
            assert foot is not None
            nearest = min(moments[foot], key=lambda t: abs(t - one.signal.t), default=inf)
            self.counts["late"] += one.at > one.signal.deadline
            if abs(nearest - one.signal.t) > TOLERANCE or nearest in found[foot]:
                self.counts["false"] += 1
                continue
            found[foot].add(nearest)
            self.parts.append((one.sent - nearest, one.arrived - one.sent, one.taken - one.arrived, one.decision))
        times = sorted([(t, t in found[foot]) for foot in Foot for t in moments[foot]])
        bout_start, is_open, before = -inf, False, -inf
        for t, is_found in times:
            if t - before > 3.0:
                bout_start, is_open = t, False
            if is_found and not is_open:
                is_open = True
                self.before.append(t - bout_start)
            self.counts["start"] += not is_found and not is_open
            self.counts["missed"] += not is_found and is_open
            before = t
        self.counts["moments"] += len(times)
        self.counts["span"] += span


def quantiles(values: Iterable[float]) -> str:
    ms = 1e3 * np.array([*values])
    return " ".join([f"{value:5.0f}" for value in (*np.percentile(ms, [50, 95, 99]), ms.max())]) if len(ms) else "-"


HEADER = f"{'':50} {'median 95 % 99 % max':>23} |   sensor       radio        host    decision  | missed false late"


def show(title: str, score: Score) -> None:
    """Print a row: the delay, ms, medians and 95th percentiles of its parts, shares and numbers an hour."""
    counts = score.counts
    parts = [
        " ".join([f"{1e3 * value:5.1f}" for value in np.percentile([part[k] for part in score.parts], [50, 95])])
        for k in range(4)
    ]
    hours = counts["span"] / 3600.0
    missed = 100.0 * counts["missed"] / max(1.0, counts["moments"] - counts["start"])
    ends = f"{missed:5.1f}% {counts['false'] / hours:4.1f} {counts['late'] / hours:4.1f}"
    print(f"{title:50} {quantiles(map(sum, score.parts)):>23} | {' '.join(parts)} | {ends}", flush=True)


def of(kind: type, given: Iterable[Given]) -> list[Given]:
    return [one for one in given if isinstance(one.signal.rule, kind)]


def as_values(samples: Sequence[Sample], rate: float, handling: float) -> dict[Site, Sequence[Notification]]:
    """Return samples as the values of `driver`; what is missing in them is missing in the numbers too."""
    made, values = driver(rate), defaultdict[Site, list[Notification]](list)
    first = samples[0].t
    for one in samples:
        value = {"number": round((one.t - first) * rate) % 2**16, "ticks": round((one.t - first) * 1e6) % 2**32}
        data = made.write(CHANNEL.name, {**value, "acc": one.acc, "gyro": one.gyro})
        values[one.site].append(Notification(one.t + handling, CHANNEL.name, data))
    return dict(values)


HANDLING = 1e-3
"""Time from a sample until the radio has it, s, as of an emulated insole."""
ROUTE = Route().stand(3).walk(60, 1.3).turn(3.1, 1.0).walk(40, 1.0).stand(5).walk(50, 1.5).turn(1.6, 2.0)
ROUTE = ROUTE.walk(25, 0.8).stop(3)
"""Three minutes and two bouts at four speeds."""


def walked(seed: int, has_cells: bool) -> tuple[dict[Site, Sequence[Notification]], Walker]:
    walker = Walker(ROUTE, seed=seed)
    if has_cells:
        devices = [(site, Insole()) for site in SITE_OF_FOOT.values()]
        return {site: one.emit(walker, site, device_rng(seed, site)) for site, one in devices}, walker
    samples = [one for foot in Foot for one in walker.samples(foot, 100.0, LSM6DSOX)]
    return as_values(sorted(samples, key=attrgetter("t")), 100.0, HANDLING), walker


def stances(truth: Truth, foot: Foot) -> list[float]:
    """Return the moments at which stances pass the limit: those of a gait cycle, or while the other foot swings."""
    own, other = truth.feet[foot], truth.feet[OTHER[foot]]
    ends = [(t, min([one for one in own.toe_offs if one > t], default=inf)) for t in own.heel_strikes]
    swings = [*zip(other.toe_offs, other.heel_strikes, strict=True)]
    moments = [(t + STANCE, end - t) for t, end in ends if end - t > STANCE]
    return [t for t, time in moments if time < 2.0 or any(off <= t <= strike for off, strike in swings)]


AIRS = (
    Air(), Air(is_busy=False), *[Air(interval) for interval in (0.0075, 0.015, 0.05)], Air(loss=0.0), Air(loss=0.05),
    Air(bursts=True), Air(0.05, 0.05, True),
)  # fmt: skip
"""The usual radio comes first; the last one is the worst."""


def walks(seeds: Sequence[int]) -> None:
    print(HEADER)
    for has_cells, name in ((True, "96 cells"), (False, "inertial")):
        made = [walked(seed, has_cells) for seed in seeds]
        for air in AIRS if has_cells else (AIRS[0], AIRS[1], AIRS[-1]):
            strikes, longer, spent = Score(), Score(), list[float]()
            for seed, (values, walker) in zip(seeds, made, strict=True):
                arrivals = transmit(air, values, seed)
                given, took = listen(arrivals, air, RULES, seed, () if has_cells else (driver(100.0),))
                truth = walker.truth()
                spent += took
                contacts = {foot: truth.feet[foot].heel_strikes for foot in Foot}
                strikes.add(contacts, of(EveryHeelStrike, given), truth.duration)
                moments: Moments = {foot: stances(truth, foot) for foot in Foot}
                longer.add(moments, of(StanceLonger, given), truth.duration)
            show(f"{name}, EveryHeelStrike, {air.words}", strikes)
            show(f"{name}, StanceLonger, {air.words}", longer)
            if air == Air():
                first = np.array(strikes.before)
                most = f"at most {first.max():.1f} s"
                print(f"  first signal {np.median(first):.1f} s after the first contact of a bout, {most}")
                ms = 1e3 * np.array(spent)
                times = f"median {np.median(ms):.2f}, 99 % {np.percentile(ms, 99):.2f}, at most {ms.max():.2f} ms"
                print(f"  decision on each of {len(ms)} packets: {times}", flush=True)


def recorded(folder: Path) -> None:
    """Print what labelled walks give."""
    for air in (Air(), Air(0.05, 0.05, True)):
        score = Score()
        for number, path in enumerate(sorted((folder / "ipol_10m_uturn").glob("*.npz"))):
            samples = list(load_samples(path))
            truth = read_arrays(path, lambda key: key.startswith("gt_"))
            arrivals = transmit(air, as_values(samples, 100.0, HANDLING), number)
            given, _ = listen(arrivals, air, RULES, number, (driver(100.0),))
            labels = {foot: truth[f"gt_{foot}"][:, 1].tolist() for foot in Foot}
            score.add(labels, of(EveryHeelStrike, given), samples[-1].t - samples[0].t)
        show(f"ipol_10m_uturn, EveryHeelStrike, {air.words}", score)


def not_walking(folder: Path | None) -> None:
    """Print the signals an hour of those who do not walk."""
    jobs = defaultdict[str, list[tuple[Sequence[Sample], float]]](list)
    for path in sorted((folder / "hugadb_daily").glob("*.npz")) if folder else ():
        samples: Sequence[Sample] = list(load_samples(path))
        name = path.stem.rsplit("_", 2)[0].replace("_", " ")
        rate = (len(samples) / 2 - 1) / (samples[-1].t - samples[0].t)
        jobs[f"hugadb_daily: {name}"].append((samples, rate))
        if path.stem in EIGHT_TIMES:
            jobs[f"hugadb_daily: {name}, rates corrected"].append((with_true_rates(samples), rate))
    for motion in MOTIONS:
        if motion.on_foot:
            jobs[f"emulated: {motion.name}"].append((samples_of(evolve(motion, duration=60.0), 23, 100.0), 100.0))
    for name, recordings in jobs.items():
        signals, seconds = 0, 0.0
        for number, (samples, rate) in enumerate(recordings):
            arrivals = transmit(Air(), as_values(samples, rate, HANDLING), number)
            signals += len(listen(arrivals, Air(), MANY_RULES, number, (driver(rate),))[0])
            seconds += samples[-1].t - samples[0].t
        hourly = f"{3600 * signals / seconds:.1f} an hour"
        print(f"{name:44} {signals} signals in {seconds / 60:.1f} minutes: {hourly}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dir", nargs="?", type=Path, help="folder of the data sets")
    parser.add_argument("--seeds", type=int, default=1, help="number of emulated wearers, of three minutes each")
    parser.add_argument("--part", choices=["walks", "recorded", "not-walking"], help="this part alone")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    print(f"{machine()}; delays in ms; false and late signals an hour\n")
    if options.part in (None, "walks"):
        walks(range(1, options.seeds + 1))
    if options.dir and options.part in (None, "recorded"):
        recorded(options.dir)
    if options.part in (None, "not-walking"):
        not_walking(options.dir)


if __name__ == "__main__":
    main()
