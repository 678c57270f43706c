"""The exceptions of the package."""

from __future__ import annotations

from typing import Sequence


class Error(RuntimeError):
    """What went wrong, in one line that says where and how to put it right: the program's own line where a command failed.

    exit_code: of the command (docs/commands.md); None where no command failed.
    command: its words; empty where no command failed.
    """

    def __init__(self, message: str, exit_code: int | None = None, command: Sequence[str] = ()):
        super().__init__(message)
        self.exit_code = exit_code
        self.command = list(command)

    def __str__(self) -> str:
        return str(self.args[0])


class UnknownName(Error, KeyError):
    """An Error of what is looked up by name, so that `in`, `get` and `except KeyError` work as they do with a dictionary."""
