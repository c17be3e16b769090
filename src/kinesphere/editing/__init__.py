"""Solved motion changed by its joint parameters."""

from kinesphere.editing.apply import apply_edits as apply_edits
