"""The order of things: the one place that knows it."""
