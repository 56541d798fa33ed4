"""`preshape studio [FILE]`"""

from __future__ import annotations

from pathlib import Path

import click

__all__ = ["command"]


@click.command("studio")
@click.argument("file", type=click.Path(path_type=Path), required=False, metavar="[FILE]")
@click.option("--port", type=int, metavar="N", help="[default: 8420, or the next that is free]")
@click.option(
    "--host",
    default="127.0.0.1",
    show_default=True,
    metavar="ADDRESS",
    help="Where to listen; others than this computer need the token that is printed.",
)
@click.option("--no-browser", is_flag=True, help="Print the address, and open no browser.")
def command(file: Path | None, port: int | None, host: str, no_browser: bool) -> None:
    """Choose a shaper with your eyes, on a page in your browser; FILE is a measurement or a shaper's JSON.

    \b
    preshape studio
    preshape studio resonances_x.csv
    preshape studio shaper.json --port 8500 --no-browser
    """
    try:
        from preshape.studio.server import Studio, create_app, free_socket, new_token, rules_for, serve
        from preshape.studio.workers import Workers
    except ModuleNotFoundError as error:
        if error.name is not None and error.name.startswith("preshape"):
            raise
        from preshape.errors import InputError

        raise InputError(
            f"the studio needs {error.name}, which is not installed: pip install 'preshape[studio]'."
        ) from None
    from preshape.studio.guard import is_loopback
    from preshape.workflow.workbench import opened_file

    opened = None if file is None else opened_file(file)
    workers = Workers()
    studio = Studio(workers) if opened is None else Studio(workers, workbench=opened.workbench, dropped=opened.dropped)
    token = "" if is_loopback(host) else new_token()
    app = create_app(studio, rules_for(host, token))
    with free_socket(host, port) as listening:
        address = _address(host, listening.getsockname()[1], token)
        serve(app, listening, lambda: _announce(address, not no_browser))


def _address(host: str, port: int, token: str) -> str:
    """What to type into a browser."""
    name = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(host, f"[{host}]" if ":" in host.strip("[]") else host)
    return f"http://{name}:{port}/" + (f"?token={token}" if token else "")


def _announce(address: str, browser: bool) -> None:
    click.echo(f"The studio is at {address}  (end it with Ctrl+C)")
    if browser:
        import webbrowser

        webbrowser.open(address)
