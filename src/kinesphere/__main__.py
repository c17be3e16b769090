"""``python -m kinesphere`` is the command line."""

from kinesphere.cli.main import main

if __name__ == "__main__":
    main()
