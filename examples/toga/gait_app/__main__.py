"""An app for a phone or a desktop with BeeWare Toga: live activity, strides, gait, both soles and the track.

    pip install '.[ble]' 'toga-qt[pyside6-essentials]>=0.5.7'   on Linux; on macOS and Windows 'toga>=0.5.7' instead
    python examples/toga/gait_app/__main__.py   one button for two insoles nearby, one for an emulated wearer

`solepath.ble.Devices` runs in Toga's asyncio loop. examples/toga/pyproject.toml declares what Briefcase needs to pack
it for Android, where nobody has tried it. On iOS there is no bleak: protocol/host.md is the way there."""

import asyncio
from collections import deque
from collections.abc import AsyncIterator, Iterator

import toga
from toga.colors import rgb
from toga.constants import CENTER, COLUMN, ROW
from toga.widgets.canvas import Arc, DrawingAction, Fill, FillText, LineTo, Rect, Stroke

from solepath import Foot, FootPressed, Layout, LayoutKnown, LinkTrouble, Packet, Session, StreamStale, StrideTaken
from solepath.link.devices.insole import PROFILE as INSOLE

COLOURS = {Foot.LEFT: "#1f77b4", Foot.RIGHT: "#d95f02"}
FIGURES = {"strides": "strides", "cadence": "steps a minute", "length": "stride, m", "asymmetry": "asymmetry of swing"}


async def sensors() -> AsyncIterator[Packet]:
    from solepath.ble import DeviceConfig, Devices

    async with Devices([DeviceConfig(None, profile=INSOLE), DeviceConfig(None, profile=INSOLE)]) as devices:
        async for packet in devices:
            yield packet


async def emulated(speed: float = 1.0) -> AsyncIterator[Packet]:
    from solepath.emulate import Route, emulate

    loop = asyncio.get_running_loop()
    started_at = loop.time()
    for packet in emulate(Route().stand(2).walk(12, speed=1.3).turn(1.6, radius=1.5).walk(8).stop(2), seed=1).packets:
        await asyncio.sleep(max(0.0, started_at + packet.t / speed - loop.time()))
        yield packet


