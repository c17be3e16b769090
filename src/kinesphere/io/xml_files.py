"""XML files without document types: nothing in them can expand or fetch anything."""

from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from kinesphere.errors import UnreadableFile
from kinesphere.io.registry import read_bytes


def read_xml(path: Path) -> ElementTree.Element:
    """Return the root element of an XML file.

    Raises
    ------
    UnreadableFile
        If the file is no XML, naming line and column; if it declares a document type, the only
        way to entities that grow without bound or point elsewhere.
    """
    content = read_bytes(path, stop=b"\0")
    guard = expat.ParserCreate()
    guard.StartDoctypeDeclHandler = _refuse
    try:
        guard.Parse(content, True)
        return ElementTree.fromstring(content)
    except expat.ExpatError as error:
        raise UnreadableFile(
            f"{path}: line {error.lineno}, column {error.offset} is no XML "
            f"({expat.ErrorString(error.code)})"
        ) from None
    except _DocumentTypeFound:
        raise UnreadableFile(
            f"{path} declares an XML document type; remove the <!DOCTYPE …> line"
        ) from None
    except (ElementTree.ParseError, ValueError, LookupError) as error:  # unknown encodings
        raise UnreadableFile(f"{path} is no XML ({error})") from None


class _DocumentTypeFound(Exception):
    """Stops the parser before a declaration can do anything."""


def _refuse(*_: object) -> None:
    raise _DocumentTypeFound
