# SPDX-License-Identifier: LGPL-2.1-or-later
"""The errors a user can mend; everything else that is raised is a defect of the program."""

COMMAND_LINE = "the command line"  # the source of what was typed there


class PipeWorkbenchError(Exception):
    """One sentence that says which file or object, what is wrong and what to do."""


def one_line(text: str) -> str:
    """Return a text with control characters escaped: names from files must not break up a message."""
    return "".join(character if character.isprintable() else repr(character)[1:-1] for character in text)


class InputError(PipeWorkbenchError):
    """Something from outside does not fit.

    Parameters
    ----------
    source : object
        The file (or object) the input came from.
    key : str
        Path of the offending key, such as ``cameras[1].interior.pixel_pitch``; may be empty.
    problem : str
        What is wrong, without a full stop.
    remedy : str
        What the user can do about it, without a full stop.
    """

    def __init__(self, source: object, key: str, problem: str, remedy: str) -> None:
        self.source, self.key, self.problem, self.remedy = str(source), key, problem, remedy
        where = f"{source}: {key}" if key else f"{source}"
        super().__init__(one_line(f"{where}: {problem}; {remedy}"))


class MissingPackageError(PipeWorkbenchError):
    """A Python package or program that this step needs is not installed.

    ``packages`` are its names as pip knows them, empty where it is not pip's.
    """

    def __init__(self, name: str, purpose: str, command: str) -> None:
        self.name, self.purpose = name, purpose
        self.packages = tuple(name.lower().split(", ")) if command.startswith("pip install") else ()
        super().__init__(f"{purpose} needs {name}, which is not installed here; install it with: {command}")
