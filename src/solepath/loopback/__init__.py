"""Emulated devices behind the same interface as real ones: in memory, and over true virtual Bluetooth controllers."""
