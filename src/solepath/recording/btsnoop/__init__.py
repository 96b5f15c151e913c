"""Import of captures of Bluetooth (HCI), such as a phone's log of insoles and SensorTags.

    log = open_btsnoop("btsnoop_hci.log", sites={"F0:12:34:56:78:9A": Site.LEFT_FOOT})
    with PacketWriter("walk.jsonl", log.header) as writer:
        for packet in log:
            writer.write(packet)

../captures.py reads files of each kind, records.py also those in a bug report, values.py decodes connections and L2CAP,
att.py decodes attributes, devices.py identifies devices and channels, and log.py makes packets."""

from .devices import LoggedDevice
from .log import BtsnoopLog, open_btsnoop
from .records import is_log

__all__ = ["BtsnoopLog", "LoggedDevice", "is_log", "open_btsnoop"]
