"""What vibrates, one machine a file, simulated exactly."""

from preshape.plant.modal import ModalPlant
from preshape.plant.response import Response

__all__ = ["ModalPlant", "Response"]
