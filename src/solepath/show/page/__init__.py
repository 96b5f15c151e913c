"""Serves a page that shows a session while it runs, from the session's events alone."""
