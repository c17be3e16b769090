"""The whole line on synthetic performances, against their truth."""
