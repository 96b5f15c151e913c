"""Demonstration: a fleet of emulated wearers on Spark, killed, restarted, and compared with sessions without Spark."""
