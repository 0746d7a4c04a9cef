"""The errors and warnings of Sprung."""
from typing import NamedTuple, Optional, Tuple


class Problem(NamedTuple):
    """One broken rule of an input. Members that do not apply are empty."""

    file: str
    """The file."""
    key: str
    """The path of the key, such as ``bodies.banner.mass``, or the place in the file."""
    value: str
    """The value that breaks the rule."""
    rule: str
    """The rule, such as ``must be greater than 0``."""
    remedy: str
    """What to change."""


class InputError(ValueError):
    """An invalid scene, mesh, argument, or array. Nothing has changed.

    ``problems`` is a tuple of all problems that were found, at least one.
    """

    problems: Tuple[Problem, ...]

    def __init__(self, message: str, problems: Tuple[Problem, ...] = ()) -> None:
        super().__init__(message, problems)
        self.problems = problems

    def __str__(self) -> str:
        return str(self.args[0])


class StepError(RuntimeError):
    """The simulation diverged. The simulator stays at the begin of the step.

    ``step`` is the number of the step, ``time`` its time [s], ``body`` the name of the body, ``particle`` and ``spring`` their
    numbers within the body (None: none is involved), ``cause`` what was observed, and ``remedy`` what to change.
    """

    step: int
    time: float
    body: str
    particle: Optional[int]
    spring: Optional[int]
    cause: str
    remedy: str

    def __init__(self, message: str, step: int = 0, time: float = 0.0, body: str = "", particle: Optional[int] = None,
                 spring: Optional[int] = None, cause: str = "", remedy: str = "") -> None:
        super().__init__(message, step, time, body, particle, spring, cause, remedy)
        self.step = step
        self.time = time
        self.body = body
        self.particle = particle
        self.spring = spring
        self.cause = cause
        self.remedy = remedy

    def __str__(self) -> str:
        return str(self.args[0])


class FileError(OSError):
    """A file that cannot be read or written."""


class SprungWarning(UserWarning):
    """A scene that Sprung accepts and takes for a probable mistake."""
