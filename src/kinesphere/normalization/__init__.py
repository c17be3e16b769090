"""Default position, body planes, limb frames (Sar Dessai et al. 2006, section 3)."""
