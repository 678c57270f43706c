"""Calling the command `millscope`: where it is, what it says while it works, how it fails."""

from __future__ import annotations

import codecs
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from typing import Callable, Union

from .errors import Error

Progress = Union[bool, None, Callable[[str], None]]
OWN = "millscope: "  # how the program begins a warning, and its line when it fails
ESCAPES = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")


def find() -> str:
    """The command's path: what MILLSCOPE names, else `millscope` on PATH. Error where there is none."""
    named = os.environ.get("MILLSCOPE")
    found = shutil.which(named or "millscope")
    if found:
        return found
    if named:
        raise Error(f"MILLSCOPE is '{named}', which is no program that can be started; set it to the path of the command millscope")
    raise Error("there is no command 'millscope' on PATH; install it, or set MILLSCOPE to its path, e.g. build/release/bin/millscope")


class _OnStderr:
    """Shows what a command says: its lines stay, and the line that it draws again and again is drawn again here."""

    def __init__(self) -> None:
        # A notebook shows a redrawn line as a terminal does, though it is none. A log file would get every one of them.
        self.redraws = sys.stderr.isatty() or type(sys.stderr).__module__.startswith("ipykernel")
        self.drawn = 0

    def __call__(self, text: str, stays: bool) -> None:
        if not stays and not self.redraws:
            return
        clear = "\r" + " " * self.drawn + "\r" if self.drawn else ""
        self.drawn = 0 if stays else len(text)
        sys.stderr.write(clear + text + ("\n" if stays else ""))
        sys.stderr.flush()

    def end(self) -> None:
        if self.drawn:
            sys.stderr.write("\r" + " " * self.drawn + "\r")
            sys.stderr.flush()


class _ToCallback:
    def __init__(self, callback: Callable[[str], None] | None) -> None:
        self.callback = callback

    def __call__(self, text: str, stays: bool) -> None:
        if self.callback:
            self.callback(text)

    def end(self) -> None:
        pass


def _follow(screen: int, show: _OnStderr | _ToCallback) -> list[str]:
    """Reads a command's terminal to its end and shows it; returns the lines that stay. The last one is not shown where it may be the
    reason why the command failed, which becomes an exception."""
    lines, rest, shown, decoder = [], "", "", codecs.getincrementaldecoder("utf-8")("replace")
    while True:
        try:
            chunk = os.read(screen, 65536)
        except OSError:  # how Linux says that the other end is closed
            chunk = b""
        *whole, rest = (rest + decoder.decode(chunk) + ("" if chunk else "\r\n")).split("\n")
        for line in whole:
            text = _visible(line.removesuffix("\r"))  # a terminal ends lines with both
            if text:
                if lines and lines[-1].startswith(OWN):
                    show(lines[-1], True)
                lines.append(text)
                if not text.startswith(OWN):
                    show(text, True)
        if not chunk:
            return lines
        text = _visible(rest)
        if text and text != shown:
            show(text, False)
            shown = text


def _visible(line: str) -> str:
    """What a terminal shows of a line after all that was drawn over it."""
    return ESCAPES.sub("", line).rpartition("\r")[2].strip()


def call(*words: object, progress: Progress = False) -> str:
    """Runs `millscope WORDS`, waits for its end and returns what it printed (stdout).

    progress: True shows on stderr what the command says while it works; a function is called with each line of it as text;
    False or None shows nothing.
    Raises Error with the command's own line when it fails. Ctrl-C lets the command stop in its own way (a run writes a checkpoint,
    `millscope resume` goes on from there), then raises KeyboardInterrupt; a second one ends it at once.
    """
    command = [find(), *(str(word) for word in words)]
    show = _show_of(progress)
    screen, end = pty.openpty()  # on a terminal commands say more often how far they are
    with tempfile.TemporaryFile() as out:
        # A session of its own: a Ctrl-C of the terminal reaches the command once, from here, and never twice.
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=end, start_new_session=True)
        os.close(end)
        try:
            lines = _follow(screen, show)
            code = child.wait()
            show.end()
        except BaseException as reason:
            child.send_signal(signal.SIGINT if isinstance(reason, KeyboardInterrupt) else signal.SIGTERM)
            try:
                _follow(screen, _ToCallback(None))  # it must not wait for someone to read
                child.wait()
            except KeyboardInterrupt:
                child.kill()
                child.wait()
            raise
        finally:
            os.close(screen)
        out.seek(0)
        printed = out.read().decode(errors="replace")
    if code != 0:
        raise Error(_why(command, code, lines), code, command)
    if lines and lines[-1].startswith(OWN):  # a warning
        show(lines[-1], True)
    return printed


def _show_of(progress: Progress) -> _OnStderr | _ToCallback:
    return _ToCallback(progress) if callable(progress) else _OnStderr() if progress else _ToCallback(None)


def tell(printed: str, progress: Progress) -> None:
    """Shows what a command printed at its end where its progress was shown."""
    show = _show_of(progress)
    for line in printed.splitlines():
        show(line, True)


def _why(command: list[str], code: int, lines: list[str]) -> str:
    own = [line for line in lines if line.startswith(OWN)]
    if own:
        return own[-1].removeprefix(OWN)
    how = f"was ended by signal {-code}" if code < 0 else f"ended with exit code {code}"
    return f"'{' '.join(command[:2])}' {how}" + (f"; it last said: {lines[-1]}" if lines else " and said nothing")
