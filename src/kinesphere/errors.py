"""One root for every error a user can meet; each says what was found and what would be right."""


class KinesphereError(Exception):
    """Root of all errors Kinesphere raises on purpose."""


class UnreadableFile(KinesphereError):
    """A file is missing, truncated, damaged or not what it claims to be."""


class UnknownFormat(UnreadableFile):
    """No reader or writer knows this kind of file."""


class UnwritableFile(KinesphereError):
    """A place cannot be written to, or holds what must not be replaced."""


class MissingExtra(KinesphereError):
    """A package that only some commands need is not installed."""


class BadRecording(KinesphereError):
    """A recording cannot be used as asked: no frames, no rate, labels that clash."""


class BadModel(KinesphereError):
    """A topological model contradicts itself or does not fit the recording."""


class BadSetting(KinesphereError):
    """A setting has no such name, no such value, or lies outside its range."""


class BadCamera(KinesphereError):
    """A camera's calibration contradicts itself, or does not fit its images."""


class BadScene(KinesphereError):
    """A scene cannot be tracked as it is: images, calibration or times do not fit together."""


class DegenerateMotion(KinesphereError):
    """The motion does not determine what was asked for."""


class AmbiguousFacing(KinesphereError):
    """Nothing in the data tells front from back, hence left from right."""


class BadSurface(KinesphereError):
    """A mesh contradicts itself or cannot ride on the skeleton it is given."""


class Interrupted(KinesphereError):
    """Somebody stopped the work; what there was of it is kept."""
