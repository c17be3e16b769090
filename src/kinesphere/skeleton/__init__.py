"""Limbs, joint centres and poses, measured from the motion of labelled markers."""

from kinesphere.skeleton.fit import fit_skeleton as fit_skeleton
from kinesphere.skeleton.learning import learn_model as learn_model
from kinesphere.skeleton.settings import SkeletonSettings as SkeletonSettings
