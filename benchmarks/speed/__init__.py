"""How long each stage takes on a long recording."""
