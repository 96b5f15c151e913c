"""Puts the errors of commands into sentences for a person."""

from __future__ import annotations

from ...recording import RecordingError
from ...types.extras import install_hint
from .os_errors import file_error_text, in_words
from .own_devices import own_fault

OURS = ("solepath", "solepath_lab")
"""Packages whose errors are sentences for a person."""


def sentences_of(error: Exception) -> list[str]:
    """Return a sentence for each fault that an error reports; none for an error that nobody foresaw."""
    if isinstance(error, RecordingError):
        return [in_words(problem) for problem in error.problems]
    if isinstance(error, ModuleNotFoundError) and error.name == "numpy":
        return [f"this needs numpy: {install_hint('arrays')}"]
    if isinstance(error, OSError):
        text = file_error_text(error)
        return [text if error.filename else f"the output cannot be written: {text}"]
    is_sentence = type(error).__module__.partition(".")[0] in OURS
    return [found for found in (in_words(error) if is_sentence else own_fault(error),) if found]
