"""For a motion capture suit: seven sensors over UDP, as in Gong et al. 2023, and where each foot comes down.

    python examples/suit_over_udp.py                an emulated suit sends, at its own pace, for ten seconds
    python examples/suit_over_udp.py 0.0.0.0 9750   a suit in this network sends

A datagram is one notification of one sensor: a line with site and channel, such as "left_shank dot-orientation", and
the bytes. One may get lost or overtake another. The time of a packet is that of its arrival; the clocks of the devices
give the times of their samples. Measured limbs go into `Session(calibration=Calibration(limbs=...))`."""

import asyncio
import sys
from contextlib import closing

from solepath import Limitation, Packet, Session, Site, recipes
from solepath.calibration import Limbs
from solepath.emulate import Route, emulate, suit
from solepath.papers import TouchedDown


class Suit(asyncio.DatagramProtocol):
    def __init__(self, session: Session) -> None:
        self.session, self.sites = session, set[Site]()

    def datagram_received(self, data: bytes, addr: tuple[str, int]) -> None:
        head, _, payload = data.partition(b"\n")
        name, _, channel = head.decode("ascii", "replace").partition(" ")
        if name in [site.value for site in Site]:  # anybody may send anything to a port
            self.sites.add(Site(name))
            for event in self.session.feed(Packet(asyncio.get_running_loop().time(), Site(name), channel, payload)):
                match event:
                    case TouchedDown(foot=foot, position=(x, y, _), mode=mode):
                        print(f"{foot.value:5} comes down at x {x:5.2f} m, y {y:5.2f} m, {mode.value}")
                    case Limitation(what=what):
                        print(what)


async def send_walk(to: tuple[str, int]) -> None:
    walk = emulate(Route().stand(3).walk(6, speed=1.2).stop(1), devices=suit(Limbs(), seed=1))
    loop = asyncio.get_running_loop()
    started, (sender, _) = loop.time(), await loop.create_datagram_endpoint(asyncio.DatagramProtocol, remote_addr=to)
    with closing(sender):
        for packet in walk.packets:
            await asyncio.sleep(started + packet.t - loop.time())
            sender.sendto(f"{packet.site.value} {packet.channel}\n".encode("ascii") + packet.data)
        await asyncio.sleep(0.5)


async def main(host: str = "127.0.0.1", port: str = "0") -> None:
    session = Session(recipes.by_name("walking-modes"))
    endpoint = asyncio.get_running_loop().create_datagram_endpoint(lambda: Suit(session), local_addr=(host, int(port)))
    transport, receiver = await endpoint
    with closing(transport):
        await (send_walk(transport.get_extra_info("sockname")) if port == "0" else asyncio.Event().wait())
    print(f"{len(receiver.sites)} sensors sent")


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
