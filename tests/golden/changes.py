"""What the cases of the golden corpus do to their inputs: faults of sensors and radios, as plain arithmetic.

Nothing here draws a random number or calls a library, so that a case is the same with every numpy and emulator."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Iterator
from math import cos, sin
from typing import Any

from attrs import evolve
from corpus import Call, Item

from solepath import Packet, Sample, Site

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT

Change = Callable[[tuple[Any, ...]], Iterable[Item]]


# --- changes of samples -----------------------------------------------------------------------------------------------


def draws(seed: int) -> Iterator[float]:
    """Yield numbers from 0 to 1 of the generator of Numerical Recipes, which needs no library."""
    state = seed
    while True:
        state = (1664525 * state + 1013904223) % 2**32
        yield state / 2**32


def halved(items: tuple[Any, ...]) -> Iterator[Any]:
    """Keep every other sample of each site."""
    for site in dict.fromkeys(item.site for item in items):
        yield from [item for item in items if item.site is site][::2]


def ordered(items: Iterable[Any]) -> list[Any]:
    return sorted(items, key=lambda item: item.t)


def each(change: Callable[[Any], Any], since: float = 0.0, until: float = 1e9, site: Site | None = None) -> Change:
    """Change the items of a time and a site one by one; one that becomes None is left out."""

    def changed(items: tuple[Any, ...]) -> Iterator[Any]:
        for item in items:
            if since <= item.t < until and site in (None, item.site):
                item = change(item)
            if item is not None:
                yield item

    return changed


def scaled(item: Sample, acc: float = 1.0, gyro: float = 1.0) -> Sample:
    (a, b, c), (p, q, r) = item.acc or (0.0,) * 3, item.gyro or (0.0,) * 3
    return evolve(item, acc=(acc * a, acc * b, acc * c), gyro=(gyro * p, gyro * q, gyro * r))


def added(item: Sample, acc: tuple[float, ...] = (0.0,) * 3, gyro: tuple[float, ...] = (0.0,) * 3) -> Sample:
    (a, b, c), (p, q, r) = item.acc or (0.0,) * 3, item.gyro or (0.0,) * 3
    return evolve(item, acc=(a + acc[0], b + acc[1], c + acc[2]), gyro=(p + gyro[0], q + gyro[1], r + gyro[2]))


def turned(item: Sample, angle: float) -> Sample:
    """Turn the sensor's frame about its vertical axis by `angle`, rad, and then about its long axis by half of it."""
    vectors = []
    for vector in (item.acc, item.gyro):
        x, y, z = vector or (0.0, 0.0, 0.0)
        x, y = cos(angle) * x - sin(angle) * y, sin(angle) * x + cos(angle) * y
        y, z = cos(0.5 * angle) * y - sin(0.5 * angle) * z, sin(0.5 * angle) * y + cos(0.5 * angle) * z
        vectors.append((x, y, z))
    return evolve(item, acc=vectors[0], gyro=vectors[1])


def left_handed(item: Sample) -> Sample:
    x, y, z = item.acc or (0.0, 0.0, 0.0)
    return evolve(item, acc=(x, -y, z))


def clipped(item: Sample, acc: float, gyro: float) -> Sample:
    def cut(values: Any, most: float) -> Any:
        return tuple(max(-most, min(most, value)) for value in values)

    return evolve(item, acc=cut(item.acc, acc), gyro=cut(item.gyro, gyro))


def later(item: Any, by: float = 0.0, rate: float = 1.0) -> Any:
    made = evolve(item, t=rate * item.t + by)
    return evolve(made, known_at=made.t) if isinstance(item, Sample) else made


def swapped(item: Any) -> Any:
    return evolve(item, site={LEFT: RIGHT, RIGHT: LEFT}.get(item.site, item.site))


def frozen_values(items: tuple[Any, ...]) -> Iterator[Sample]:
    """Let the right sensor repeat one sample from 12 s on."""
    last = None
    for item in items:
        if item.site is RIGHT and item.t > 12.0:
            last = last or item
            item = evolve(last, t=item.t, known_at=item.t)
        yield item


def noisy(items: tuple[Any, ...], acc: float, share: float = 1.0) -> Iterator[Sample]:
    """Add white noise of this amplitude, m/s^2, to a share of the samples."""
    drawn = draws(3)
    for item in items:
        noise = [acc * (next(drawn) - 0.5) for _ in range(3)]
        yield added(item, tuple(noise)) if next(drawn) < share else item


def smooth(items: tuple[Any, ...], count: int = 8) -> list[Any]:
    """Take means over `count` samples of each site, as a low pass that is too low does."""
    made = []
    for site in (LEFT, RIGHT):
        own = [item for item in items if item.site is site]
        for k in range(count, len(own)):
            window = own[k - count : k]
            means = [
                tuple(sum(getattr(one, name)[axis] for one in window) / count for axis in range(3))
                for name in ("acc", "gyro")
            ]
            made.append(evolve(own[k], acc=means[0], gyro=means[1]))
    return ordered(made)


