"""What is wrong with a damaged file, in words rather than those of whoever stumbled over it."""

_WORDS: tuple[tuple[type[Exception], str], ...] = (
    (IndexError, "it refers to something that is not there"),
    (UnicodeError, "it holds bytes that are no text"),
    (RecursionError, "it is nested too deeply"),
    (OverflowError, "it holds a number that is too large"),
    (MemoryError, "it asks for more memory than there is"),
    (TypeError, "something in it is of the wrong kind"),
    (AttributeError, "something in it is of the wrong kind"),
    (EOFError, "it breaks off"),
    (ValueError, "it holds a value that cannot be"),
)


class Damage(ValueError):
    """What is wrong, in words; whoever knows the path says in which file."""


def damage_in_words(error: Exception) -> str:
    """Return what an exception that a damaged file caused says about the file."""
    if isinstance(error, Damage):
        return str(error)
    if isinstance(error, KeyError) and error.args:
        return f"{str(error.args[0])[:40]!r} is missing"
    for kind, words in _WORDS:
        if isinstance(error, kind):
            return words
    return "it cannot be understood"
