"""Undo and redo: the states before and after the present one."""

from __future__ import annotations

from preshape.workflow.workbench import Workbench

__all__ = ["History"]

MOST_STEPS = 200


class History:
    """A line of states with a present one.

    Edits that follow one another under the same label, such as the digits typed into one field or one drag, are one
    step.
    """

    def __init__(self, present: Workbench) -> None:
        self.present = present
        self._past: list[Workbench] = []
        self._future: list[Workbench] = []
        self._label = ""

    @property
    def can_undo(self) -> bool:
        """Whether there is a state before."""
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        """Whether a state was undone."""
        return bool(self._future)

    def change(self, new: Workbench, label: str = "") -> None:
        """Make a new state the present one; an empty label makes it a step of its own."""
        if new == self.present:
            return
        if not label or label != self._label:
            self._past = [*self._past, self.present][-MOST_STEPS:]
        self._future.clear()
        self.present, self._label = new, label

    def seal(self) -> None:
        """The next edit is a new step, whatever its label."""
        self._label = ""

    def undo(self) -> bool:
        """Go one step back, if there is one."""
        return self._go(self._past, self._future)

    def redo(self) -> bool:
        """Go one step on again, if there is one."""
        return self._go(self._future, self._past)

    def _go(self, source: list[Workbench], target: list[Workbench]) -> bool:
        self._label = ""
        if not source:
            return False
        target.append(self.present)
        self.present = source.pop()
        return True
