"""How good and how fast the line is; results are written by these scripts, never by hand."""
