"""The page that shows a session while it runs: it takes events and gives what a browser draws."""
