"""Real Bluetooth, through bleak: find, connect, set up, listen."""
