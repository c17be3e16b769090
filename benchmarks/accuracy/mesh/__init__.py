"""The surface on the skeleton: how well it fits, bends and twists, and what it costs."""
