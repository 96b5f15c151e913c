"""The page that shows a session while it runs: events in, what a browser draws out."""
