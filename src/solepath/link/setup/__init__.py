"""Decisions of a host on its devices: which to connect to, where each is worn, what to request, and what if that fails.

Nothing here does input or output, so bleak (`solepath.ble`), a page in a browser and an app in another language use the
same code:

- `config`: the devices to connect to, and the filters of a scan for them.
- `roster`: which device is worn at which site.
- `device_setup`: the requests for one connected device, one at a time."""
