"""Movement filter, axes, rest position, angles, twist (Sar Dessai et al. 2006, section 4)."""
