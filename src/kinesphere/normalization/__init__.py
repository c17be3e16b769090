"""Normalization: default position, body planes, limb frames aligned with them (paper section 3)."""

from kinesphere.normalization.facing import Facing as Facing
from kinesphere.normalization.settings import NormalizationSettings as NormalizationSettings
from kinesphere.normalization.stage import normalize as normalize
