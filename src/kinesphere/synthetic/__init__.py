"""Actors whose truth is known, and ways to spoil what cameras see of them."""
