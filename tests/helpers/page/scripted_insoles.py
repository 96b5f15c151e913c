"""Two insoles that are a script of the page: their frames are those of the demonstration, in real time."""

from __future__ import annotations

from browsers import Window
from web_pages import PATIENCE

from solepath.link.devices.insole import PROFILE
from solepath.link.profile import Access

STREAM = PROFILE.streams[0]
CONNECT = """async (characteristics) => {
    const live = await import('./live.js'), { unpacked } = await import('./unpack.js');
    const text = new TextDecoder().decode(await unpacked(await (await fetch('demo.jsonl.gz')).blob()));
    globalThis.rows = text.trim().split('\\n').slice(1).map(JSON.parse);
    const value = (device, channel) => rows.find((row) => row.site === device && row.channel === channel)?.data ?? '';
    computer.on('orders', (orders) => orders.forEach(({ type, device, channel }) => {
        if (['read', 'subscribe', 'write'].includes(type))
            live.send({ type: 'done', device, t: live.clock(), value: type === 'read' ? value(device, channel) : '' });
    }));
    await live.startWalk('A walk');
    globalThis.began = (performance.timeOrigin + performance.now()) / 1000 - live.clock();
    for (const device of ['left_foot', 'right_foot']) {
        live.send({ type: 'add', device });
        live.send({ type: 'connected', device, t: live.clock(), name: device, characteristics });
    }
}"""
"""Lets two insoles connect whose values are those of the demonstration; their sites are also their identifiers."""
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
"""Lets both insoles send their next `seconds` of frames of the channel `stream`; returns the number of frames."""


async def connect(view: Window) -> None:
    """Start a walk of two insoles, which send nothing yet."""
    characteristics = [[one.service, one.characteristic, one.access is Access.NOTIFY] for one in PROFILE.channels]
    await view.tab.evaluate(CONNECT, characteristics)
    await view.until("Object.keys(solepath.state.links).length === 2", patience=PATIENCE)
