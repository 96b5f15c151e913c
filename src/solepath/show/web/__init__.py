"""Builds a static site that shows the page without a server: Python itself runs in the browser, in a worker."""
