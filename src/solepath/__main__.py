"""`python -m solepath`: the same as the command `solepath`."""

from .cli import main

if __name__ == "__main__":
    raise SystemExit(main())
