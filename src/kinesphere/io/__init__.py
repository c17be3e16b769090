"""Files in and out: a registry that recognises a format by its content, a module per format."""

from kinesphere.io import formats as formats
from kinesphere.io.atomic import replacing as replacing
from kinesphere.io.atomic import replacing_directory as replacing_directory
from kinesphere.io.registry import Format as Format
from kinesphere.io.registry import known_formats as known_formats
from kinesphere.io.registry import read as read
from kinesphere.io.registry import register as register
from kinesphere.io.registry import write as write
