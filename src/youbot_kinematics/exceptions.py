"""Everything that this package raises on purpose, as one small tree.

::

    YoubotError
    ├── InputError       what was given cannot be used: an array, a parameter, a file
    │   └── BagError     a bag, or the targets in it
    └── PlanningError    the input is sound, but there is no trajectory for it

Each message carries the value, the limit, and what to do about it.
"""


class YoubotError(Exception):
    """Base of every exception of this package."""


class InputError(YoubotError, ValueError):
    """An argument, a parameter or a file that cannot be used as it is."""


class BagError(InputError):
    """A bag that cannot be read, or that holds no usable targets."""


class PlanningError(YoubotError):
    """Sound input for which no trajectory exists, or none was found."""
