"""`python -m solepath_lab`: the same as the command `solepath-lab`."""

from .command import main

if __name__ == "__main__":
    raise SystemExit(main())
