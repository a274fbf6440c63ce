"""`python -m zwidth` is the command `zwidth`."""

import sys


def main() -> int:
    """Run the command line of this process; Ctrl-C ends it quietly, in its first imports as well."""
    try:
        from zwidth.cli.main import main as run

        return run()
    except KeyboardInterrupt:
        print("zwidth: interrupted", file=sys.stderr)
        return 130  # as of `zwidth.cli.main`, which may not be there yet


if __name__ == "__main__":
    raise SystemExit(main())
