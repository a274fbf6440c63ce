"""`python -m zwidth` is the command `zwidth`."""

from zwidth.cli.main import main

if __name__ == "__main__":
    raise SystemExit(main())
