"""Axis extraction: one file a method, one registry by name."""

from kinesphere.parameterization.axes.fit import AxesMethod as AxesMethod
from kinesphere.parameterization.axes.registry import AXES as AXES
from kinesphere.parameterization.axes.registry import find_axes as find_axes
