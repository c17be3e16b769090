"""Marker bodies, joints and limbs from motion alone: no labels, no template, no pose."""

from kinesphere.skeleton.discovery.discover import Discovery as Discovery
from kinesphere.skeleton.discovery.discover import discover as discover
from kinesphere.skeleton.discovery.settings import DiscoverySettings as DiscoverySettings
