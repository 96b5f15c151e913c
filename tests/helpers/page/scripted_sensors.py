"""Sensors that are a script of the page: their values are those of a recording, by default the demonstration."""

from __future__ import annotations

from collections.abc import Iterable

from browsers import Window
from plain_tabs import PlainTab

from solepath.link.devices.insole import PROFILE
from solepath.link.profile import Access, Profile
from solepath.types import Packet

STREAM = PROFILE.streams[0]
CONNECT = """async ({ characteristics, profile, recorded }) => {
    const live = (globalThis.live = await import('./live.js'));
    const unpacked = (answer) => new Response(answer.body.pipeThrough(new DecompressionStream('gzip'))).text();
    const demo = async () =>
        (await unpacked(await fetch('demo.jsonl.gz')))
            .trim().split('\\n').slice(1).map(JSON.parse);
    globalThis.rows = recorded ?? (await demo());
    const value = (device, channel) => rows.find((row) => row.site === device && row.channel === channel)?.data ?? '';
    globalThis.written = 0;
    computer.on('orders', (orders) => orders.forEach(({ type, device, channel }) => {
        if (type === 'write') written += 1;
        if (['read', 'subscribe', 'write'].includes(type))
            live.send({ type: 'done', device, t: live.clock(), value: type === 'read' ? value(device, channel) : '' });
    }));
    await live.startWalk('A walk');
    globalThis.began = (performance.timeOrigin + performance.now()) / 1000 - live.clock();
    for (const device of ['left_foot', 'right_foot']) {
        live.send({ type: 'add', device, site: profile && device, profile });
        live.send({ type: 'connected', device, t: live.clock(), name: device, characteristics });
    }
}"""
"""Lets two sensors connect whose values are those of `recorded`; their sites are also their identifiers."""
WALK = """async ({ seconds, stream }) => {
    const { clock, notified, bytes } = await import('./live.js');
    globalThis.sent ??= rows.filter(({ channel }) => channel === stream);
    globalThis.next ??= 0;
    const began = next, start = clock() - sent[next].t, first = sent[next].t;
    while (clock() - start < first + seconds && next < sent.length) {
        for (; next < sent.length && sent[next].t <= clock() - start; next += 1)
            notified(sent[next].site, stream, new DataView(bytes(sent[next].data).buffer));
        await new Promise((resolve) => setTimeout(resolve, 1));
    }
    return next - began;
}"""
"""Lets both sensors send their next `seconds` of values of the channel `stream`; returns the number of values."""
WALK_AT_ONCE = """([until, streams]) => {
    const { clock, send } = globalThis.live;
    globalThis.sent ??= rows.filter(({ channel }) => streams.includes(channel));
    globalThis.next ??= 0;
    globalThis.start ??= clock() - sent[0].t;
    const values = [];
    for (; next < sent.length && sent[next].t <= until; next += 1)
        values.push([start + sent[next].t, sent[next].site, sent[next].channel, sent[next].data]);
    for (let k = 0; k < values.length; k += 100) send({ type: 'values', values: values.slice(k, k + 100) });
    return values.length;
}"""
"""Lets both sensors send their values up to the time `until` of the recording, s, as if that time had passed."""


async def connect(view: Window | PlainTab, packets: Iterable[Packet] = (), profile: Profile = PROFILE) -> None:
    """Start a walk of two sensors that send nothing yet; without `packets` they are insoles with the demonstration."""
    characteristics = [[one.service, one.characteristic, one.access is Access.NOTIFY] for one in profile.channels]
    rows = [{"t": one.t, "site": one.site.value, "channel": one.channel, "data": one.data.hex()} for one in packets]
    name = profile.name if rows else None
    await view.tab.evaluate(
        CONNECT, {"characteristics": characteristics, "profile": name, "recorded": rows if rows else None}
    )
    setup_done = f"Object.keys(solepath.state.links).length === 2 && written === {2 * len(profile.setup)}"
    await view.until(setup_done)
