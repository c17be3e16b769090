"""Limbs, joint centres and poses, measured from the motion of markers."""

from kinesphere.skeleton.discovery import Discovery as Discovery
from kinesphere.skeleton.discovery import DiscoverySettings as DiscoverySettings
from kinesphere.skeleton.discovery import discover as discover
from kinesphere.skeleton.filling import fill_markers as fill_markers
from kinesphere.skeleton.fit import fit_skeleton as fit_skeleton
from kinesphere.skeleton.learning import learn_model as learn_model
from kinesphere.skeleton.settings import SkeletonSettings as SkeletonSettings
