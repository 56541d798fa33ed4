"""Example 2: from the matrices of a machine to a shaper that has been tried on it.

The machine is data/machine.toml, mass, damping and stiffness of a gantry; the command is data/move.csv, 0.2 m in 0.2 s.
The shaper for its modes and the figure go into a folder:

    python examples/02_simulate_own_machine.py             # into own-machine/
    python examples/02_simulate_own_machine.py --out DIR

The same as

    preshape simulate examples/data/machine.toml --shaper own-machine/shaper.json \\
        --command examples/data/move.csv --figure own-machine/simulation.svg
"""

from __future__ import annotations

import argparse
from pathlib import Path

from preshape import design
from preshape.files import write_atomically
from preshape.plant import load_plant
from preshape.report import as_svg, simulation_figure
from preshape.workflow import read_command, simulate_plant

DATA = Path(__file__).parent / "data"


def main() -> None:
    """Design, simulate, write."""
    parser = argparse.ArgumentParser(description="A shaper for data/machine.toml, simulated.")
    parser.add_argument("--out", type=Path, default=Path("own-machine"), help="folder to write into")
    folder: Path = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    machine = load_plant(DATA / "machine.toml")
    command, dt = read_command(DATA / "move.csv", machine.inputs)
    shaper = design.direct(machine.modes())
    result = simulate_plant(machine, command, dt, shaper)
    for name, (before, after) in result.motions.items():
        print(f"{name}: {1e3 * before.residual:.3g} mm of vibration unshaped, {1e3 * after.residual:.3g} mm shaped")
    print(shaper.save(folder / "shaper.json"))
    print(write_atomically(folder / "simulation.svg", as_svg(simulation_figure(result))))


if __name__ == "__main__":
    main()
