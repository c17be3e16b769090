"""Markerless capture, measured."""