class GaitApp(toga.App):
    def startup(self) -> None:
        self.listening: asyncio.Task[None] | None = None
        self.activity = toga.Label("", font_size=26, text_align=CENTER)
        self.figures = {name: toga.Label("", font_size=24, text_align=CENTER) for name in FIGURES}
        self.soles = toga.Canvas(height=190, margin=6, background_color="white")
        self.map = toga.Canvas(flex=1, margin=6, background_color="white")
        self.status = toga.Label("", font_size=11, margin=6)
        button_style = {"font_size": 16, "height": 48, "flex": 1, "margin": 4}
        self.start = toga.Button("Insoles", on_press=lambda _: self.toggle_listening(sensors()), **button_style)
        self.show = toga.Button("Emulated", on_press=lambda _: self.toggle_listening(emulated()), **button_style)
        captions = {name: toga.Label(text, font_size=11, text_align=CENTER) for name, text in FIGURES.items()}
        tiles = [toga.Box(children=[self.figures[n], captions[n]], direction=COLUMN, flex=1) for n in FIGURES]
        rows = [toga.Box(children=row, direction=ROW) for row in (tiles[:2], tiles[2:], [self.start, self.show])]
        column = [self.activity, rows[0], rows[1], self.soles, self.map, self.status, rows[2]]
        self.main_window = toga.MainWindow(size=(360, 740), content=toga.Box(children=column, direction=COLUMN))
        self.main_window.show()
        self.reset()

    def reset(self) -> None:
        self.session, self.strides, self.peak, self.due = Session(pressures=True), 0, 1.0, 0.0
        self.layouts, self.load = dict[Foot, Layout](), dict[Foot, FootPressed]()
        self.track = {foot: deque([(0.0, 0.0)], maxlen=1000) for foot in Foot}
        self.draw()

    def toggle_listening(self, packets: AsyncIterator[Packet]) -> None:
        if self.listening is not None:
            self.listening.cancel()  # the button reads Stop
            return
        self.reset()
        self.status.text, self.start.text, self.show.enabled = "waiting for the first packet", "Stop", False
        self.listening = self.loop.create_task(self.listen(packets))

    async def listen(self, packets: AsyncIterator[Packet]) -> None:
        reason = "ended"
        try:
            async for packet in packets:
                self.take(self.session.feed(packet))
        except asyncio.CancelledError:
            reason = "stopped"
        except Exception as error:  # no Bluetooth, no permission, a missing package: the user reads it
            reason = str(error)
        self.take(self.session.finish())
        self.draw()
        self.status.text, self.start.text, self.show.enabled, self.listening = reason, "Insoles", True, None

    def take(self, events: list[object]) -> None:
        for event in events:
            match event:
                case StrideTaken(foot=foot, position=(x, y, _)):
                    self.strides += 1
                    self.track[foot].append((x, y))
                case FootPressed(foot=foot, values=values):
                    self.load[foot] = event  # darkest is what one frame in a hundred exceeds, not a single spike
                    self.peak = max(1.0, self.peak * (1.05 if max(values) > self.peak else 0.9995))
                case LayoutKnown(layout=layout):
                    self.layouts[layout.foot], self.status.text = layout, f"{layout.foot.value} insole connected"
                case LinkTrouble() | StreamStale():
                    self.status.text = event.what if isinstance(event, LinkTrouble) else f"{event.site.value} is silent"
        if self.loop.time() >= self.due:
            self.due = self.loop.time() + 0.1
            self.draw()

    def draw(self) -> None:
        gait = self.session.gait
        length, asymmetry = (gait.both.stride_length, gait.asymmetry("swing_time")) if gait else (None, None)
        self.figures["strides"].text = f"{self.strides}"
        self.figures["cadence"].text = f"{gait.cadence:.0f}" if gait and gait.cadence else "–"
        self.figures["length"].text = f"{length.mean:.2f}" if length else "–"
        self.figures["asymmetry"].text = f"{asymmetry:+.1%}" if asymmetry is not None else "–"
        self.activity.text = self.session.activity.value.replace("_", " ").lower()
        for canvas, drawn in ((self.soles, self.drawn_soles), (self.map, self.drawn_track)):
            canvas.root_state.drawing_actions[:] = drawn(canvas.layout.content_width, canvas.layout.content_height)
            canvas.redraw()

    def drawn_soles(self, width: float, height: float) -> Iterator[Fill]:
        for foot, letter_x, middle in ((Foot.LEFT, 8, 0.3 * width), (Foot.RIGHT, width - 20, 0.7 * width)):
            yield filled(COLOURS[foot], FillText(foot.name[0], letter_x, height - 8))
            load, layout = self.load.get(foot), self.layouts.get(foot)
            if load is None or layout is None:
                continue
            scale, heel = (height - 16) / layout.length, height - 8
            for cell, value in zip(layout.cells, load.values, strict=False):
                side, share = scale * cell.area**0.5 - 1, min(1.0, value / self.peak) ** 0.5
                place = Rect(middle - scale * cell.y - side / 2, heel - scale * cell.x - side / 2, side, side)
                yield filled(rgb(220, 220 - round(200 * share), 220 - round(210 * share)), place)
            if load.centre is not None:
                yield filled(COLOURS[foot], Arc(middle - scale * load.centre[1], heel - scale * load.centre[0], 6))

    def drawn_track(self, width: float, height: float) -> Iterator[Stroke]:
        xs, ys = zip(*(place for places in self.track.values() for place in places), strict=True)
        scale = min((height - 30) / max(max(xs) - min(xs), 2.0), (width - 30) / max(max(ys) - min(ys), 2.0))
        across, up = width / 2 + scale * (max(ys) + min(ys)) / 2, height / 2 + scale * (max(xs) + min(xs)) / 2
        for foot, places in self.track.items():
            line = Stroke(stroke_style=COLOURS[foot], line_width=3)
            line.drawing_actions[:] = [LineTo(across - scale * y, up - scale * x) for x, y in places]
            yield line


def filled(colour: str | rgb, shape: DrawingAction) -> Fill:
    fill = Fill(fill_style=colour)
    fill.drawing_actions.append(shape)
    return fill


if __name__ == "__main__":
    GaitApp("solepath", "org.example.solepath").main_loop()
