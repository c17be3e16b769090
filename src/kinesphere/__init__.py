"""Kinesphere: optical motion capture into motion that means something, without manual work."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("kinesphere")
except PackageNotFoundError:  # run from a source tree that nobody installed
    __version__ = "0+unknown"
