"""Files in and out: a registry that recognises a format by its content, a module per format."""
