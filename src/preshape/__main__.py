"""`python -m preshape` is the `preshape` command."""

from preshape.cli import main

if __name__ == "__main__":
    main()
