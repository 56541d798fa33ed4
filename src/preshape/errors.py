"""The few exceptions.

Wrong input raises :class:`InputError`: one sentence that says what came, what is allowed, and what to do.
The command line prints that sentence and exits with 2; anything else that escapes is our fault and exits with 1.
"""

__all__ = ["InputError", "MeasurementError"]


class InputError(ValueError):
    """What the caller gave cannot be used; the message names the value, the rule and the remedy."""


class MeasurementError(InputError):
    """A measurement file cannot be read, or holds nothing that can be identified."""