def bursts(items: tuple[Any, ...], period: float = 7.0, length: float = 1.1) -> Iterator[Any]:
    """Lose everything for `length` s in every `period` s, of each foot at another time."""
    return (item for item in items if (item.t + (2.3 if item.site is LEFT else 0.0)) % period >= length)


def cells(change: Callable[[tuple[float, ...], float], Any], site: Site | None = None, since: float = 0.0) -> Change:
    """Change the values of the cells, given them and the time."""
    return each(lambda item: evolve(item, pressure=change(item.pressure, item.t)), since, site=site)


def without(*names: str) -> Change:
    return each(lambda item: evolve(item, **{name: None for name in names}))


def strange(items: tuple[Any, ...]) -> Iterator[Item]:
    """Give samples that no sensor sends among the good ones."""
    nan = float("nan")
    for k, item in enumerate(items):
        yield item
        if k % 40 == 7:
            odd: tuple[dict[str, Any], ...] = (
                {"acc": (nan, 0.0, 0.0)}, {"gyro": (0.0, float("inf"), 0.0)}, {"acc": (1e9, 0.0, 0.0)}, {"t": nan},
                {"t": item.t - 3.0}, {"t": item.t}, {"t": item.t + 4e6}, {"pressure": (1.0,)}, {"acc": None},
                {"gyro": None}, {"quat": (0.0, 0.0, 0.0, 0.0)}, {"mag": (1e-4, 0.0, 0.0)}, {"air_pressure": -5.0},
                {}, {"pressure": (nan,) * 12}, {"acc": None, "gyro": None},
            )  # fmt: skip
            yield evolve(item, **{"t": item.t + 0.001, **odd[k // 40 % len(odd)]})


# --- changes of packets -----------------------------------------------------------------------------------------------


def restarted(items: tuple[Any, ...], at: float, site: Site | None = LEFT) -> list[Item]:
    """Begin the device at a site again at `at`, s: what it sent from the start on comes again, `at` later."""
    kept = [item for item in items if item.t < at or item.site is not site]
    again = [later(item, at) for item in items if item.site is site and item.t + at < items[-1].t]
    return ordered(kept + again)


def shuffled(items: tuple[Any, ...]) -> list[Item]:
    """Let packets come twice, late, in another order, cut short, with a damaged byte or on another channel."""
    made: list[Any] = []
    for k, item in enumerate(items):
        match k % 61:
            case 3:
                made += [item, item]
            case 11:
                made.append(evolve(item, data=item.data[:-1]))
            case 17 if len(item.data) > 2:
                made.append(evolve(item, data=item.data[:2] + bytes([item.data[2] ^ 0x40]) + item.data[3:]))
            case 23:
                made.append(evolve(item, channel="insole/unknown"))
            case 31:
                made.insert(max(0, len(made) - 3), item)
            case 37:
                made.append(evolve(item, data=item.data + b"\x00"))
            case 41 if k > 900:
                made.append(evolve(item, device="C0:FF:EE:00:00:02"))
            case 47:
                made.append(evolve(item, t=item.t - 0.05))
            case 53:
                made.append(evolve(item, data=b""))
            case 57:
                made.append(evolve(item, device="x" * (256 + k % 2)))
            case _:
                made.append(evolve(item, device="C0:FF:EE:00:00:01") if k > 900 and item.site is LEFT else item)
    return made


def received(items: tuple[Any, ...]) -> list[Item]:
    """Add what the receiver itself reports (protocol/receiver.md): connections, ticks, troubles, positions."""
    made: list[Any] = []
    due = [
        (1.0, "receiver/disconnected", b""),
        (1.6, "receiver/connected", b""),
        (6.0, "receiver/dropped", struct.pack("<I", 3)),
        (7.0, "receiver/trouble", b"the radio is busy"),
        (9.0, "receiver/restarted", b""),
        (11.0, "receiver/disconnected", b""),
        (16.0, "receiver/connected", b"\x01"),
        (18.0, "receiver/tick", b""),
        (19.0, "receiver/position", b"\x00" * 24),
    ]
    for item in items:
        while due and item.t >= due[0][0]:
            t, channel, data = due.pop(0)
            made.append(Packet(t, LEFT, channel, data))
        if not 11.0 <= item.t < 16.0 or item.site is not LEFT:
            made.append(item)
    return made


def calls(*when: tuple[float, Call]) -> Change:
    """Put calls of the session between the items, by their time, s."""

    def called(items: tuple[Any, ...]) -> Iterator[Item]:
        due = list(when)
        for item in items:
            while due and item.t >= due[0][0]:
                yield due.pop(0)[1]
            yield item

    return called


def set_back(items: tuple[Any, ...]) -> Iterator[Item]:
    """Let the receiver's clock be set back by an hour, as a program reports that it was, and once unreported."""
    for item in items:
        if item.t < 12.0:
            yield item
        elif item.t < 22.0:
            if item is next(one for one in items if one.t >= 12.0):
                yield Call("restart_clock", (item.t - 3600.0,))
            yield later(item, -3600.0)
        else:
            yield later(item, -7200.0)
