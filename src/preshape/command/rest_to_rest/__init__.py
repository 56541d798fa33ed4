"""Commands that move a flexible body from rest to rest: a force of constant levels, with what it does."""

from preshape.command.rest_to_rest.bang_bang import bang_bang
from preshape.command.rest_to_rest.deflection_limiting import deflection_limiting
from preshape.command.rest_to_rest.on_off import on_off
from preshape.command.rest_to_rest.rest_to_rest import RestToRest
from preshape.command.rest_to_rest.time_optimal import time_optimal

__all__ = ["RestToRest", "bang_bang", "deflection_limiting", "on_off", "time_optimal"]
