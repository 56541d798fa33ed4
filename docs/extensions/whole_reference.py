"""The reference: what a package's `__all__` holds, from the docstrings; a build that leaves out a name is refused.

``.. room:: preshape.design`` is automodule with everything public, constants included: these are documented where they
are defined, for only there is their docstring.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import sys
from collections.abc import Iterable, Iterator
from types import ModuleType

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.errors import PycodeError
from sphinx.pycode import ModuleAnalyzer
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

import preshape

__all__ = ["left_out", "public_names"]

FACES = ("preshape.cli", "preshape.studio")
"""What is run, not imported."""

WITHIN = (
    "preshape.command.known",
    "preshape.command.path",
    "preshape.command.rest_to_rest",
    "preshape.export.klipper",
    "preshape.plant.mace",
    "preshape.plant.shuttle_arm",
)
"""Rooms within rooms whose names are meant for users; the others serve the room they are in."""

LONGEST_VALUE = 90
"""A constant whose value is written longer is shown without it."""


def public_names() -> Iterator[tuple[str, str]]:
    """Package and name of everything public: of preshape, of its rooms, and of the rooms within that users enter."""
    rooms = [one.name for one in pkgutil.iter_modules(preshape.__path__, "preshape.") if one.ispkg]
    for room in ("preshape", *(room for room in rooms if room not in FACES), *WITHIN):
        for name in importlib.import_module(room).__all__:
            yield room, name


def left_out(documented: Iterable[str]) -> list[str]:
    """Public names for which no documented path, of whatever module, is the very object."""
    paths: dict[str, list[str]] = {}
    for path in documented:
        paths.setdefault(path.rpartition(".")[2], []).append(path)
    missing = []
    for room, name in public_names():
        thing = getattr(importlib.import_module(room), name)
        if not any(_leads_to(path, thing) for path in paths.get(name, ())):
            missing.append(f"{room}.{name}")
    return missing


def _leads_to(path: str, thing: object) -> bool:
    if isinstance(thing, ModuleType) and path == thing.__name__:
        return True
    module, _, name = path.rpartition(".")
    return getattr(sys.modules.get(module), name, None) is thing


def _owner(thing: object) -> str:
    """The innermost room that a class or function is public in, where it is documented once."""
    module = getattr(thing, "__module__", "")
    rooms = {room for room, name in public_names() if getattr(sys.modules[room], name) is thing}
    return max((room for room in rooms if module.startswith(f"{room}.")), key=len, default="")


def _documented_in(room: str, name: str) -> str | None:
    """The module that has a constant's docstring, if one has."""
    value = getattr(sys.modules[room], name)
    for path in sorted(sys.modules):
        if path.startswith("preshape") and getattr(sys.modules[path], name, None) is value:
            try:
                if ("", name) in ModuleAnalyzer.for_module(path).find_attr_docs():
                    return path
            except PycodeError:  # a compiled module
                continue
    return None


class Room(SphinxDirective):
    """Everything public of a package."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Hand the names to autodoc."""
        room = self.arguments[0]
        package = importlib.import_module(room)
        things = {name: getattr(package, name) for name in package.__all__}
        callables = {name: one for name, one in things.items() if inspect.isclass(one) or inspect.isroutine(one)}
        members = [name for name, one in callables.items() if _owner(one) in (room, "")]
        lines = [f".. automodule:: {room}", f"   :members: {', '.join(members)}", ""]
        for name, one in things.items():
            if name in members or (isinstance(one, ModuleType) and one.__name__ == f"{room}.{name}"):
                continue
            if name in callables:
                lines += [f"``{name}`` is public here too: :py:obj:`{_owner(one)}.{name}`.", ""]
            elif module := _documented_in(room, name):
                lines += [f".. autodata:: {module}.{name}"]
                lines += ["   :no-value:"] * (len(repr(one)) > LONGEST_VALUE or " at 0x" in repr(one)) + [""]
            else:
                lines += [f".. py:data:: {name}", f"   :module: {room}", ""]
        return self.parse_text_to_nodes("\n".join(lines), allow_section_headings=True)


def _check(app: Sphinx, environment: BuildEnvironment) -> None:
    for name in left_out(environment.domains.python_domain.objects):
        logging.getLogger(__name__).warning("%s is public and not in the reference (docs/reference/python)", name)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive, and check when all pages are read."""
    app.add_directive("room", Room)
    app.connect("env-check-consistency", _check)
    return {"parallel_read_safe": True}
