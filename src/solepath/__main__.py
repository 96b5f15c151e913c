"""`python -m solepath`: the same as the command `solepath`."""

if __name__ == "__main__":
    try:
        from .cli import main

        status = main()
    except KeyboardInterrupt:  # while the module was being imported
        status = 130
    raise SystemExit(status)
