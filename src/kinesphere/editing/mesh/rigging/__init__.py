"""A mesh that somebody brings becomes a body with limbs, joints and weights."""

from kinesphere.editing.mesh.rigging.rig import rigged as rigged
from kinesphere.editing.mesh.rigging.righted import righted as righted
