"""The command line: ``stridor`` and ``python -m stridor``."""

import signal
import sys

from . import _native


def main() -> None:
    # Ctrl-C ends the process, as it does without Python.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.main(["stridor", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
