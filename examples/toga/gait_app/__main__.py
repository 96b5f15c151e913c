"""For a phone or a desktop: an app with BeeWare Toga shows what somebody does who walks, and the figures of the gait.
It beeps at each right heel-strike, and when the left stance gets longer than 0.75 s (docs/app.md).

pip install '.[ble]' 'toga-qt[pyside6-essentials]>=0.5.7'   on Linux; on macOS and Windows 'toga>=0.5.7' instead
python examples/toga/gait_app/__main__.py                   two insoles nearby, or emulated ones"""

import asyncio

import toga

from solepath import Foot, FootMoved, LinkTrouble, Session
from solepath.ble import DeviceConfig, Devices
from solepath.feedback import EveryHeelStrike, Feedback, StanceLonger
from solepath.link.devices.insole import PROFILE as INSOLE


async def sensors():
    async with Devices([DeviceConfig(None, profile=INSOLE), DeviceConfig(None, profile=INSOLE)]) as devices:
        async for packet in devices:
            yield packet


async def emulated(speed=1.0):
    from solepath.emulate import Route, emulate

    for packet in emulate(Route().stand(2).walk(12, speed=1.3).turn(1.6, radius=1.5).walk(8).stop(2)).packets:
        await asyncio.sleep(0.005 / speed)  # two insoles send 200 packets a second
        yield packet


class GaitApp(toga.App):
    def startup(self):
        self.listening, self.label = None, toga.Label("\n" * 4, font_size=20, margin=8)
        self.start = toga.Button("Insoles", on_press=lambda _: self.toggle(sensors(), self.loop.time), margin=8)
        self.show = toga.Button("Emulated", on_press=lambda _: self.toggle(emulated()), margin=8)
        content = toga.Box(children=[self.label, self.start, self.show], direction="column")
        self.main_window = toga.MainWindow(size=(360, 300), content=content)
        self.main_window.show()

    def toggle(self, packets, clock=lambda: None):  # the clock by which packets are stamped, if it is a true one
        if self.listening is None or not self.listening.cancel():  # while it listens, the button reads Stop
            self.listening = self.loop.create_task(self.listen(packets, clock))

    async def listen(self, packets, clock):
        feedback = Feedback([EveryHeelStrike(Foot.RIGHT), StanceLonger(Foot.LEFT, 0.75)])
        session, status = Session(poses=feedback.needs_poses, impacts=True), "ended"
        self.start.text, self.show.enabled = "Stop", False
        try:
            async for packet in packets:
                events = session.feed(packet)
                for _ in feedback.feed(events, clock()):  # what is late is dropped
                    self.beep()
                for event in events:
                    if not isinstance(event, FootMoved):
                        self.draw(session, event.what if isinstance(event, LinkTrouble) else "")
        except (asyncio.CancelledError, Exception) as error:  # no Bluetooth, no permission: the user reads it
            status = str(error) or "stopped"
        self.draw(session, status)
        self.start.text, self.show.enabled = "Insoles", True

    def draw(self, session, status):
        activity, gait = session.activity.value.replace("_", " ").lower(), session.gait
        cadence = f"{gait.cadence:.0f} steps a minute" if gait and gait.cadence else ""
        self.label.text = "\n".join([activity, cadence, status])


if __name__ == "__main__":
    GaitApp("solepath", "org.example.solepath").main_loop()
