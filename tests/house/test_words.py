"""Identifiers hold no private words (docs/words.txt), and every public docstring is a sentence that stands alone."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from keyword import iskeyword
from pathlib import Path

import pytest
from here import DOCS, EXAMPLES, ROOT, TESTS

SRC = ROOT / "src" / "solepath"
LEANING_WORDS = frozenset(
    ["and", "but", "how", "of", "or", "so", "what", "when", "where", "whether", "which", "who", "whose", "why"]
)
"""First words of docstrings that depend on the text before them, or name nothing."""
MIN_WORDS = 3
"""Smallest number of words in a docstring."""


def private_words() -> tuple[frozenset[str], frozenset[str]]:
    """Return the words that no identifier may contain, and the identifiers that are exceptions."""
    words: set[str] = set()
    standard: set[str] = set()
    for line in (DOCS / "words.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            family, _, rest = line.partition(":")
            words.update(family.split())
            standard.update(rest.partition(";")[2].split())
    return frozenset(words), frozenset(standard)


PRIVATE, STANDARD = private_words()


STEM_LENGTH = 4
"""Length from which a listed form is found at the start of a longer word as well."""
STEMS = tuple(sorted(word for word in PRIVATE if len(word) >= STEM_LENGTH))
STANDARD_WORDS = frozenset(["heart", "heartbeat"])
"""Standard words that start like a private one."""


def is_private(word: str) -> bool:
    return word in PRIVATE or (word.startswith(STEMS) and word not in STANDARD_WORDS)


def words_of(identifier: str) -> list[str]:
    """Return the words of a snake_case or CamelCase name."""
    return [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", identifier)]


def python(top: Path) -> list[Path]:
    """Return the Python files below a folder: those with the suffix, and programs whose first line names Python."""
    paths = [path for path in sorted(top.rglob("*")) if path.is_file() and "__pycache__" not in path.parts]
    return [
        path for path in paths if path.suffix == ".py" or path.read_bytes()[:64].split(b"\n")[0].endswith(b"python3")
    ]


def identifiers(source: str) -> set[str]:
    """Return the names in a source, also those within f-strings, which are one token before Python 3.12."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    names = {token.string for token in tokens if token.type == tokenize.NAME}
    for node in ast.walk(ast.parse(source)):
        names |= {
            getattr(node, field) for field in ("id", "attr", "arg") if isinstance(getattr(node, field, None), str)
        }
    return {name for name in names if not iskeyword(name)}


def held_by(path: Path) -> list[str]:
    names = identifiers(path.read_text("utf-8")) - STANDARD
    return sorted(name for name in names if any(map(is_private, words_of(name))))


@pytest.mark.parametrize("top", [SRC, EXAMPLES, TESTS, ROOT / ".ci"], ids=lambda top: top.name)
def test_no_identifier_holds_a_private_word(top: Path) -> None:
    found = {
        path.relative_to(ROOT).as_posix(): held
        for path in python(top)
        if (
            held := sorted(
                n for n in identifiers(path.read_text("utf-8")) - STANDARD if any(map(is_private, words_of(n)))
            )
        )
    }
    assert found == {}, "docs/words.txt says what to say instead"


def test_a_private_word_is_found_in_any_form_of_a_name() -> None:
    assert {"told", "habit"} <= PRIVATE
    for name in ("told", "is_told", "ToldLayout", "HABIT", "_habit_of", "mender", "tolds", "keep_calmly"):
        assert any(map(is_private, words_of(name))), name
    assert not any(map(is_private, words_of("inhabited_untold")))


def test_names_within_f_strings_and_of_programs_without_suffix_are_read() -> None:
    assert {"first", "second", "third"} <= identifiers('first = f"{second.third:.3f}"')
    assert {"api", "golden", "screenshots"} <= {path.name for path in python(ROOT / ".ci")}


def docstrings(path: Path) -> Iterator[tuple[int, str]]:
    """Yield line and text of each public docstring: of the module, of classes, functions, fields and constants."""
    module = ast.parse(path.read_text(encoding="utf-8"))
    text = ast.get_docstring(module)
    if text is not None:
        yield 1, text
    yield from _within(module.body)


def _within(body: list[ast.stmt]) -> Iterator[tuple[int, str]]:
    for before, statement in zip([None, *body], body, strict=False):
        if isinstance(statement, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            if statement.name.startswith("_"):
                continue
            text = ast.get_docstring(statement)
            if text is not None:
                yield statement.lineno, text
            if isinstance(statement, ast.ClassDef):
                yield from _within(statement.body)
        elif isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
            named = before.target if isinstance(before, ast.AnnAssign) else None
            if isinstance(before, ast.Assign):
                named = before.targets[0]
            public = named is not None and not getattr(named, "id", "").startswith("_")
            if public and isinstance(statement.value.value, str):
                yield statement.lineno, statement.value.value


def fault(text: str) -> str | None:
    """Return the fault of a docstring; None for a correct one."""
    first = text.strip().split("\n\n")[0].strip()
    words = first.split()
    if len(words) < MIN_WORDS:
        return "is no sentence"
    if not (first[0].isupper() or first[0].isdigit() or first[0] in "`'\"(|") and not first.startswith("solepath"):
        return "starts in the middle"
    if words[0].strip("`'\",.:;").lower() in LEANING_WORDS:
        return f"starts with {words[0]}"
    if text.rstrip()[-1] in ",:;":
        return "runs on"
    if not first.endswith((".", ".)", '."')):
        return "does not end"
    return None


def test_every_public_docstring_is_a_sentence_that_stands_alone() -> None:
    found = [
        f"{path.relative_to(ROOT).as_posix()}:{line}: {problem}: {text.strip().splitlines()[0]}"
        for path in python(SRC)
        for line, text in docstrings(path)
        if (problem := fault(text)) is not None
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "text",
    [
        "Of them.",
        "and",
        "downwards, negative,",
        "Whether it stands.",
        "s of standing",
        "A number",
        "m; x to",
        "It has a list:\n\nOne.",
    ],
)
def test_what_leans_on_its_neighbours_is_no_sentence(text: str) -> None:
    assert fault(text) is not None


@pytest.mark.parametrize("text", ["Duration of the stride, s.", "Return it whole.\n\nNo delay.", "`t` in s of it."])
def test_a_phrase_with_its_noun_is_enough(text: str) -> None:
    assert fault(text) is None
