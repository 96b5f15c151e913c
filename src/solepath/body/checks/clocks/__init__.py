"""Checks that the samples of both feet have times of one clock."""
